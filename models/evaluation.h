// How far a model's force is from the measured one, in newtons and in just
// noticeable differences, over the samples in contact.
//
// Thread guarantee: one thread per object; slow side (allocates).
// Source: figures 4 to 7 of Hoever & Harders (2009) for the force bins.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/jnd.h"

namespace palpate {

inline constexpr double kForceBin_N = 0.5;
// At most so many bins: beyond 1 kN the last one takes the rest.
inline constexpr std::size_t kMaximumForceBins = 2000;

// Errors of the samples with force_from_N <= measured force < force_to_N.
// A bin without samples has 0 for every error.
struct ForceBin {
  double force_from_N = 0.0;
  double force_to_N = 0.0;
  std::uint64_t count = 0;
  double mean_abs_error_N = 0.0;
  double std_abs_error_N = 0.0;  // population standard deviation
  double max_abs_error_N = 0.0;
  double jnd_N = 0.0;  // at the middle of the bin
};

// Without samples every figure is 0 and there are no bins; whoever shows them
// looks at `samples` first.
struct ErrorSummary {
  std::uint64_t samples = 0;
  double rms_error_N = 0.0;
  double max_error_N = 0.0;
  double within_jnd = 0.0;  // share of the samples with an error up to one JND
  double p99_error_over_jnd = 0.0;  // nearest rank: 99 % of the samples are no worse
  double max_error_over_jnd = 0.0;
  std::uint64_t out_of_domain_samples = 0;
  // From 0 to the largest measured force; forces below 0 (sensor noise) count in
  // the first bin.
  std::vector<ForceBin> bins;
};

// Takes 4 bytes a sample, for the exact percentile; all else is constant.
class ErrorStatistics {
 public:
  explicit ErrorStatistics(const JndLine& jnd) : jnd_(jnd) {}

  // One sample in contact: both forces finite.
  void add(double model_N, double measured_N, bool out_of_domain);

  ErrorSummary summary() const;

 private:
  struct Moments {  // Welford (1962): no cancellation, whatever the count
    std::uint64_t count = 0;
    double mean = 0.0;
    double squares = 0.0;
    double largest = 0.0;
  };

  std::vector<ForceBin> force_bins() const;

  JndLine jnd_;
  std::uint64_t samples_ = 0;
  std::uint64_t within_ = 0;
  std::uint64_t out_of_domain_ = 0;
  double squares_N2_ = 0.0;
  double max_error_N_ = 0.0;
  double max_ratio_ = 0.0;
  std::vector<float> ratios_;
  std::vector<Moments> bins_;
};

}  // namespace palpate
