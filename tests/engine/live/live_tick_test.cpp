#include "engine/live/live_tick.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "devices/registry/device_registry.h"
#include "devices/virtual/simulated_devices.h"
#include "tests/support/example_model.h"
#include "tests/support/live_doubles.h"
#include "tests/support/rt_guard.h"

namespace palpate {
namespace {

// The body of the live loop: the same forces as replay, no forbidden operations,
// and no force step when models are exchanged.

using test::example_force_models;
using test::LiveRig;
using test::PathDevice;
using test::spring;

// The snapshots of a replay of `recording`.
std::vector<TickSnapshot> replayed(const Recording& recording) {
  std::vector<TickSnapshot> snapshots;
  const auto visit = [&](const RecordingRow&, const TickSnapshot& snapshot, const HapticsTick&) {
    snapshots.push_back(snapshot);
  };
  replay(recording, example_force_models(), visit);
  return snapshots;
}

// Plays the recording twice, so that its second round is compared as well. At more
// than 1 kHz a snapshot is that of the last sample of a tick; the number of samples
// so far identifies it.
void expect_live_equals_replay(double rate_Hz) {
  const Recording recording = test::example_recording(1500, rate_Hz, 30e-6);
  const std::vector<TickSnapshot> expected = replayed(recording);
  ReplayDevice device(recording);
  LiveRig rig(device);
  rig.publish(1, example_force_models());
  rig.live().warm_up();
  std::size_t next = 0;
  std::size_t compared = 0;
  int rounds = 0;
  const int ticks = static_cast<int>(2.0 * device.duration_s() / kHapticTick_s);
  for (int i = 0; i < ticks; ++i) {
    if (i % 3 > 0) rig.live().rehearse();  // must not change the result
    const LoopSnapshot& snapshot = rig.run();
    if (snapshot.samples == 0) continue;
    if (snapshot.restarted) {
      next = 0;
      ++rounds;
    }
    next += snapshot.samples;
    ASSERT_LE(next, expected.size());
    const TickSnapshot& same = expected[next - 1];
    ASSERT_EQ(snapshot.tick.time_s, same.time_s);
    ASSERT_EQ(snapshot.tick.force_N, same.force_N) << rate_Hz << " Hz, sample " << next;
    ASSERT_EQ(snapshot.tick.velocity_m_per_s, same.velocity_m_per_s);
    // The domain is assessed every 16 ms.
    std::size_t past = next;
    while (past > 1 && expected[past - 1].out_of_domain_mask != snapshot.tick.out_of_domain_mask) --past;
    ASSERT_GT(expected[past - 1].time_s, same.time_s - 17e-3) << rate_Hz << " Hz, sample " << next;
    ASSERT_EQ(snapshot.measured_N, recording.rows[next - 1].force_N);
    ++compared;
  }
  EXPECT_EQ(rounds, 2);
  EXPECT_GE(compared, std::min<std::size_t>(expected.size(), 100));
}

TEST(LiveTick, GivesTheBitsOfReplay) {
  for (const double rate_Hz : {500.0, 1000.0, 2000.0, 20000.0}) expect_live_equals_replay(rate_Hz);
}

// Ten thousand ticks with exchanges of models and of the selected model.
int offences(Device& device) {
  LiveRig rig(device);
  rig.publish(1, example_force_models());
  rig.live().warm_up();
  int total = 0;
  std::uint32_t last_id = 0;
  for (std::uint32_t id = 2; id < 22; ++id) {
    rig.publish(id, example_force_models());
    test::RtGuard guard;
    for (std::uint32_t i = 0; i < 500; ++i) {
      rig.live().rehearse();
      last_id = rig.run(1, {id, i / 50 % 8}).models_id;
    }
    total += guard.stop().total();
  }
  EXPECT_GT(last_id, 1u) << "no set was ever taken";
  return total;
}

double strokes_with_faults(double time_s) {
  const double tick = std::round(time_s / kHapticTick_s);
  return std::fmod(tick, 97.0) == 0.0 ? std::numeric_limits<double>::quiet_NaN() : test::strokes(time_s);
}

TEST(LiveTick, DoesNothingForbiddenWithAnyDevice) {
  if (!test::rt_guard_works()) GTEST_SKIP() << "a sanitizer owns malloc";
  HandDevice hand;
  EXPECT_EQ(offences(hand), 0) << "hand";
  MouseDevice mouse;
  mouse.set_target(4e-3, 0.0);
  EXPECT_EQ(offences(mouse), 0) << "mouse";
  AutoDevice automatic;
  automatic.tool_input()->set_target(4e-3, -15.0);
  EXPECT_EQ(offences(automatic), 0) << "auto, taken over by the hand after 5 s";
  ReplayDevice recording(test::example_recording(4000, 2000.0, 30e-6));
  EXPECT_EQ(offences(recording), 0) << "replay";
  PathDevice faulty(strokes_with_faults);
  EXPECT_EQ(offences(faulty), 0) << "bad samples";
}

// A tool held 5 mm deep.
struct Held {
  PathDevice device{test::held_5mm};
  LiveRig rig{device};

