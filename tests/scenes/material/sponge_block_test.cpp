#include "scenes/material/sponge_block.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate {
namespace {

constexpr double kArea_m2 = 3.14159265358979324 * SpongeBlock::kRadius_m * SpongeBlock::kRadius_m;

TEST(SpongeBlock, SlowPressIsTheSkeleton) {
  SpongeBlock block;
  for (int i = 1; i <= 1000; ++i) block.step(1e-5 * i, 1e-6, 10.0);
  const double strain = 1e-2 / SpongeBlock::kHeight_m;
  const double skeleton_N =
      kArea_m2 * SpongeBlock::kSkeleton_Pa * strain / (1.0 - strain / SpongeBlock::kClosed_strain);
  EXPECT_NEAR(block.force_N() / skeleton_N, 1.0, 2e-3) << "what a diffusion of a second leaves in 10,000";
}

// The mean pressure of a disc that drains at its rim, from a uniform pressure p0:
// p0 sum 4 / j_n^2 exp(-j_n^2 D t / a^2), with j_n the zeros of J0.
double drained_share(double t, double diffusivity_m2_per_s) {
  double sum = 0.0;
  for (int n = 1; n <= 200; ++n) {
    // McMahon's expansion, accurate to 1e-4 from the first zero on.
    const double b = (n - 0.25) * 3.14159265358979324;
    const double j = b + 1.0 / (8.0 * b) - 124.0 / (3.0 * std::pow(8.0 * b, 3));
    sum +=
        4.0 / (j * j) * std::exp(-j * j * diffusivity_m2_per_s * t / (SpongeBlock::kRadius_m * SpongeBlock::kRadius_m));
  }
  return sum;
}

TEST(SpongeBlock, StepDrainsAsTheBesselSeriesSlowerWhenDeep) {
  for (const double depth_m : {1e-3, 1e-2}) {
    SpongeBlock block;
    block.step(depth_m, 0.0, 1e-9);
    const double at_once_N = block.force_N() - block.relaxed_force_N(depth_m);
    const double strain = depth_m / SpongeBlock::kHeight_m;
    EXPECT_NEAR(at_once_N, kArea_m2 * SpongeBlock::kPore_Pa * strain, 1e-3 * at_once_N);
    const double diffusivity = SpongeBlock::kDiffusivity_m2_per_s * std::exp(-SpongeBlock::kPermeabilityFall * strain);
    for (int tick = 1; tick <= 1000; ++tick) {
      block.step(depth_m, 0.0, 1e-3);
      // Twelve rings are too coarse until the front is wider than one ring; then the error is 1 %.
      if (diffusivity * tick * 1e-3 < 0.015 * SpongeBlock::kRadius_m * SpongeBlock::kRadius_m) continue;
      ASSERT_NEAR((block.force_N() - block.relaxed_force_N(depth_m)) / at_once_N,
                  drained_share(tick * 1e-3, diffusivity), 0.01)
          << tick;
    }
  }
}

}  // namespace
}  // namespace palpate
