// Each limit on its own; without it, its test fails.
#include "engine/force_limiter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace palpate {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kTick_s = 1e-3;

// One limit at work, the others out of reach.
ForceLimiter with(double largest_N, double fastest_N_per_s, double ramp_s) {
  return ForceLimiter({largest_N, fastest_N_per_s, ramp_s});
}

TEST(ForceLimiter, PassesWhatIsWithinItsLimitsUnchanged) {
  ForceLimiter limiter = with(100.0, 1e9, 0.0);
  limiter.limit(0.0, kTick_s);
  for (const double force_N : {0.1, 3.0, 7.7, 0.3, -2.0}) {
    EXPECT_EQ(limiter.limit(force_N, kTick_s), force_N);
    EXPECT_EQ(limiter.flags(), 0u);
  }
}

TEST(ForceLimiter, NeverLetsANonNumberThrough) {
  for (const double bad : {kNaN, kInfinity, -kInfinity}) {
    ForceLimiter limiter = with(100.0, 1e9, 0.0);
    limiter.limit(0.0, kTick_s);
    limiter.limit(5.0, kTick_s);
    EXPECT_EQ(limiter.limit(bad, kTick_s), 0.0);
    EXPECT_EQ(limiter.flags(), force_limit::kNotFinite);
  }
}

TEST(ForceLimiter, ClampsBothWays) {
  ForceLimiter limiter = with(10.0, 1e9, 0.0);
  limiter.limit(0.0, kTick_s);
  EXPECT_EQ(limiter.limit(10.0, kTick_s), 10.0);
  EXPECT_EQ(limiter.flags(), 0u);
  EXPECT_EQ(limiter.limit(1e300, kTick_s), 10.0);
  EXPECT_EQ(limiter.flags(), force_limit::kClamped);
  EXPECT_EQ(limiter.limit(-11.0, kTick_s), -10.0);
  EXPECT_EQ(limiter.flags(), force_limit::kClamped);
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
  // A fault is no licence either.
  EXPECT_NEAR(limiter.limit(kNaN, kTick_s), 19.0, 1e-12);
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

// Share of a constant 4 N over time since the beginning, or since a fault.
void expect_ramp(ForceLimiter& limiter) {
  double last_N = -1.0;
  for (int i = 0; i < 100; ++i) {
    const double force_N = limiter.limit(4.0, kTick_s);
    EXPECT_NEAR(force_N, 4.0 * i / 100.0, 1e-9);
    EXPECT_EQ(limiter.flags(), force_limit::kRamping);
    EXPECT_GT(force_N, last_N);
    last_N = force_N;
  }
  limiter.limit(4.0, kTick_s);  // rounding may leave the last bit of the ramp to this one
  EXPECT_EQ(limiter.limit(4.0, kTick_s), 4.0);
  EXPECT_EQ(limiter.flags(), 0u);
}

TEST(ForceLimiter, RampsUpAtTheStartAndAfterEachFault) {
  ForceLimiter limiter = with(100.0, 1e9, 0.1);
  expect_ramp(limiter);
  limiter.limit(kNaN, kTick_s);
  expect_ramp(limiter);
  limiter.fault();
  expect_ramp(limiter);
}

}  // namespace
}  // namespace palpate
