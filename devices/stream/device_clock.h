// When, on the host's clock, a device took a sample that carries the device's own
// time. Reports come with jitter, the device's clock ticks evenly: host time =
// device time + offset, where the report that came soonest after its sample knows
// the offset best; slowly forgotten, so that clocks may drift apart.
// Thread guarantee: one thread; wait-free, never throws.
#pragma once

#include <algorithm>
#include <cstdint>

namespace palpate {

class DeviceClock {
 public:
  // The device's time wraps at 32 bits; `arrival_s` never decreases. Returns host
  // seconds, at most `arrival_s`.
  double host_time_s(std::uint32_t device_us, double arrival_s) noexcept {
    if (!started_) {
      started_ = true;
      device_s_ = 0.0;
      offset_s_ = arrival_s;
    } else {
      device_s_ += 1e-6 * static_cast<double>(static_cast<std::int32_t>(device_us - last_us_));
    }
    last_us_ = device_us;
    const double lag_s = arrival_s - (device_s_ + offset_s_);
    // 1e-4 of the lag per report: at 1 kHz a drift of 100 ppm is followed to 1 ms.
    offset_s_ += lag_s < 0.0 ? lag_s : kForget * std::min(lag_s, kLargestLag_s);
    return std::min(arrival_s, device_s_ + offset_s_);
  }

  void restart() noexcept { started_ = false; }

 private:
  static constexpr double kForget = 1e-4;
  // A burst of old reports does not count as drift.
  static constexpr double kLargestLag_s = 1e-3;

  double device_s_ = 0.0;
  double offset_s_ = 0.0;
  std::uint32_t last_us_ = 0;
  bool started_ = false;
};

}  // namespace palpate
