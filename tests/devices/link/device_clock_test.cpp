// Conversion of the device's time to the host's clock.
#include "devices/link/device_endpoint.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/base/random_stream.h"

namespace palpate {
namespace {

// Reports every 1 ms with up to 0.4 ms of jitter, from a device whose clock is 100 ppm
// fast and wraps: the time steps between samples are still even.
TEST(DeviceClock, TakesTheJitterAway) {
  DeviceClock clock;
  RandomStream random(1, 0);
  double last_s = 0.0;
  double worst_step_s = 0.0, worst_lag_s = 0.0;
  for (int i = 0; i < 60'000; ++i) {
    const double true_s = 10.0 + 1e-3 * i;
    const auto device_us = static_cast<std::uint32_t>(4'290'000'000u + static_cast<std::uint32_t>(1000.1 * i));
    const double host_s = clock.host_time_s(device_us, true_s + 0.2e-3 + random.uniform(0.0, 0.4e-3));
    if (i > 1000) {
      worst_step_s = std::max(worst_step_s, std::abs(host_s - last_s - 1e-3));
      worst_lag_s = std::max(worst_lag_s, std::abs(host_s - true_s));
    }
    last_s = host_s;
  }
  EXPECT_LT(worst_step_s, 30e-6);
  EXPECT_LT(worst_lag_s, 1.3e-3) << "the shortest way, and the drift it follows";
}

}  // namespace
}  // namespace palpate
