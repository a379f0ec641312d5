#include "engine/live/device.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <utility>

#include "engine/base/random_stream.h"
#include "engine/live/force_guard.h"
#include "tests/support/message_parts.h"

namespace palpate {
namespace {

// Tests each limit separately. Without a limit, its test fails.

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kTick_s = 1e-3;

// A limiter in which only one limit is reached.
ForceLimiter with(double largest_N, double fastest_N_per_s, double ramp_s) {
  return ForceLimiter({largest_N, fastest_N_per_s, ramp_s});
}

TEST(ForceLimiter, PassesFiniteForcesUpToTheLargest) {
  ForceLimiter limiter = with(10.0, 1e9, 0.0);
  limiter.limit(0.0, kTick_s);
  for (const double force_N : {0.1, 3.0, 7.7, 0.3, -2.0, 10.0, -10.0}) {
    EXPECT_EQ(limiter.limit(force_N, kTick_s), force_N);
    EXPECT_EQ(limiter.flags(), 0u);
  }
  for (const double force_N : {1e300, -11.0}) {
    EXPECT_EQ(limiter.limit(force_N, kTick_s), std::copysign(10.0, force_N));
    EXPECT_EQ(limiter.flags(), force_limit::kClamped);
  }
  for (const double force_N : {kNaN, kInfinity, -kInfinity}) {
    for (int i = 0; i < 2; ++i) limiter.limit(5.0, kTick_s);  // the first one after a stop is 0
    EXPECT_EQ(limiter.limit(force_N, kTick_s), 0.0);
    EXPECT_EQ(limiter.flags(), force_limit::kNotFinite);
  }
}

TEST(ForceLimiter, ChangesNoFasterThanItMay) {
  ForceLimiter limiter = with(100.0, 1000.0, 0.0);
  limiter.limit(0.0, kTick_s);
  double last_N = 0.0;
  int ticks = 0;
  while (last_N < 20.0 && ++ticks < 1000) {
    const double force_N = limiter.limit(20.0, kTick_s);
    EXPECT_LE(force_N - last_N, 1.0 + 1e-12) << "1000 N/s in 1 ms, and rounding";
    last_N = force_N;
  }
  EXPECT_NEAR(ticks, 20, 1);
  // After a fault the slew rate is limited too, so that the force reaches 0 within 10 ms.
  EXPECT_NEAR(limiter.limit(kNaN, kTick_s), 18.0, 1e-12);
  EXPECT_EQ(limiter.flags(), force_limit::kNotFinite | force_limit::kSlewed);
}

TEST(ForceLimiter, AStallOrABrokenClockLicensesNoJump) {
  for (const double step_s : {60.0, kInfinity}) {
    ForceLimiter limiter = with(100.0, 1000.0, 0.0);
    limiter.limit(0.0, kTick_s);
    EXPECT_NEAR(limiter.limit(50.0, step_s), 10.0, 1e-12) << "as after 10 ms";
  }
  for (const double step_s : {0.0, -1.0, kNaN}) {
    ForceLimiter limiter = with(100.0, 1000.0, 0.0);
    limiter.limit(0.0, kTick_s);
    EXPECT_EQ(limiter.limit(50.0, step_s), 0.0);
  }
}

// Expects a linear ramp to a constant 4 N within 100 ticks.
void expect_ramp(ForceLimiter& limiter) {
  double last_N = -1.0;
  for (int i = 0; i < 100; ++i) {
    const double force_N = limiter.limit(4.0, kTick_s);
    EXPECT_NEAR(force_N, 4.0 * i / 100.0, 1e-9);
    EXPECT_EQ(limiter.flags(), force_limit::kRamping);
    EXPECT_GT(force_N, last_N);
    last_N = force_N;
  }
  limiter.limit(4.0, kTick_s);  // rounding may extend the ramp by this tick
  EXPECT_EQ(limiter.limit(4.0, kTick_s), 4.0);
  EXPECT_EQ(limiter.flags(), 0u);
}

TEST(ForceLimiter, RampsUpAtTheStartAndAfterEachFault) {
  ForceLimiter limiter = with(100.0, 1e9, 0.1);
  expect_ramp(limiter);
  limiter.limit(kNaN, kTick_s);
  expect_ramp(limiter);
  limiter.limit(4.0, kTick_s, {.bad_sample = true});
  expect_ramp(limiter);
}

// Ticks from a steady 8 N until the force is zero, under `conditions`.
int ticks_to_zero(const ForceConditions& conditions, std::uint32_t flag) {
  ForceLimits limits = {10.0, 100.0, 0.0};
  ForceLimiter limiter(limits);
  for (int i = 0; i < 100; ++i) limiter.limit(8.0, kTick_s);
  EXPECT_NEAR(limiter.force_N(), 8.0, 1e-9);
  double last_N = limiter.force_N();
  for (int tick = 1; tick <= 100; ++tick) {
    const double force_N = limiter.limit(8.0, kTick_s, conditions);
    EXPECT_NE(limiter.flags() & flag, 0u);
    EXPECT_LE(last_N - force_N, 0.8 + 1e-9) << "a ramp, not a step";
    last_N = force_N;
    if (force_N == 0.0) return tick;
  }
  return 100;
}

TEST(ForceLimiter, AStopTakesTheForceAwayInTenMillisecondsThenRampsUp) {
  for (const auto& [stop, flag] : {std::pair{ForceConditions{0.0101}, force_limit::kStale},
                                   {ForceConditions{kNaN}, force_limit::kStale},
                                   {ForceConditions{kInfinity}, force_limit::kStale},
                                   {ForceConditions{0.0, true}, force_limit::kDeviceFault},
                                   {ForceConditions{0.0, false, true}, force_limit::kReleased}}) {
    EXPECT_LE(ticks_to_zero(stop, flag), 11);
    ForceLimiter limiter = with(100.0, 1e9, 0.1);
    for (int i = 0; i < 200; ++i) limiter.limit(4.0, kTick_s);
    for (int i = 0; i < 20; ++i) limiter.limit(4.0, kTick_s, stop);
    expect_ramp(limiter);
  }
  ForceLimiter limiter = with(10.0, 1e9, 0.0);
  limiter.limit(8.0, kTick_s, {0.0099});
  EXPECT_EQ(limiter.limit(8.0, kTick_s, {0.0099}), 8.0) << "not stale yet";
}

// Peak force 10 N, continuous force 2 N, thermal time constant 10 s.
ForceLimiter with_budget() {
  ForceLimits limits = {10.0, 1e9, 0.0};
  limits.continuous_N = 2.0;
  limits.thermal_time_s = 10.0;
  return ForceLimiter(limits);
}

TEST(ForceLimiter, TheThermalBudgetLeavesTheContinuousForce) {
  ForceLimiter limiter = with_budget();
  limiter.limit(10.0, kTick_s);
  EXPECT_EQ(limiter.limit(10.0, kTick_s), 10.0) << "the peak at first";
  double energy = 0.0;
  for (int i = 0; i < 60'000; ++i) {
    const double force_N = limiter.limit(10.0, kTick_s);
    energy += force_N * force_N * kTick_s;
    EXPECT_LE(limiter.heat_share(), 1.0 + 1e-12);
  }
  EXPECT_NEAR(limiter.force_N(), 2.0, 0.05);
  EXPECT_EQ(limiter.flags(), force_limit::kClamped | force_limit::kThermal);
  // A winding at the continuous force takes 240 N^2 s in a minute. The excess is the
  // part of the budget that was left at the start, 0.2 x 4 N^2 x 10 s.
  EXPECT_LE(energy, 240.0 + 8.0 + 1.0);
}

TEST(ForceLimiter, TheThermalBudgetComesBackWithRest) {
  ForceLimiter limiter = with_budget();
  for (int i = 0; i < 60'000; ++i) limiter.limit(10.0, kTick_s);
  for (int i = 0; i < 30'000; ++i) limiter.limit(0.0, kTick_s);
  EXPECT_LT(limiter.heat_share(), 0.1);
  EXPECT_EQ(limiter.limit(10.0, kTick_s), 10.0);
  // During a stall of a minute the last force is held, and heats for that minute.
  limiter.limit(10.0, 60.0);
  EXPECT_NEAR(limiter.force_N(), 2.0, 0.05);
}

TEST(ForceLimiter, WhatMayBeHeldForEverIsNeverClamped) {
  ForceLimiter limiter = with_budget();
  limiter.limit(1.99, kTick_s);
  for (int i = 0; i < 100'000; ++i) ASSERT_EQ(limiter.limit(1.99, kTick_s), 1.99);
  EXPECT_EQ(with(10.0, 1e9, 0.0).heat_share(), 0.0) << "no budget, no heat";
}

// Switching models without a force step.

constexpr int kWindow = 10;  // ticks in 10 ms

// The largest change within any 10 ms, over the JND of the smaller force.
double worst_over_jnd(const std::vector<double>& forces_N) {
  const JndLine jnd;
  double worst = 0.0;
  for (std::size_t i = 0; i < forces_N.size(); ++i) {
    for (std::size_t j = i; j < std::min(forces_N.size(), i + kWindow + 1); ++j) {
      const double smaller_N = std::min(std::abs(forces_N[i]), std::abs(forces_N[j]));
      worst = std::max(worst, std::abs(forces_N[j] - forces_N[i]) / jnd.at(smaller_N));
    }
  }
  return worst;
}

TEST(ForceMixer, NeverStepsByMoreThanAJndInTenMilliseconds) {
  for (const double other_N : {0.0, 0.5, 3.1, 12.0, 40.0}) {
    ForceMixer mixer({});
    ForceMixer::Forces forces_N{};
    forces_N[0] = 3.0;
    forces_N[1] = other_N;
    std::vector<double> felt_N(20, mixer.mix(forces_N, 0, kTick_s));
    for (int i = 0; i < 3000; ++i) felt_N.push_back(mixer.mix(forces_N, 1, kTick_s));
    EXPECT_EQ(felt_N.back(), other_N) << "it arrives, exactly";
    EXPECT_TRUE(mixer.settled_on(1));
    EXPECT_LE(worst_over_jnd(felt_N), 1.0) << other_N;
  }
}

TEST(ForceMixer, SwitchingToAndFroInMidFadeIsNoKickEither) {
  ForceMixer mixer({});
  ForceMixer::Forces forces_N{};
  forces_N[0] = 1.0;
  forces_N[1] = 5.0;
  forces_N[2] = 0.2;
  std::vector<double> felt_N;
  for (std::size_t i = 0; i < 5000; ++i) felt_N.push_back(mixer.mix(forces_N, (i / 37) % 3, kTick_s));
  EXPECT_LE(worst_over_jnd(felt_N), 1.0);
}

TEST(ForceMixer, FollowsTheModelInTheHandUnhindered) {
  ForceMixer mixer({});
  for (const double force_N : {0.0, 5.0, 0.1, 30.0}) {
    ForceMixer::Forces forces_N{};
    forces_N[0] = force_N;
    EXPECT_EQ(mixer.mix(forces_N, 0, kTick_s), force_N);
  }
}

TEST(ForceMixer, SwitchesAtOnceInTheAirAndBelowWhatCanBeFelt) {
  ForceMixer mixer({});
  ForceMixer::Forces forces_N{};
  EXPECT_EQ(mixer.mix(forces_N, 3, kTick_s), 0.0);
  EXPECT_TRUE(mixer.settled_on(3));
  forces_N.fill(2.0);
  forces_N[4] = 2.01;  // a tenth of a JND is 0.019 N
  EXPECT_EQ(mixer.mix(forces_N, 4, kTick_s), 2.01);
}

TEST(ForceMixer, AStallIsNoLicenceAndNoTimeIsNoStep) {
  ForceMixer mixer({});
  ForceMixer::Forces forces_N{};
  forces_N[1] = 10.0;
  EXPECT_EQ(mixer.mix(forces_N, 1, 0.0), 0.0);
  EXPECT_EQ(mixer.mix(forces_N, 1, -1.0), 0.0);
  EXPECT_LE(mixer.mix(forces_N, 1, 5.0), 0.065);
}

constexpr double kStep_m = 1e-5;  // a tick
constexpr double kSpeed_m_per_s = kStep_m / kTick_s;
constexpr double kDamping_Ns_per_m = 12.0;
// A written force acts two ticks later.
constexpr PassivityController::Timing kTiming{kTick_s, kTick_s, 2.0 * kTick_s};

// A tool that moves one step a tick.
struct Stroke {
  PassivityController controller;
  double depth_m = 0.0;
  double written_N = 0.0;
  bool model_changing = false;

  explicit Stroke(double encoder_step_m = 0.0) : controller(encoder_step_m) {}
  // Moves inward if `steps` is above 0. Returns the last force.
  double move(int steps, double commanded_N) {
    const double direction = steps < 0 ? -1.0 : 1.0;
    for (int i = 0; i < std::abs(steps); ++i) {
      depth_m += direction * kStep_m;
      written_N = controller.apply(commanded_N, {depth_m, direction * kSpeed_m_per_s, true, model_changing}, kTiming,
                                   kDamping_Ns_per_m, written_N);
    }
    return written_N;
  }
};

TEST(PassivityController, LeavesWhatDissipatesAlone) {
  Stroke stroke;
  stroke.move(200, 2.0);
  EXPECT_EQ(stroke.move(-150, 1.0), 1.0);
  EXPECT_EQ(stroke.move(100, 3.0), 3.0);
  EXPECT_EQ(stroke.move(-100, 3.0), 3.0);
}

TEST(PassivityController, TakesWhatIsGivenBackTooMuchAndNoMore) {
  Stroke stroke;
  stroke.move(200, 1.0);
  // On the way out 2 N are commanded and b v = 0.12 N less are rendered. At the turn, the
  // force of the way in acts for two more ticks.
  EXPECT_NEAR(stroke.move(-50, 2.0), 2.0 - kDamping_Ns_per_m * kSpeed_m_per_s, 1e-12);
  // A smaller force is commanded: this and the damping repay the debt down to 0.
  EXPECT_LT(stroke.move(-40, 0.3), 0.3);
  EXPECT_EQ(stroke.move(-60, 0.3), 0.3) << "repaid: the force is what was asked for";
}

// The energy reference depends on depth: energy generation deep inside is detected at
// once, regardless of the energy stored or dissipated on the way there.
TEST(PassivityController, SeesALeakThoughMuchIsStored) {
  Stroke stroke;
  stroke.move(400, 5.0);
  for (int cycle = 0; cycle < 3; ++cycle) {
    EXPECT_LT(stroke.move(-20, 5.5), 5.5);
    stroke.move(20, 5.0);
  }
}

TEST(PassivityController, ForgetsInTheAir) {
  Stroke stroke;
  stroke.move(100, 1.0);
  ASSERT_LT(stroke.move(-50, 3.0), 3.0);
  EXPECT_EQ(stroke.controller.apply(0.5, {-1e-3, -0.1, false, false}, kTiming, kDamping_Ns_per_m, 0.5), 0.5);
  EXPECT_EQ(stroke.move(-10, 3.0), 3.0);
}

// After an exchange, a firmer material returns more energy than the softer one absorbed.
TEST(PassivityController, BeginsAnewWithAnotherMaterial) {
  Stroke stroke;
  stroke.move(100, 1.0);
  stroke.model_changing = true;
  EXPECT_EQ(stroke.move(-10, 3.0), 3.0);
  stroke.model_changing = false;
  EXPECT_EQ(stroke.move(-20, 3.0), 3.0) << "out of where it began: nothing is known";
  stroke.move(40, 3.0);
  EXPECT_LT(stroke.move(-20, 4.0), 4.0) << "passed since, and it gives more than it took";
}

TEST(PassivityController, AFlickeringEncoderIsNoMotion) {
  constexpr double kEncoder_m = 30e-6;
  PassivityController controller(kEncoder_m);
  double written_N = 0.0;
  for (int tick = 0; tick < 5000; ++tick) {
    const double depth_m = 1e-3 + (tick / 3 % 2 == 0 ? 0.0 : kEncoder_m);
    // A delayed force: larger on the way out than on the way in.
    const double force_N = 3000.0 * (1e-3 + (tick / 3 % 2 == 0 ? kEncoder_m : 0.0));
    written_N = controller.apply(force_N, {depth_m, tick / 3 % 2 == 0 ? -1e-3 : 1e-3, true, false}, kTiming,
                                 kDamping_Ns_per_m, written_N);
    ASSERT_EQ(written_N, force_N) << tick;
  }
}

TEST(PassivityController, NeverAddsNeverPullsNeverBreaks) {
  PassivityController controller(30e-6);
  RandomStream random{1, 5};
  double written_N = 0.0;
  for (int tick = 0; tick < 200000; ++tick) {
    const double depth_m = 5e-3 * random.uniform(-0.2, 1.8) * (tick % 7 == 0 ? 10.0 : 1.0);
    const double commanded_N = std::max(0.0, random.uniform(-1.0, 7.0));
    const double speed_m_per_s = random.uniform(-2.0, 2.0);
    written_N = controller.apply(commanded_N, {depth_m, speed_m_per_s, depth_m > 0.0, false}, kTiming,
                                 kDamping_Ns_per_m, written_N);
    ASSERT_LE(written_N, commanded_N);
    ASSERT_GE(written_N, 0.0);
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto force_N = [&](double commanded_N, double position_m, double velocity_m_per_s) {
    return controller.apply(commanded_N, {position_m, velocity_m_per_s, true, false}, kTiming, kDamping_Ns_per_m, 0.0);
  };
  EXPECT_TRUE(std::isnan(force_N(nan, 1e-3, -0.1))) << "the limiter's to refuse";
  EXPECT_EQ(force_N(1.0, nan, -0.1), 1.0);
  EXPECT_EQ(force_N(1.0, 1e-3, nan), 1.0);
}

TEST(Faults, EveryBitHasOneRow) {
  for (const FaultSource source : {FaultSource::device, FaultSource::loop}) {
    std::uint32_t seen = 0;
    for (const Fault& fault : kFaults) {
      if (fault.source != source) continue;
      EXPECT_TRUE(std::has_single_bit(fault.bit));
      EXPECT_EQ(seen & fault.bit, 0u) << fault.sentence;
      seen |= fault.bit;
    }
    EXPECT_EQ(seen, fault_bits_of(source));
    EXPECT_TRUE(std::has_single_bit(seen + 1)) << "no gap between the bits";
  }
}

TEST(Faults, EveryAlarmHasASentenceAndEveryFaultOfADeviceStopsTheForce) {
  for (const Fault& fault : kFaults) {
    EXPECT_TRUE(!fault.alarm || std::strlen(fault.sentence) > 10);
    EXPECT_TRUE(fault.source != FaultSource::device || std::strstr(fault.sentence, ": ") != nullptr)
        << "what happened, then what to do";
    EXPECT_TRUE(fault.source != FaultSource::device || (fault.alarm && fault.stops_force)) << fault.sentence;
  }
  using namespace loop_fault;
  EXPECT_EQ(fault_bits_of(FaultSource::loop, true),
            kBadSample | kModelNotFinite | kForceNotFinite | kStaleSample | kDeviceFault);
}

TEST(Faults, TellsTheAlarmsAmongTheBits) {
  using namespace loop_fault;
  EXPECT_EQ(alarm_words(FaultSource::loop, kForceSlewed | kDeadlineMissed | kDeviceFault), std::vector<std::string>{});
  const std::size_t row = fault_index(FaultSource::loop, kForceThermal);
  EXPECT_EQ(alarm_words(FaultSource::loop, kForceThermal), std::vector<std::string>{kFaults[row].sentence});
  EXPECT_EQ(device_fault_words(fault_bits_of(FaultSource::device)).size(), 12u);
}

// The state of a device and its messages.

TEST(DeviceHealth, PermitsAForceUnlessItHasAFaultOrNeedsZeroing) {
  struct Case {
    Zeroing zeroing;
    bool may_push;
    std::vector<std::string> advice;
  };
  const Case cases[] = {{Zeroing::not_needed, true, {}},
                        {Zeroing::needed, false, {"rest position", "zeroing"}},
                        {Zeroing::hold_still, false, {"hold", "50 %"}},
                        {Zeroing::done, true, {}}};
  DeviceHealth health;
  health.zeroing_progress = 0.5F;
  for (const Case& one : cases) {
    health.zeroing = one.zeroing;
    EXPECT_EQ(health.may_push(), one.may_push);
    EXPECT_EQ(zeroing_words(health).empty(), one.advice.empty());
    EXPECT_TRUE(test::has_parts(zeroing_words(health), one.advice));
  }
  health.faults = device_fault::kLate;
  EXPECT_FALSE(health.may_push());
}

}  // namespace
}  // namespace palpate
