// Error statistics of an endless stream of ticks: constant time per tick and bounded memory.
// Thread guarantee: value types; slow side.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "engine/tick/jnd.h"
#include "scenes/evaluation/error_figures.h"

namespace palpate {

// The 99 % error: the smallest error over the JND that 99 % of the samples do not exceed
// (scenes/evaluation/model_errors.h). It is rounded up by at most 1.1 %, never across 1.
class ErrorQuantile {
 public:
  void add(double error_over_jnd) noexcept {
    const double bin = kPerOctave * std::log2(std::max(error_over_jnd, 1e-9)) + kBelow;
    ++counts_[static_cast<std::size_t>(std::clamp(std::ceil(bin - 1e-9), 0.0, kBins - 1.0))];
    ++samples_;
  }
  // 0 without samples.
  double p99() const noexcept {
    std::uint64_t beyond = samples_ / 100;  // number of samples that may lie above
    for (std::size_t i = counts_.size(); i-- > 0;) {
      if (counts_[i] > beyond) return i == 0 ? 0.0 : std::exp2((static_cast<double>(i) - kBelow) / kPerOctave);
      beyond -= counts_[i];
    }
    return 0.0;
  }

 private:
  // Logarithmic bins from 1/1024 to 1024 JND; 1 is the edge of a bin.
  static constexpr double kPerOctave = 64.0;
  static constexpr double kBelow = 10.0 * kPerOctave;
  static constexpr double kBins = 2.0 * kBelow + 1.0;
  std::array<std::uint32_t, static_cast<std::size_t>(kBins)> counts_{};
  std::uint64_t samples_ = 0;
};

// The errors of one model.
class StreamErrors {
 public:
  // Adds one sample in contact. Both forces are finite.
  void add(double model_N, double reference_N, const JndLine& jnd) {
    figures_.add(model_N, reference_N, false, jnd);
    quantile_.add(jnd.error_over_jnd(model_N, reference_N));
  }
  ErrorSummary summary(const JndLine& jnd) const {
    ErrorSummary summary = figures_.summary(jnd);
    summary.p99_error_over_jnd = quantile_.p99();
    return summary;
  }

 private:
  ErrorFigures figures_;
  ErrorQuantile quantile_;
};

// The perceivable error: the mean of (model - reference) / JND over the last 50 ms. A difference of a single
// millisecond moves neither hand nor skin, but one that lasts does.
class SustainedError {
 public:
  static constexpr double kSpan_s = 0.05;

  // `difference_over_jnd`: signed, finite. The window restarts where `time_s` decreases or has a gap longer than
  // the span. Returns the mean, signed.
  double add(double time_s, double difference_over_jnd) noexcept {
    if (count_ > 0) {
      const Sample& last = samples_[(first_ + count_ - 1) % samples_.size()];
      if (time_s < last.time_s || time_s - last.time_s > kSpan_s) count_ = 0;
    }
    if (count_ == 0) sum_ = 0.0;  // discards accumulated rounding errors
    while (count_ > 0 && (count_ == samples_.size() || samples_[first_].time_s <= time_s - kSpan_s)) {
      sum_ -= samples_[first_].difference;
      first_ = (first_ + 1) % samples_.size();
      --count_;
    }
    samples_[(first_ + count_) % samples_.size()] = {time_s, difference_over_jnd};
    ++count_;
    sum_ += difference_over_jnd;
    return sum_ / static_cast<double>(count_);
  }

 private:
  struct Sample {
    double time_s = 0.0, difference = 0.0;
  };
  // Holds the span at 1 kHz; at a higher rate the newest 64 samples.
  std::array<Sample, 64> samples_{};
  std::size_t first_ = 0, count_ = 0;
  double sum_ = 0.0;
};

}  // namespace palpate
