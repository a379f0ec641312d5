#include "scenes/material/softening_block.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

// Moves from `from_m` to `to_m`, holds, and returns the force at the end.
double go(Block& block, double from_m, double to_m, double seconds, double hold_s = 0.0) {
  const int steps = static_cast<int>(seconds * 1000.0);
  for (int i = 1; i <= steps; ++i) {
    block.step(from_m + (to_m - from_m) * i / steps, (to_m - from_m) / seconds, 1e-3);
  }
  for (int i = 0; i < static_cast<int>(hold_s * 1000.0); ++i) block.step(to_m, 0.0, 1e-3);
  return block.force_N();
}

TEST(SofteningBlock, FirstSlowPressIsTheElasticLaw) {
  SofteningBlock block;
  EXPECT_NEAR(go(block, 0.0, 6e-3, 1.0, 60.0), block.elastic_force_N(6e-3), 1e-6);
}

// Shortly after a deep press a smaller depth is softer, by at most about kSoftening. After
// 30 s in the air (five time constants of 6 s) it has healed.
TEST(SofteningBlock, IsSofterBelowItsDeepestPressAndHeals) {
  SofteningBlock fresh;
  const double first_N = go(fresh, 0.0, 4e-3, 0.2);
  SofteningBlock pressed;
  go(pressed, 0.0, 8e-3, 0.2);
  go(pressed, 8e-3, 0.0, 0.2);
  const double soon_N = go(pressed, 0.0, 4e-3, 0.2);
  EXPECT_LT(soon_N, 0.9 * first_N);
  EXPECT_GT(soon_N, (1.0 - SofteningBlock::kSoftening - 0.05) * first_N);
  go(pressed, 4e-3, 0.0, 0.2);
  // The deepest depth of 8 mm fades to 4 mm in 6 s x ln 2 = 4.2 s.
  SofteningBlock healing = pressed;
  for (int i = 0; i < 3000; ++i) healing.step(-1e-3, 0.0, 1e-3);
  EXPECT_LT(go(healing, 0.0, 4e-3, 0.2), 0.99 * first_N);
  for (int i = 0; i < 30000; ++i) pressed.step(-1e-3, 0.0, 1e-3);  // five times 6 s
  EXPECT_NEAR(go(pressed, 0.0, 4e-3, 0.2), first_N, 1e-3 * first_N);
}

// Healing during a hold returns energy, but no more than the softening dissipated before.
TEST(SofteningBlock, HealingMakesNoEnergy) {
  SofteningBlock block;
  double net_J = 0.0, last_m = 0.0, last_N = 0.0;
  const auto move = [&](double to_m, double speed_m_per_s) {
    const int steps = std::max(1, static_cast<int>(std::abs(to_m - last_m) / speed_m_per_s / 1e-4));
    const double from_m = last_m;
    for (int i = 1; i <= steps; ++i) {
      const double position_m = from_m + (to_m - from_m) * i / steps;
      const double force_N = block.step(position_m, (to_m - from_m) / (steps * 1e-4), 1e-4);
      net_J += 0.5 * (force_N + last_N) * (position_m - last_m);
      last_m = position_m;
      last_N = force_N;
    }
  };
  for (int repeat = 0; repeat < 10; ++repeat) {
    move(8e-3 - 2e-4 * repeat, 0.3);
    move(0.0, 0.3);
    move(7.9e-3 - 2e-4 * repeat, 0.3);                                       // in while it is soft,
    for (int i = 0; i < 20000; ++i) last_N = block.step(last_m, 0.0, 1e-3);  // heals,
    move(0.0, 0.01);                                                         // and out while it is not
    ASSERT_GT(net_J, 0.0) << repeat;
  }
}

}  // namespace
}  // namespace palpate
