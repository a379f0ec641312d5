#include "engine/tick/lanes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace palpate {
namespace {

double by_lane(double x, std::size_t lane) {
  V4 lanes{-1.0, -2.0, 3.0, 0.5};
  lanes[lane] = x;
  to_exponential(lanes);
  return lanes[lane];
}

// The reference, std::exp, is itself accurate to 1 ulp.
TEST(Exponential, IsGoodToAnUlp) {
  const double ulp = std::numeric_limits<double>::epsilon();
  for (double x = -690.0; x < 690.0; x += 0.0371) ASSERT_NEAR(by_lane(x, 1) / std::exp(x), 1.0, 2 * ulp) << x;
  for (double x = 1e-9; x < 1.0; x *= 1.01) ASSERT_NEAR(by_lane(-x, 2) / std::exp(-x), 1.0, 2 * ulp) << x;
}

TEST(Exponential, OfNothingIsOneAndFarOutItStaysFinite) {
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    EXPECT_EQ(by_lane(0.0, lane), 1.0);
    EXPECT_EQ(by_lane(-0.0, lane), 1.0);
  }
  EXPECT_LT(by_lane(-1e9, 0), 1e-300);
  EXPECT_GT(by_lane(-1e9, 0), 0.0);
  EXPECT_LT(by_lane(-std::numeric_limits<double>::infinity(), 3), 1e-300);
  EXPECT_GT(by_lane(1e9, 0), 1e300);
  EXPECT_TRUE(std::isnan(by_lane(std::numeric_limits<double>::quiet_NaN(), 1)));
}

}  // namespace
}  // namespace palpate
