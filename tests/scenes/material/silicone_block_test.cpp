#include "scenes/material/silicone_block.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate {
namespace {

double kernel(double t) {
  return SiliconeBlock::kWeight *
         (std::expint(-t / SiliconeBlock::kShortest_s) - std::expint(-t / SiliconeBlock::kLongest_s));
}

TEST(SiliconeBlock, StepRelaxesAsFungsBoxSpectrum) {
  SiliconeBlock block;
  const double depth_m = 0.006, elastic_N = SiliconeBlock::kContact.force_N(depth_m);
  block.step(depth_m, 0.0, 1e-9);
  EXPECT_NEAR(block.force_N() / elastic_N, 1.0 + SiliconeBlock::kWeight * std::log(3e4), 1e-5);
  for (int tick = 1; tick <= 10000; ++tick) {
    block.step(depth_m, 0.0, 1e-3);
    // The tolerance, a thousandth of the spectrum's weight, is for the midpoint rule.
    if (tick == 10 || tick == 100 || tick == 1000 || tick == 10000) {
      EXPECT_NEAR(block.force_N() / elastic_N, 1.0 + kernel(tick * 1e-3), 1e-4) << tick;
    }
  }
}

TEST(SiliconeBlock, SlowPressIsTheElasticLaw) {
  SiliconeBlock block;
  // 6 mm in 83 hours: the share that has not relaxed is the integral of K, 2 s, over that time.
  for (int i = 1; i <= 3000; ++i) block.step(2e-6 * i, 2e-8, 100.0);
  EXPECT_NEAR(block.force_N() / SiliconeBlock::kContact.force_N(6e-3), 1.0, 1e-3);
}

}  // namespace
}  // namespace palpate
