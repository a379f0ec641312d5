// The mouse as a tool, which yields to the force.
#include "devices/virtual/simulated_devices.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <thread>

#include "devices/registry/device_registry.h"

namespace palpate {
namespace {

constexpr double kTick_s = 1e-3;

// Runs `ticks` ticks from `from_s` on and returns the last sample.
DeviceSample advance(Device& device, double from_s, int ticks, double force_N = 0.0) {
  DeviceSample sample;
  for (int i = 0; i < ticks; ++i) {
    device.read(from_s + kTick_s * i, sample);
    device.write(force_N);
  }
  return sample;
}

TEST(MouseDevice, FollowsItsTargetAndIsPushedOff) {
  MouseDevice device;
  device.set_target(5e-3, 0.0);
  EXPECT_NEAR(advance(device, 0.0, 1000).tool.position_m, 5e-3, 1e-6) << "settled for 50 time constants";
  // 4 N against 800 N/m: 5 mm.
  EXPECT_NEAR(advance(device, 1.0, 1000, 4.0).tool.position_m, 0.0, 1e-6);
}

TEST(MouseDevice, AJumpOfTheTargetIsNoneOfTheTool) {
  MouseDevice device;
  advance(device, 0.0, 10);
  device.set_target(20e-3, 0.01);
  DeviceSample sample;
  double last_m = device.position_m();
  for (int i = 10; i < 500; ++i) {
    ASSERT_TRUE(device.read(kTick_s * i, sample));
    // 26 mm through a coupling of some 15 ms cannot be faster than 2 m/s.
    ASSERT_LT(std::abs(sample.tool.position_m - last_m), 2e-3);
    last_m = sample.tool.position_m;
  }
  EXPECT_LT(last_m, 20.1e-3);
}

TEST(MouseDevice, KeepsTargetsInReachAndFinite) {
  MouseDevice device;
  device.set_target(1.0, 0.0);
  EXPECT_EQ(device.target_m(), 0.03);
  device.nudge(-1e-3, 0.0);
  EXPECT_EQ(device.target_m(), 0.03 - 1e-3);
  device.set_target(std::numeric_limits<double>::quiet_NaN(), 0.0);
  EXPECT_EQ(device.target_m(), 0.03 - 1e-3);
  device.nudge(-std::numeric_limits<double>::infinity(), 0.0);
  EXPECT_EQ(device.target_m(), 0.03 - 1e-3);
}

TEST(MouseDevice, MovesWithARampAndStopsAtTheLimit) {
  MouseDevice device;
  advance(device, 0.0, 100);
  device.drive(0.018, 0.004, 0.1);
  DeviceSample sample = advance(device, 0.1, 30);
  EXPECT_LT(sample.tool.velocity_m_per_s, 0.01) << "half of the ramp of 60 ms, and the low-pass";
  sample = advance(device, 0.13, 200);
  EXPECT_NEAR(sample.tool.velocity_m_per_s, 0.018, 1e-3);
  EXPECT_FALSE(device.idle(1e6)) << "a held key is not idle";
  EXPECT_NEAR(advance(device, 0.33, 2000).tool.position_m, 0.004, 6e-4) << "inwards to the limit";
  // In contact the target is deeper than the tool.
  EXPECT_NEAR(advance(device, 2.33, 2000, 2.0).tool.position_m, 0.004, 6e-4);
  device.drive(-0.018, -0.002, 4.33);
  EXPECT_NEAR(advance(device, 4.33, 2000).tool.position_m, -0.002, 1e-6) << "outwards to the limit";
  device.set_target(-0.008, 6.33);
  EXPECT_NEAR(advance(device, 6.33, 1000).tool.position_m, -0.008, 1e-6) << "further out already";
  device.drive(0.0, 0.0, 7.33);
  EXPECT_TRUE(device.idle(1e6));
  const double rest_m = advance(device, 7.33, 1000).tool.position_m;
  EXPECT_NEAR(advance(device, 8.33, 1000).tool.position_m, rest_m, 1e-9);
  device.drive(std::numeric_limits<double>::quiet_NaN(), 0.0, 9.33);
  EXPECT_NEAR(advance(device, 9.33, 1000).tool.position_m, rest_m, 1e-9);
}

TEST(MouseDevice, TakesTargetsFromAnotherThread) {
  MouseDevice device;
  std::thread window([&] {
    for (int i = 0; i < 10000; ++i) device.set_target(1e-6 * i, 1e-3 * i);
  });
  const DeviceSample sample = advance(device, 0.0, 2000);
  window.join();
  EXPECT_TRUE(std::isfinite(sample.tool.position_m));
  EXPECT_NEAR(advance(device, 2.0, 1000).tool.position_m, 9999e-6, 1e-6);
}

TEST(AutoDevice, GivesWayToTheMouseAndComesBack) {
  AutoDevice device;
  DeviceSample sample;
  double last_m = 0.0;
  bool first = true;
  const auto run = [&](int from_tick, int to_tick) {
    for (int i = from_tick; i < to_tick; ++i) {
      if (!device.read(kTick_s * i, sample)) continue;
      if (!first) {
        ASSERT_LT(std::abs(sample.tool.position_m - last_m), 2e-3) << "a jump at " << i;
      }
      first = false;
      last_m = sample.tool.position_m;
      device.write(500.0 * std::max(0.0, last_m));
    }
  };
  run(0, 3000);
  EXPECT_TRUE(device.hand_is_exploring());
  device.tool_input()->set_target(-2e-3, 3.0);
  run(3000, 5000);
  EXPECT_FALSE(device.hand_is_exploring());
  EXPECT_NEAR(last_m, -2e-3, 1e-6);
  run(5000, 22999);
  EXPECT_FALSE(device.hand_is_exploring());
  run(22999, 40000);
  EXPECT_TRUE(device.hand_is_exploring()) << "after 20 s";
  device.tool_input()->set_target(-2e-3, 40.0);
  run(40000, 41000);
  EXPECT_FALSE(device.hand_is_exploring());
  device.tool_input()->release();
  run(41000, 42000);
  EXPECT_TRUE(device.hand_is_exploring()) << "at once, when it is said";
}

}  // namespace
}  // namespace palpate