  // Runs `ticks` ticks and appends the forces written to the device.
  void run(int ticks, const LoopControls& controls, std::vector<double>& felt_N) {
    for (int i = 0; i < ticks; ++i) felt_N.push_back(rig.run(1, controls).rendered_N);
  }
};

void expect_no_step_above_a_jnd(const std::vector<double>& forces_N) {
  const JndLine jnd;
  for (std::size_t i = 10; i < forces_N.size(); ++i) {
    const double smaller_N = std::min(forces_N[i], forces_N[i - 10]);
    ASSERT_LE(std::abs(forces_N[i] - forces_N[i - 10]), jnd.at(smaller_N)) << i;
  }
}

TEST(LiveTick, SwitchingTheModelInTheHandFades) {
  Held held;
  held.rig.publish(1, {spring(300.0), spring(900.0)});
  EXPECT_NEAR(held.rig.run(1000).rendered_N, 1.5, 1e-9);
  std::vector<double> felt_N;
  held.run(1000, {1, 1}, felt_N);
  EXPECT_NEAR(felt_N.back(), 4.5, 1e-9) << "the depth is an estimate";
  held.run(1000, {1, 0}, felt_N);
  EXPECT_NEAR(held.device.force_N(), 1.5, 1e-9);
  expect_no_step_above_a_jnd(felt_N);
}

TEST(LiveTick, ANewSetFadesInAndTheOldOneIsRetired) {
  Held held;
  std::weak_ptr<const ForceModel> old;
  {
    const auto model = spring(300.0);
    held.rig.publish(1, {model});
    old = model;
  }
  held.rig.run(1000);
  held.rig.publish(2, {spring(900.0), spring(100.0)});
  std::vector<double> felt_N;
  held.run(20, {}, felt_N);
  EXPECT_FALSE(old.expired()) << "still felt";
  EXPECT_FALSE(held.rig.slot().collect());
  held.run(1000, {}, felt_N);
  EXPECT_NEAR(felt_N.back(), 4.5, 1e-9) << "the depth is an estimate";
  expect_no_step_above_a_jnd(felt_N);
  EXPECT_FALSE(old.expired()) << "not deleted by the tick";
  EXPECT_TRUE(held.rig.slot().collect());
  EXPECT_TRUE(old.expired());
}

// The state of the material's memory is kept when models are exchanged in mid-press.
TEST(LiveTick, ANewSetGoesOnWithTheFiltersOfTheOld) {
  const auto run = [](bool change) {
    PathDevice device(test::strokes);
    LiveRig rig(device);
    rig.publish(1, example_force_models());
    std::vector<double> forces_N;
    for (int i = 0; i < 1500; ++i) {
      if (change && i == 700) rig.publish(2, example_force_models());
      const LoopSnapshot& snapshot = rig.run();
      forces_N.insert(forces_N.end(), snapshot.tick.force_N.begin(), snapshot.tick.force_N.end());
    }
    return forces_N;
  };
  EXPECT_EQ(run(true), run(false));
}

TEST(LiveTick, ABadSampleLetsGoAndRampsBack) {
  static double away_m = 0.0;
  away_m = 0.0;
  PathDevice device([](double) { return 5e-3 + away_m; }, {10.0, 1e9, 0.1});
  LiveRig rig(device);
  rig.publish(1, {spring(300.0)});
  EXPECT_NEAR(rig.run(1000).rendered_N, 1.5, 1e-9);
  EXPECT_EQ(rig.run().faults_latched, 0u);
  away_m = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(rig.run().faults, loop_fault::kBadSample);
  EXPECT_EQ(device.force_N(), 0.0);
  away_m = 0.0;
  const LoopSnapshot snapshot = rig.run(10);
  EXPECT_EQ(snapshot.faults, 0u);
  EXPECT_EQ(snapshot.faults_latched, loop_fault::kBadSample);
  EXPECT_NE(snapshot.limiter_flags & force_limit::kRamping, 0u);
  EXPECT_LT(snapshot.rendered_N, 0.2);
  EXPECT_NEAR(rig.run(200).rendered_N, 1.5, 1e-9);
  away_m = 0.03;  // suddenly elsewhere
  EXPECT_EQ(rig.run(50).faults, loop_fault::kStaleSample);
  EXPECT_EQ(device.force_N(), 0.0);
  EXPECT_LT(rig.run(60).rendered_N, 2.0);
  EXPECT_GT(rig.run(200).rendered_N, 9.0);
}

TEST(LiveTick, WithoutModelsShowsTheToolAndNoForce) {
  Held held;
  LoopControls controls;
  controls.scale = {4.0, 20.0};
  const LoopSnapshot snapshot = held.rig.run(5, controls);
  EXPECT_EQ(snapshot.tick.position_m, 5e-3);
  EXPECT_TRUE(snapshot.tick.in_contact);
  EXPECT_EQ(snapshot.tick.model_count, 0u);
  EXPECT_EQ(snapshot.models_id, 0u);
  EXPECT_EQ(held.device.force_N(), 0.0);
  held.rig.publish(1, {});
  EXPECT_EQ(held.rig.run(5, controls).models_id, 1u);
  EXPECT_EQ(held.device.force_N(), 0.0);
}

class CountingReference final : public ReferenceForce {
 public:
  double step(const TickSnapshot& snapshot, bool restart) noexcept override {
    restarts += restart ? 1 : 0;
    return 2.0 * snapshot.depth_m;
  }
  int restarts = 0;
};

TEST(LiveTick, StepsTheReferenceOfTheNewestSet) {
  ReplayDevice device(test::example_recording(500, 1000.0));
  const auto reference = std::make_shared<CountingReference>();
  LiveRig rig(device);
  rig.publish(1, {spring(300.0)}, reference);
  for (int i = 0; i < 1200; ++i) {
    const LoopSnapshot& snapshot = rig.run();
    if (snapshot.samples > 0) {
      ASSERT_EQ(snapshot.reference_N, 2.0 * snapshot.tick.depth_m);
    }
  }
  EXPECT_EQ(reference->restarts, 3);
  rig.publish(2, {spring(300.0)});
  EXPECT_TRUE(std::isnan(rig.run(500).reference_N)) << "the new set has none";
}

// With several samples a tick, a snapshot contains only the last.
TEST(LiveTick, HandsOverEverySampleWhileRecording) {
  const Recording recording = test::example_recording(4000, 4000.0);
  ReplayDevice device(recording);
  LiveRig rig(device);
  auto models = std::make_unique<LiveModels>(1, device.sensor(), ForceModels{spring(300.0), spring(500.0)},
                                             std::make_shared<CountingReference>());
  models->written_model = 1;
  rig.slot().publish(std::move(models));
  rig.run(100);
  RecordedSample sample;
  EXPECT_FALSE(rig.live().recorded().pop(sample)) << "no recording was requested";
  std::vector<RecordedSample> samples;
  for (int tick = 0; tick < 300; ++tick) {
    const LoopSnapshot& snapshot = rig.run(1, {1, 0, 7});
    while (rig.live().recorded().pop(sample)) samples.push_back(sample);
    ASSERT_EQ(samples.back().tool.time_s, snapshot.tick.time_s);
    ASSERT_EQ(samples.back().model_N, snapshot.tick.force_N[1]);
    ASSERT_EQ(samples.back().reference_N, snapshot.reference_N);
  }
  ASSERT_NEAR(static_cast<double>(samples.size()), 1200.0, 4.0);
  const auto first =
      static_cast<std::size_t>(std::lround((samples.front().tool.time_s - recording.rows.front().time_s) * 4000.0));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    ASSERT_EQ(samples[i].tool.position_m, recording.rows[first + i].position_m);
    ASSERT_EQ(samples[i].measured_N, recording.rows[first + i].force_N);
    ASSERT_EQ(samples[i].recording, 7u);
    ASSERT_TRUE(samples[i].usable);
  }
}

// F = 4 N (d / 0.4 mm)^2.5 of a specimen 0.46 mm thick, up to 1.2 x the largest training force.
class ThinModel final : public test::NamedModel {
 public:
  ThinModel() : NamedModel("thin") {}
  double force(const double* features) const noexcept override {
    return std::min(4.0 * std::pow(features[0] / 0.4e-3, 2.5), kLargest_N);
  }
  double deepest_m() const noexcept override { return 0.53e-3; }

