// A model's errors so far, in memory that does not grow with time.
//
// Thread guarantee: value type; slow side (allocates).
// Source: figures 4 to 7 of Hoever & Harders (2009) for the force bins.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/tick/jnd.h"

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

class ErrorFigures {
 public:
  // One sample in contact, both forces finite; always with the same `jnd`.
  void add(double model_N, double reference_N, bool out_of_domain, const JndLine& jnd);

  std::uint64_t samples() const noexcept { return samples_; }
  // The rest is 0 without samples.
  double within_jnd() const noexcept;  // share
  double rms_error_N() const noexcept;
  double max_error_N() const noexcept { return max_error_N_; }
  double mean_error_over_jnd() const noexcept;
  double max_error_over_jnd() const noexcept { return max_ratio_; }
  std::uint64_t out_of_domain_samples() const noexcept { return out_of_domain_; }
  // From 0 to the largest reference force, kForceBin_N each; forces below 0 (sensor
  // noise) count in the first bin.
  std::vector<ForceBin> bins(const JndLine& jnd) const;

 private:
  struct Moments {  // Welford (1962): no cancellation, whatever the count
    std::uint64_t count = 0;
    double mean = 0.0;
    double squares = 0.0;
    double largest = 0.0;
  };

  std::uint64_t samples_ = 0;
  std::uint64_t within_ = 0;
  std::uint64_t out_of_domain_ = 0;
  double squares_N2_ = 0.0;
  double max_error_N_ = 0.0;
  double ratios_ = 0.0;  // sum
  double max_ratio_ = 0.0;
  std::vector<Moments> bins_;  // at most kMaximumForceBins
};

}  // namespace palpate
