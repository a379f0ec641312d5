// The error that a hand can notice: the mean of (model - reference) / JND over the last 50 ms; 0 out of
// contact. A difference of a single millisecond moves no hand and no skin; one that lasts does.
// Thread guarantee: value type; constant time and memory.
#pragma once

#include <array>
#include <cstddef>

namespace palpate {

class SustainedError {
 public:
  static constexpr double kSpan_s = 0.05;

  // `difference_over_jnd`: signed, finite. `time_s` rises; a gap of more than the span
  // begins anew. Returns the mean, signed.
  double add(double time_s, double difference_over_jnd) noexcept {
    if (count_ > 0) {
      const Sample& last = samples_[(first_ + count_ - 1) % samples_.size()];
      if (time_s < last.time_s || time_s - last.time_s > kSpan_s) count_ = 0;
    }
    if (count_ == 0) sum_ = 0.0;  // nothing of earlier roundings stays
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
  // More than a span of a loop of 1 kHz; of a faster one the newest.
  std::array<Sample, 64> samples_{};
  std::size_t first_ = 0;
  std::size_t count_ = 0;
  double sum_ = 0.0;
};

}  // namespace palpate
