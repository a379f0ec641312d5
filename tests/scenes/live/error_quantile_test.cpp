#include "scenes/live/error_quantile.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

TEST(ErrorQuantile, IsTheNinetyNinthPercentile) {
  ErrorQuantile errors;
  EXPECT_EQ(errors.p99(), 0.0);
  for (int i = 1; i <= 1000; ++i) errors.add(2e-3 * i);
  EXPECT_NEAR(errors.p99(), 1.98, 0.045 * 1.98);
}

// An error of exactly 1 JND counts as within, as in the share within the JND.
TEST(ErrorQuantile, IsExactBesideOneJnd) {
  ErrorQuantile errors;
  for (int i = 0; i < 99; ++i) errors.add(1.0);
  errors.add(1.0001);
  EXPECT_EQ(errors.p99(), 1.0);
  errors.add(1.0001);
  EXPECT_GT(errors.p99(), 1.0);
}

}  // namespace
}  // namespace palpate
