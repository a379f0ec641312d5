#include "scenes/material/layered_block.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate {
namespace {

TEST(LayeredBlock, KnowsNothingOfTheInclusionAboveIt) {
  LayeredBlock block;
  for (int i = 1; i <= 590; ++i) block.step(1e-5 * i, 1e-2, 1e-3);
  EXPECT_EQ(block.inclusion_depth_m(), 0.0);
  for (int i = 0; i < 100000; ++i) block.step(5.9e-3, 0.0, 1e-3);
  EXPECT_NEAR(block.force_N(), LayeredBlock::kTop.force_N(5.9e-3), 1e-9);
}

// After a long hold it equals two springs in series: k_i (s - g - y)^1.5 = k_s y.
TEST(LayeredBlock, RelaxedIsAContactOnASpring) {
  LayeredBlock block;
  for (int i = 1; i <= 800; ++i) block.step(1e-5 * i, 1e-2, 1e-3);
  for (int i = 0; i < 100000; ++i) block.step(8e-3, 0.0, 1e-3);
  const double y_m = block.inclusion_depth_m();
  const double contact_N = LayeredBlock::kInclusion_N_per_m1_5 * std::pow(2e-3 - y_m, 1.5);
  EXPECT_GT(y_m, 1e-4);
  EXPECT_NEAR(contact_N, LayeredBlock::kSupport_N_per_m * y_m, 1e-9);
  EXPECT_NEAR(block.force_N(), LayeredBlock::kTop.force_N(8e-3) + contact_N, 1e-9);
}

}  // namespace
}  // namespace palpate
