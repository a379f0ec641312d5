// Error statistics of a model in bounded memory, in total and in bins of the reference force.
// Every bin is kBinWidth_jnd just noticeable differences wide. With JND(F) = o + w F the number of JNDs
// between 0 and F is
//   u(F) = integral_0^F dF / JND = log(1 + w F / o) / w,   F / o where w is 0,
// and bin k holds the forces with k <= u / kBinWidth_jnd < k + 1. With the paper's JND line this gives about
// 3 bins up to 0.3 N, 15 up to 6 N and 63 up to 3 kN.
// Thread guarantee: value type; slow side (allocates).
// Source: figures 4 to 7 of Hoever & Harders (2009).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/tick/jnd.h"

namespace palpate {

inline constexpr double kBinWidth_jnd = 2.0;
// Bounds the memory where the JND line is flat. The last bin holds all larger forces.
inline constexpr std::size_t kMaximumForceBins = 2000;

// The index of the bin of a force, N; forces below 0 (sensor noise) are in bin 0.
std::size_t force_bin(double force_N, const JndLine& jnd) noexcept;
// The smallest force in bin `index`, N.
double force_bin_begin_N(std::size_t index, const JndLine& jnd) noexcept;

// Mean, population standard deviation and maximum of non-negative values, updated without cancellation. Without values
// all are 0.
// Source: Welford (1962).
class Moments {
 public:
  void add(double value);

  std::uint64_t count() const noexcept { return count_; }
  double mean() const noexcept { return mean_; }
  double deviation() const noexcept;
  double largest() const noexcept { return largest_; }

 private:
  std::uint64_t count_ = 0;
  double mean_ = 0.0;
  double squares_ = 0.0;  // sum of squared deviations from the mean
  double largest_ = 0.0;
};

// The samples with force_from_N <= measured force < force_to_N.
struct ForceBin {
  double force_from_N = 0.0;
  double force_to_N = 0.0;
  double jnd_N = 0.0;  // at the middle of the bin
  Moments force_N;     // measured
  Moments error_N;     // absolute value
  Moments over_jnd;    // error / JND, computed sample by sample
  Moments relative;    // error / force, of the samples with a force other than 0
};

// The figures of merit. Without samples every figure is 0 and `bins` is empty; check `samples` first.
struct ErrorSummary {
  std::uint64_t samples = 0;
  double rms_error_N = 0.0;
  double max_error_N = 0.0;
  double within_jnd = 0.0;  // share of the samples with an error up to one JND
  double p99_error_over_jnd = 0.0;
  double max_error_over_jnd = 0.0;
  std::uint64_t out_of_domain_samples = 0;
  std::vector<ForceBin> bins;  // from 0 to the largest measured force
};

class ErrorFigures {
 public:
  // Adds one sample in contact. Both forces are finite, and `jnd` is the same in every call.
  void add(double model_N, double reference_N, bool out_of_domain, const JndLine& jnd);

  std::uint64_t samples() const noexcept { return sum_.samples; }
  // Without samples the following figures are 0.
  double within_jnd() const noexcept { return share(within_); }  // share of the samples with an error up to one JND
  double mean_error_over_jnd() const noexcept { return share(ratios_); }
  double max_error_over_jnd() const noexcept { return sum_.max_error_over_jnd; }
  // All but the 99 % error, which needs every sample.
  ErrorSummary summary(const JndLine& jnd) const;

 private:
  double share(double total) const noexcept { return total / std::max(1.0, static_cast<double>(sum_.samples)); }

  // Counts and largest errors. Of the bins, at most kMaximumForceBins, only the moments are set.
  ErrorSummary sum_;
  double within_ = 0.0;
  double squares_N2_ = 0.0;
  double ratios_ = 0.0;  // sum
};

}  // namespace palpate