 private:
  static constexpr double kLargest_N = 6.8;
};

TEST(LiveTick, TheImpedanceOfAThinSpecimenIsThatOfItsSteepestPlace) {
  const auto thin = std::make_shared<const ThinModel>();
  double steepest_N_per_m = 0.0;
  for (double depth_m = 0.0; depth_m < thin->deepest_m(); depth_m += 1e-6) {
    const double deeper_m = depth_m + 1e-6;
    steepest_N_per_m =
        std::max(steepest_N_per_m, (thin->evaluate(&deeper_m).force_N - thin->evaluate(&depth_m).force_N) / 1e-6);
  }
  const LiveModels set(1, {}, {thin, spring(300.0)});
  EXPECT_NEAR(set.stiffness_N_per_m[0], steepest_N_per_m, 0.05 * steepest_N_per_m);
  EXPECT_NEAR(set.stiffness_N_per_m[1], 300.0, 1e-6);
}

TEST(LiveTick, ASurfaceAtAnotherPositionChangesNoFigure) {
  static constexpr double kShift_m = 12e-3;
  PathDevice device(test::strokes), shifted_device([](double time_s) { return kShift_m + test::strokes(time_s); });
  LiveRig rig(device), shifted_rig(shifted_device);
  ForceModels models, shifted;
  for (ModelData data : test::example_models()) {
    models.push_back(std::make_shared<const FittedModel>(data));
    for (FeatureSpec& spec : data.features)
      if (spec.kind == FeatureKind::depth) spec.surface_position_m += kShift_m;
    shifted.push_back(std::make_shared<const FittedModel>(data));
    EXPECT_GT(impedance_of(models.back()).stiffness_N_per_m, 0.0) << data.name;
    EXPECT_FALSE(probed_forces(models.back()) == probed_forces(shifted.back())) << "another surface is another model";
  }
  rig.publish(1, models);
  shifted_rig.publish(1, shifted);
  const LiveModels set(1, {}, models), shifted_set(1, {}, shifted);
  for (std::size_t i = 0; i < models.size(); ++i) {
    EXPECT_NEAR(set.stiffness_N_per_m[i], shifted_set.stiffness_N_per_m[i], 1e-6 * set.stiffness_N_per_m[i]);
    EXPECT_NEAR(set.damping_Ns_per_m[i], shifted_set.damping_Ns_per_m[i], 1e-6);
  }
  device.force_age = shifted_device.force_age = {5e-3, 5e-3};
  for (LiveRig* one : {&rig, &shifted_rig}) one->live().warm_up();
  double least_share = 1.0;
  for (int i = 0; i < 1500; ++i) {
    const LoopSnapshot one = rig.run(), other = shifted_rig.run();
    for (std::size_t k = 0; k < models.size(); ++k) ASSERT_NEAR(one.tick.force_N[k], other.tick.force_N[k], 1e-6) << k;
    ASSERT_NEAR(one.stiffness_share, other.stiffness_share, 1e-5);
    ASSERT_NEAR(one.rendered_N, other.rendered_N, 1e-5);
    least_share = std::min<double>(least_share, one.stiffness_share);
  }
  EXPECT_LT(least_share, 1.0) << "the limit acts";
}

// The force of a study replaces that of the models, with the same limiter.
TEST(LiveTick, AForceSourceTakesThePlaceOfTheModels) {
  class Source final : public ForceSource {
   public:
    double next_force_N(double rendered_N) noexcept override {
      seen_N = rendered_N;
      return 1.5;
    }
    double seen_N = -1.0;
  };
  Source source;
  PathDevice device(test::held_5mm, {1.0, 1e9, 0.0});
  LiveRig rig(device, {{}, &source});
  EXPECT_EQ(rig.run(3).commanded_N, 1.5);
  EXPECT_EQ(device.force_N(), 1.0) << "clamped to what the device may be given";
  EXPECT_EQ(source.seen_N, 1.0) << "what was rendered in the tick before";
}

// The live tick under faults: device faults, a released dead-man switch.

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
  rig.run(1000);  // the scale rises with a time constant of 50 ms
  EXPECT_NEAR(device.force_N(), 5.0, 1e-9);
  device.silent = true;
  rig.run(25);
  EXPECT_EQ(device.force_N(), 0.0) << "its last sample is too old";
}

}  // namespace
}  // namespace palpate
