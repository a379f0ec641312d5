// Calls ticks of a HID device with its threads, in real time.
#pragma once

#include <chrono>
#include <functional>
#include <thread>

#include "engine/live/device.h"
#include "engine/live/pacer.h"

namespace palpate::test {

// Reads a sample and writes `force_N` about every millisecond until `done` returns true.
// Returns false after 10,000 ticks.
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

// Longer timeouts for tests in real time, so that a slow machine causes no device faults.
template <typename Calibration>
Calibration patient(Calibration calibration) {
  calibration.limits.stale_after_s = 1.0;
  calibration.stuck_after_s = 60.0;
  return calibration;
}

}  // namespace palpate::test
