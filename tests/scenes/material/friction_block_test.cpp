#include "scenes/material/friction_block.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace palpate {
namespace {

// Moves at 0.1 mm/s, slowly enough for the spectrum to relax.
void slide(Block& block, double& at_m, double to_m, std::vector<double>* forces_N = nullptr) {
  const int steps = static_cast<int>(std::lround(std::abs(to_m - at_m) / 1e-6));
  const double from_m = at_m;
  for (int i = 1; i <= steps; ++i) {
    at_m = from_m + (to_m - from_m) * i / steps;
    const double force_N = block.step(at_m, 0.0, 1e-2);
    if (forces_N != nullptr) forces_N->push_back(force_N);
  }
}

// Full friction in both directions, less the presliding at each end: with Dahl's
// law from -1 to +1 over a distance l, each corner of the loop reduces the area by
// 2 F_c x_p (1 - exp(-l / x_p)).
TEST(FrictionBlock, LoopAreaIsTwiceFrictionTimesTheWay) {
  FrictionBlock block;
  double at_m = 0.0;
  slide(block, at_m, 8e-3);
  slide(block, at_m, 6e-3);
  double area_J = 0.0;
  std::vector<double> forces_N;
  slide(block, at_m, 8e-3, &forces_N);
  for (const double force_N : forces_N) area_J += force_N * 1e-6;
  forces_N.clear();
  slide(block, at_m, 6e-3, &forces_N);
  for (const double force_N : forces_N) area_J -= force_N * 1e-6;
  const double fc = FrictionBlock::kFriction_N, xp = FrictionBlock::kPresliding_m;
  const double expected_J = 2.0 * fc * 2e-3 - 2.0 * 2.0 * fc * xp;
  // The spectrum of 50 ms to 2 s dissipates a little at 0.1 mm/s, and the sum of
  // rectangles includes one step too many.
  EXPECT_NEAR(area_J / expected_J, 1.0, 0.03);
}

TEST(FrictionBlock, ReversalFollowsDahlsLaw) {
  FrictionBlock block;
  double at_m = 0.0;
  slide(block, at_m, 6e-3);
  for (int i = 0; i < 60000; ++i) block.step(at_m, 0.0, 1e-3);
  const double before_N = block.force_N();
  EXPECT_NEAR(before_N, FrictionBlock::kContact.force_N(6e-3) + FrictionBlock::kFriction_N, 1e-6)
      << "dry friction does not relax";
  for (const double back_m : {2e-5, 1e-4, 3e-4}) {
    slide(block, at_m, 6e-3 - back_m);
    for (int i = 0; i < 60000; ++i) block.step(at_m, 0.0, 1e-3);
    const double expected_N =
        FrictionBlock::kContact.force_N(at_m) + FrictionBlock::kFriction_N * (2.0 * std::exp(-back_m / 1e-4) - 1.0);
    EXPECT_NEAR(block.force_N(), expected_N, 1e-5) << back_m;
  }
}

TEST(FrictionBlock, FrictionGrowsWithTheDepthGripped) {
  EXPECT_EQ(FrictionBlock::friction_limit_N(0.0), 0.0);
  EXPECT_DOUBLE_EQ(FrictionBlock::friction_limit_N(2e-3), 0.5 * FrictionBlock::kFriction_N);
  EXPECT_EQ(FrictionBlock::friction_limit_N(9e-3), FrictionBlock::kFriction_N);
}

}  // namespace
}  // namespace palpate
