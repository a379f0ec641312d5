#include "devices/virtual/simulated_devices.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <thread>
#include <vector>

#include "devices/registry/device_registry.h"

namespace palpate {
namespace {

// The simulated hand as a device: exploration, reaction to forces, repeatability.

constexpr double kTick_s = 1e-3;

// The positions of the hand on a spring in `ticks` ticks.
std::vector<double> explore(HandDevice& device, double stiffness_N_per_m, int ticks) {
  std::vector<double> positions_m;
  DeviceSample sample;
  for (int i = 0; i < ticks; ++i) {
    EXPECT_TRUE(device.read(kTick_s * i, sample));
    EXPECT_LT(std::abs(sample.tool.position_m), 0.1) << "finite and stable";
    positions_m.push_back(sample.tool.position_m);
    device.write(stiffness_N_per_m * std::max(0.0, sample.tool.position_m));
  }
  return positions_m;
}

TEST(HandDevice, PressesAndLeavesAgainAndAgain) {
  HandDevice device;
  const std::vector<double> positions_m = explore(device, 800.0, 30000);
  int presses = 0;
  for (std::size_t i = 1; i < positions_m.size(); ++i) presses += positions_m[i] > 0.0 && positions_m[i - 1] <= 0.0;
  EXPECT_GE(presses, 10) << "in half a minute";
  const double deepest_m = *std::max_element(positions_m.begin(), positions_m.end());
  EXPECT_GT(800.0 * deepest_m, 3.0) << "N: it presses in earnest";
  // It aims for at most 6 N, with an error of up to half in its estimate of the stiffness.
  EXPECT_LT(800.0 * deepest_m, 9.0);
}

// The same seed in air and on springs: a stiffer spring reduces the depth.
TEST(HandDevice, IsPushedBackByTheForce) {
  double before_m = 0.03;
  for (const double stiffness_N_per_m : {200.0, 800.0, 3000.0}) {
    HandDevice device;
    const std::vector<double> positions_m = explore(device, stiffness_N_per_m, 30000);
    const double deepest_m = *std::max_element(positions_m.begin(), positions_m.end());
    EXPECT_LT(deepest_m, before_m);
    EXPECT_GT(*std::min_element(positions_m.begin(), positions_m.end()), -0.03) << "stable";
    before_m = deepest_m;
  }
  HandDevice other(3);
  explore(other, 3000.0, 30000);
  HandDevice device;
  const std::vector<double> in_air_m = explore(device, 0.0, 30000);
  EXPECT_LT(*std::max_element(in_air_m.begin(), in_air_m.end()), 1.1 * HandSettings().deepest_m)
      << "where nothing pushes back, only its overshoot is deeper";
}

// The mouse as a tool, which yields to the force.

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

// A recording as a device: every row once, unchanged, at the recorded rate.

Recording ramp(std::size_t rows, double rate_Hz) {
  Recording recording;
  recording.name = "ramp";
  for (std::size_t i = 0; i < rows; ++i) {
    RecordingRow row;
    row.time_s = 7.0 + static_cast<double>(i) / rate_Hz;
    row.position_m = 1e-6 * static_cast<double>(i);
    row.force_N = 1e-3 * static_cast<double>(i);
    recording.rows.push_back(row);
  }
  return recording;
}

// Returns the samples of `ticks` ticks, at most kMaxSamplesPerTick a tick.
struct Player {
  ReplayDevice& device;
  int tick = 0;
  std::vector<DeviceSample> play(int ticks) {
    std::vector<DeviceSample> samples;
    DeviceSample sample;
    for (int end = tick + ticks; tick < end; ++tick) {
      for (int i = 0; i < kMaxSamplesPerTick && device.read(kTick_s * tick, sample); ++i) samples.push_back(sample);
    }
    return samples;
  }
};

TEST(ReplayDevice, HandsOverEveryRowOnceAndUnchanged) {
  for (const double rate_Hz : {10.0, 500.0, 1000.0, 2000.0, 20000.0}) {
    const Recording recording = ramp(2000, rate_Hz);
    ReplayDevice device(recording);
    Player player{device};
    // Ends before the next round begins.
    const std::vector<DeviceSample> samples = player.play(static_cast<int>(2000.0 / rate_Hz / kTick_s) + 1);
    ASSERT_GE(samples.size(), 1998u) << rate_Hz;
    for (std::size_t i = 0; i < std::min<std::size_t>(samples.size(), 2000); ++i) {
      ASSERT_EQ(samples[i].tool.time_s, recording.rows[i].time_s);
      ASSERT_EQ(samples[i].tool.position_m, recording.rows[i].position_m);
      ASSERT_EQ(samples[i].measured_N, recording.rows[i].force_N);
      ASSERT_EQ(samples[i].restart, i == 0);
    }
  }
}

TEST(ReplayDevice, MovesTheSurfaceAndRestarts) {
  const Recording recording = ramp(2000, 1000.0);
  ReplayDevice device(recording);
  Player player{device};
  player.play(100);
  const double at_s = device.playhead_s();
  device.move_surface(std::nan(""));  // ignored
  device.move_surface(0.25e-3);
  const std::vector<DeviceSample> samples = player.play(100);
  ASSERT_GT(samples.size(), 90u);
  EXPECT_TRUE(samples.front().restart);
  EXPECT_NEAR(samples.front().tool.time_s - recording.rows.front().time_s, at_s, 2e-3);
  for (const DeviceSample& sample : samples) {
    const auto row = static_cast<std::size_t>(std::lround((sample.tool.time_s - 7.0) * 1000.0));
    EXPECT_EQ(sample.tool.position_m, recording.rows[row].position_m - 0.25e-3);
    EXPECT_EQ(sample.measured_N, recording.rows[row].force_N);
  }
  EXPECT_EQ(device.surface_offset_m(), 0.25e-3);
}

TEST(ReplayDevice, SeeksAlsoWhilePaused) {
  ReplayDevice device(ramp(1000, 1000.0));
  Player player{device};
  player.play(10);
  device.pause(true);
  device.seek(0.5);
  std::vector<DeviceSample> samples = player.play(5);
  ASSERT_EQ(samples.size(), 1u) << "what is there now";
  EXPECT_NEAR(samples[0].measured_N, 0.5, 1.1e-3) << "the row at that time or the next";
  EXPECT_TRUE(samples[0].restart);
  device.seek(99.0);
  samples = player.play(5);
  ASSERT_EQ(samples.size(), 1u);
  EXPECT_EQ(samples[0].measured_N, 0.999) << "the last one";
  EXPECT_NEAR(device.playhead_s(), device.duration_s(), 1e-12);
}

}  // namespace
}  // namespace palpate
