// A recording as a device: every row once, unchanged, at the recorded rate.
#include "devices/virtual/simulated_devices.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace palpate {
namespace {

constexpr double kTick_s = 1e-3;

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

TEST(ReplayDevice, PlaysFasterAndSlower) {
  ReplayDevice device(ramp(10000, 1000.0));
  Player player{device};
  player.play(10);
  device.set_speed(4.0);
  EXPECT_NEAR(static_cast<double>(player.play(100).size()), 400.0, 1.0);
  device.set_speed(0.25);
  EXPECT_NEAR(static_cast<double>(player.play(100).size()), 25.0, 1.0);
  device.set_speed(std::nan(""));
  EXPECT_EQ(device.speed(), 0.25);
  device.set_speed(1e9);
  EXPECT_EQ(device.speed(), kFastestReplay);
}

// 20 kHz at ten times the speed is 200 rows a tick: it falls behind, but omits no row.
TEST(ReplayDevice, WaitsForTheLoopWhenItIsTooFast) {
  ReplayDevice device(ramp(20000, 20000.0));
  device.set_speed(kFastestReplay);
  Player player{device};
  const std::vector<DeviceSample> samples = player.play(100);
  EXPECT_LE(samples.size(), 100u * kMaxSamplesPerTick);
  EXPECT_GT(samples.size(), 90u * kMaxSamplesPerTick);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    ASSERT_EQ(samples[i].measured_N, 1e-3 * static_cast<double>(i));
  }
  EXPECT_LT(device.playhead_s(), 0.2);
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

TEST(ReplayDevice, GoesByOneSampleAndPauses) {
  ReplayDevice device(ramp(1000, 1000.0));
  Player player{device};
  const double seen_N = player.play(10).back().measured_N;
  device.step(1);
  EXPECT_TRUE(device.paused());
  std::vector<DeviceSample> samples = player.play(5);
  ASSERT_EQ(samples.size(), 1u);
  EXPECT_NEAR(samples[0].measured_N, seen_N + 1e-3, 1e-12);
  EXPECT_FALSE(samples[0].restart) << "the filters go on";
  device.step(3);
  samples = player.play(5);
  ASSERT_EQ(samples.size(), 3u) << "none is left out";
  device.step(-1);
  samples = player.play(5);
  ASSERT_EQ(samples.size(), 1u);
  EXPECT_NEAR(samples[0].measured_N, seen_N + 3e-3, 1e-12);
  EXPECT_TRUE(samples[0].restart) << "time does not run backwards in a filter";
  device.step(-100000);
  EXPECT_EQ(player.play(5).back().measured_N, 0.0) << "the first one";
  device.seek(0.998);
  player.play(5);
  device.step(100000);
  EXPECT_EQ(player.play(5).back().measured_N, 0.999) << "the last one";
}

}  // namespace
}  // namespace palpate
