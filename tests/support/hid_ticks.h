// Ticks by hand for a HID device with its threads, in real time.
#pragma once

#include <chrono>
#include <functional>
#include <thread>

#include "engine/live/device.h"
#include "engine/live/pacer.h"

namespace palpate::test {

// Reads and writes `force_N` about every millisecond until `done`; false when that
// takes far too long.
inline bool tick_until(Device& device, double force_N, const std::function<bool(const DeviceHealth&)>& done) {
  for (int i = 0; i < 10'000; ++i) {
    DeviceSample sample;
    device.read(steady_now_s(), sample);
    device.write(force_N);
    if (done(device.health(steady_now_s()))) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

// For tests in real time: a slow machine must not look like a slow device.
template <typename Calibration>
Calibration patient(Calibration calibration) {
  calibration.limits.stale_after_s = 1.0;
  calibration.stuck_after_s = 60.0;
  return calibration;
}

}  // namespace palpate::test
