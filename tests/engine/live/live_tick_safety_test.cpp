// The live tick under faults: device faults, a released dead-man switch.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/live/live_tick.h"
#include "tests/support/live_doubles.h"

namespace palpate {
namespace {

using test::LiveRig;
using test::PathDevice;
using test::spring;

TEST(LiveTickSafety, NobodyAtTheDeadManKeyIsNoForce) {
  PathDevice device(test::held_5mm);
  LiveRig rig(device);
  rig.publish(1, {spring(300.0)});
  LoopControls controls;
  controls.dead_man = DeadMan::key;
  EXPECT_EQ(rig.run(500, controls).rendered_N, 0.0);
  EXPECT_TRUE(rig.run(1, controls).dead_man_released);
  // A window at 60 Hz reports in each frame that the key is held.
  for (int frame = 0; frame < 60; ++frame) {
    controls.held_s = rig.next_s();
    rig.run(16, controls);
  }
  EXPECT_NEAR(device.force_N(), 1.5, 1e-9);
  EXPECT_FALSE(rig.run(1, controls).dead_man_released);
  // The window hangs while the key is held.
  EXPECT_EQ(rig.run(250, controls).rendered_N, 0.0);
  EXPECT_TRUE(rig.run(1, controls).dead_man_released);
}

// Into the block at up to 24 mm/s and out again.
TEST(LiveTickSafety, AScaledForceIsEasedAndLimitedAndNeverPulls) {
  PathDevice plain_device(test::strokes), device(test::strokes, {6.0, 1e9, 0.0});
  LiveRig plain(plain_device), rig(device);
  plain.publish(1, {spring(600.0)});
  rig.publish(1, {spring(600.0)});
  double last_N = 0.0, largest_N = 0.0;
  LoopControls controls;
  for (int tick = 0; tick < 4000; ++tick) {
    if (tick == 1000) controls.scale = {4.0, 8.0};
    if (tick == 3000) controls.scale = {};
    const LoopSnapshot& scaled = rig.run(1, controls);
    const LoopSnapshot& as_it_is = plain.run();
    const double force_N = as_it_is.commanded_N;
    if (tick < 1000 || tick > 3600) {
      ASSERT_EQ(scaled.commanded_N, force_N) << "its bits";
    }
    if (tick > 1600 && tick < 3000) {
      const double damped_N = 4.0 * force_N + 8.0 * as_it_is.tick.velocity_m_per_s;
      ASSERT_NEAR(scaled.commanded_N, as_it_is.tick.in_contact ? std::max(0.0, damped_N) : 0.0, 1e-9) << tick;
    }
    ASSERT_GE(scaled.rendered_N, 0.0);
    ASSERT_LE(scaled.rendered_N, 6.0) << "the limiter comes behind it";
    ASSERT_LE(std::abs(scaled.commanded_N - last_N), 0.4) << "no kick";
    last_N = scaled.commanded_N;
    largest_N = std::max(largest_N, last_N);
  }
  EXPECT_GT(largest_N, 9.0);
}

// The tool is in the air for a second, then shaken inside the block. Read with a 30 um encoder.
double shaken(double time_s) {
  const double position_m = time_s < 1.0 ? -1e-3 : 2e-3 + 1.5e-3 * std::sin(125.0 * time_s);
  return 30e-6 * std::round(position_m / 30e-6);
}

TEST(LiveTickSafety, AScaledForceIsKeptAsPassiveAsThatOfAStifferModel) {
  PathDevice stiff_device(shaken), device(shaken);
  LiveRig stiff(stiff_device), rig(device);
  stiff.publish(1, {spring(4 * 750.0)});
  rig.publish(1, {spring(750.0)});
  LoopControls controls;
  controls.scale.stiffness = 4.0;
  double taken_N = 0.0;
  for (int tick = 0; tick < 3000; ++tick) {
    const LoopSnapshot& scaled = rig.run(1, controls);
    const LoopSnapshot& as_stiff = stiff.run();
    ASSERT_NEAR(scaled.commanded_N, as_stiff.commanded_N, 1e-9) << tick;
    ASSERT_NEAR(scaled.rendered_N, as_stiff.rendered_N, 1e-6) << tick;
    taken_N = std::max(taken_N, std::abs(scaled.passive_N - scaled.commanded_N));
  }
  EXPECT_GT(taken_N, 0.01) << "or the controller had nothing to do";
}

TEST(LiveTickSafety, ADeviceInTroubleGetsNoForceAndIsRemembered) {
  PathDevice device(test::held_5mm, {10.0, 1000.0, 0.05});
  LiveRig rig(device);
  rig.publish(1, {spring(1000.0)});
  LoopControls controls;
  const DeviceHealth well;
  DeviceHealth faulty, not_zeroed, old;
  faulty.faults = device_fault::kJump;
  not_zeroed.zeroing = Zeroing::needed;
  old.sample_age_s = 0.02;
  for (const auto& [trouble, bit] :
       {std::pair{faulty, loop_fault::kDeviceFault}, {old, loop_fault::kStaleSample}, {not_zeroed, 0u}}) {
    device.state = well;
    rig.run(500, controls);
    EXPECT_NEAR(device.force_N(), 5.0, 0.01);
    controls.acknowledged += 1;
    EXPECT_EQ(rig.run(1, controls).faults_latched & loop_fault::kStops, 0u);
    device.state = trouble;
    EXPECT_EQ(rig.run(12, controls).faults & loop_fault::kStops, bit);
    EXPECT_EQ(device.force_N(), 0.0);
    device.state = well;
    const LoopSnapshot& snapshot = rig.run(5, controls);
    EXPECT_LT(device.force_N(), 0.6) << "ramps up again";
    EXPECT_EQ(snapshot.faults_latched & loop_fault::kStops, bit) << "until it is acknowledged";
    EXPECT_EQ(snapshot.device_faults_latched, trouble.faults);
  }
}

// The warm-up evaluates models in contact. Its forces must not reach a device.
TEST(LiveTickSafety, ADeviceThatHasGivenNothingIsNotDriven) {
  PathDevice device(test::held_5mm, {10.0, 1000.0, 0.05});
  device.silent = true;
  LiveRig rig(device);
  rig.publish(1, {spring(1000.0)});
  rig.live().warm_up();
  for (int i = 0; i < 100; ++i) {
    const LoopSnapshot& snapshot = rig.run();
    ASSERT_EQ(snapshot.commanded_N, 0.0);
    ASSERT_EQ(device.force_N(), 0.0);
    ASSERT_NE(snapshot.faults & loop_fault::kStaleSample, 0u);
  }
  device.silent = false;
  rig.run(150);
  EXPECT_NEAR(device.force_N(), 5.0, 1e-9);
  device.silent = true;
  rig.run(25);
  EXPECT_EQ(device.force_N(), 0.0) << "its last sample is too old";
}

}  // namespace
}  // namespace palpate
