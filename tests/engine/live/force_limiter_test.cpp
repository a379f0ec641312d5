// Tests each limit separately. Without a limit, its test fails.
#include "engine/live/force_limiter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

namespace palpate {
namespace {

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

}  // namespace
}  // namespace palpate
