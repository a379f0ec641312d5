#include "scenes/material/rig.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate {
namespace {

constexpr double kStep_s = 5e-5;

Material silicone() { return find_material("silicone").value(); }

void advance(Hand& hand, Block& block) {
  hand.move(kStep_s);
  hand.feel(block.step(hand.position_m(), hand.velocity_m_per_s(), kStep_s), kStep_s);
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

}  // namespace
}  // namespace palpate
