// The interval between the samples of a device, or the ticks of a loop. With fewer than 100 a second a force is held so
// long that no useful stiffness is stable (engine/live/force_guard.h); such a device is refused.
// Thread guarantee: one thread at a time; wait-free.
#pragma once

#include <algorithm>
#include <string>

#include "engine/base/result.h"
#include "engine/base/text.h"

namespace palpate {

class SampleRate {
 public:
  // 100 Hz with 5 % for the error of a clock and lost samples.
  static constexpr double kLongestInterval_s = 0.0105;

  void add(double step_s) noexcept {
    if (count_ < kSlowSamples) ++count_;
    interval_s_ += (step_s - interval_s_) / std::min(count_, kFastSamples);
    slow_s_ += (step_s - slow_s_) / count_;
  }
  // The mean of about ten samples, s; 0 before the first interval.
  double interval_s() const noexcept { return interval_s_; }
  // By the mean of about fifty samples, so that a few lost ones do not count.
  bool too_slow() const noexcept { return count_ >= kFewest && slow_s_ > kLongestInterval_s; }

 private:
  static constexpr double kFewest = 8.0, kFastSamples = 10.0, kSlowSamples = 50.0;
  double count_ = 0.0, interval_s_ = 0.0, slow_s_ = 0.0;
};

// The refusal of a device at its start. Slow side.
inline Error too_slow(const std::string& device, double interval_s) {
  return Error{device + ": sends " + fixed(1.0 / interval_s, 0) +
               " samples a second, expected 100 to 10000; raise the rate of the device's program"};
}

}  // namespace palpate
