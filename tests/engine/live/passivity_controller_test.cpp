#include "engine/live/force_guard.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/random_stream.h"

namespace palpate {
namespace {

constexpr double kTick_s = 1e-3;
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

}  // namespace
}  // namespace palpate
