// The perceivable error: the mean of (model - reference) / JND over the last 50 ms. A difference of a single
// millisecond moves neither hand nor skin, but one that lasts does.
// Thread guarantee: value type; constant time and memory.
#pragma once

#include <array>
#include <cstddef>

namespace palpate {

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
  void reset() noexcept { count_ = 0; }

 private:
  struct Sample {
    double time_s = 0.0;
    double difference = 0.0;
  };
  // Holds the span at 1 kHz; at a higher rate the newest 64 samples.
  std::array<Sample, 64> samples_{};
  std::size_t first_ = 0;
  std::size_t count_ = 0;
  double sum_ = 0.0;
};

}  // namespace palpate
