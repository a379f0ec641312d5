#include "scenes/material/rig.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

constexpr double kStep_s = 5e-5;

Material silicone() { return find_material("silicone").value(); }

void advance(Hand& hand, Block& block) {
  hand.move(kStep_s);
  hand.feel(block.step(hand.position_m(), hand.velocity_m_per_s(), kStep_s), kStep_s);
}

// Without a force the hand is linear. So the difference between hands with and without
// tremor is the tremor after the dynamics of the hand.
TEST(Hand, TremblesAtEightToTwelveHertz) {
  HandSettings calm;
  calm.tremor_rms_m = 0.0;
  Hand trembling(silicone(), {}, 3), steady(silicone(), calm, 3);
  double squares = 0.0, last = 0.0;
  int crossings = 0;
  constexpr int kSteps = 400000;  // 20 s
  for (int i = 0; i < kSteps; ++i) {
    for (Hand* hand : {&trembling, &steady}) {
      hand->move(kStep_s);
      hand->feel(0.0, kStep_s);
    }
    const double tremor = trembling.position_m() - steady.position_m();
    squares += tremor * tremor;
    crossings += tremor * last < 0.0;
    last = tremor;
  }
  const double frequency_Hz = crossings / 2.0 / (kSteps * kStep_s);
  EXPECT_GT(frequency_Hz, 8.0);
  EXPECT_LT(frequency_Hz, 12.0);
  // The spring and damper of the hand have a gain of 1 to 1.4 at 8 to 12 Hz.
  const double rms_m = std::sqrt(squares / kSteps);
  EXPECT_GT(rms_m, 0.9 * HandSettings{}.tremor_rms_m);
  EXPECT_LT(rms_m, 1.5 * HandSettings{}.tremor_rms_m);
}

TEST(Hand, VelocityAndAccelerationAreTheDerivativesOfPosition) {
  Hand hand(silicone(), {}, 2);
  const auto owned = silicone().make_block();
  Block& block = *owned;
  block.reset(hand.position_m());
  int jumps = 0;
  double x0 = 0.0, x1 = 0.0, v0 = 0.0, v1 = 0.0, a1 = 0.0;
  for (int i = 0; i < 200000; ++i) {
    advance(hand, block);
    if (i > 2) {
      // Central differences. When the tool meets a surface that still lags by s, the
      // damper makes the acceleration jump by c s v / m, about 2 m/s^2. The error of a
      // difference across the jump is half of it, and that of the velocity half of it
      // times the step.
      ASSERT_NEAR(v1, (hand.position_m() - x0) / (2.0 * kStep_s), 1e-4) << i;
      const double difference = (hand.velocity_m_per_s() - v0) / (2.0 * kStep_s);
      ASSERT_NEAR(a1, difference, 2.0) << i;
      jumps += std::abs(a1 - difference) > 0.05;
    }
    x0 = x1;
    v0 = v1;
    x1 = hand.position_m();
    v1 = hand.velocity_m_per_s();
    a1 = hand.acceleration_m_per_s2();
  }
  EXPECT_LT(jumps, 100);
}

TEST(Hand, HalvingTheStepHardlyChangesTheMotion) {
  Hand coarse(silicone(), {}, 4), fine(silicone(), {}, 4);
  const auto coarse_owned = silicone().make_block(), fine_owned = silicone().make_block();
  Block &coarse_block = *coarse_owned, &fine_block = *fine_owned;
  coarse_block.reset(coarse.position_m());
  fine_block.reset(fine.position_m());
  double worst_m = 0.0;
  for (int i = 0; i < 200000; ++i) {
    advance(coarse, coarse_block);
    for (int half = 0; half < 2; ++half) {
      fine.move(0.5 * kStep_s);
      fine.feel(fine_block.step(fine.position_m(), fine.velocity_m_per_s(), 0.5 * kStep_s), 0.5 * kStep_s);
    }
    worst_m = std::max(worst_m, std::abs(coarse.position_m() - fine.position_m()));
  }
  // The tolerance is a tenth of an encoder step.
  EXPECT_LT(worst_m, 3e-6);
}

}  // namespace
}  // namespace palpate
