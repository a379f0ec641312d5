#include "scenes/material/tissue_block.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate {
namespace {

double relaxation(double t) {
  return 1.0 - TissueBlock::kFractionalShare + TissueBlock::kFractionalShare * std::pow(t, -TissueBlock::kExponent);
}

// Tested at times a factor of ten or more inside the ends of the spectrum, 0.1 ms and 1,000 s.
TEST(TissueBlock, StepRelaxesAsThePowerLaw) {
  TissueBlock block;
  const double depth_m = 0.006, elastic_N = TissueBlock::kContact.force_N(depth_m);
  block.step(depth_m, 0.0, 1e-9);
  for (int tick = 1; tick <= 30000; ++tick) {
    block.step(depth_m, 0.0, 1e-3);
    if (tick == 1 || tick == 10 || tick == 100 || tick == 1000 || tick == 10000 || tick == 30000) {
      EXPECT_NEAR(block.force_N() / elastic_N / relaxation(tick * 1e-3), 1.0, 2e-3) << tick;
    }
  }
}

TEST(TissueBlock, SlowPressKeepsTheElasticForce) {
  TissueBlock block;
  for (int i = 1; i <= 3000; ++i) block.step(2e-6 * i, 2e-9, 1000.0);
  // The parts slower than the spectrum: the integral of the power law's density beyond its longest time.
  const double alpha = TissueBlock::kExponent,
               slow = std::pow(TissueBlock::kLongest_s, -alpha) / std::tgamma(alpha + 1);
  const double held = 1.0 - TissueBlock::kFractionalShare + TissueBlock::kFractionalShare * slow;
  EXPECT_NEAR(block.force_N() / (held * TissueBlock::kContact.force_N(6e-3)), 1.0, 1e-3);
}

}  // namespace
}  // namespace palpate
