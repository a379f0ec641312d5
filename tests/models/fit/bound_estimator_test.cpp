#include "models/fit/residual_rows.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/random_points.h"

namespace palpate {
namespace {

double between(test::Numbers& numbers, double low, double high) {
  return low + 0.5 * (high - low) * (numbers.next() + 1.0);
}

constexpr std::size_t kManyStrokes = 10;

TEST(BoundEstimator, HoldsItsShareAndGrowsAwayFromTheData) {
  test::Numbers numbers(5);
  BoundEstimator past(JndLine{}, 5.0, kManyStrokes);
  std::vector<std::pair<double, double>> future;  // error, force
  for (int i = 0; i < 8000; ++i) {
    const double force_N = between(numbers, 0.0, 5.0);
    // A triangular error that grows with the force.
    const double error_N =
        (0.01 + 0.02 * force_N) * std::abs(between(numbers, -1.0, 1.0) + between(numbers, -1.0, 1.0));
    if (i % 2 == 0) {
      past.add(error_N, force_N, 0.0);
    } else {
      future.emplace_back(error_N, force_N);
    }
  }
  const auto bound = past.fit();
  ASSERT_TRUE(bound.has_value());
  int held = 0;
  for (const auto& [error_N, force_N] : future) held += error_N <= bound->at(force_N, 0.0) ? 1 : 0;
  // The expected coverage is 97 % of 4000. The tolerance is three standard deviations of each half.
  EXPECT_NEAR(held / 4000.0, 0.97, 0.012);
  EXPECT_GE(bound->at(1.0, 1.0), bound->at(1.0, 0.0) + 1.25) << "a quarter of the largest force";
  EXPECT_FALSE(BoundEstimator(JndLine{}, 5.0, kManyStrokes).fit().has_value());
}

// The bound depends on the absolute force, so that a material that pulls has the same one.
TEST(BoundEstimator, IsTheSameForPullingForces) {
  test::Numbers numbers(5);
  BoundEstimator pushing(JndLine{}, 5.0, kManyStrokes);
  BoundEstimator pulling = pushing;
  for (int i = 0; i < 1000; ++i) {
    const double force_N = between(numbers, 0.0, 5.0);
    const double error_N = 0.05 * force_N * between(numbers, 0.0, 1.0);
    pushing.add(error_N, force_N, 0.0);
    pulling.add(error_N, -force_N, 0.0);
  }
  const auto of_pushing = pushing.fit();
  const auto of_pulling = pulling.fit();
  ASSERT_TRUE(of_pushing && of_pulling);
  for (const double force_N : {0.0, 1.0, 5.0}) EXPECT_EQ(of_pulling->at(-force_N, 0.0), of_pushing->at(force_N, 0.0));
}

TEST(BoundEstimator, TwoStrokesDoNotShowHowTheNextOneDiffers) {
  BoundEstimator many(JndLine{}, 5.0, 3);
  BoundEstimator few(JndLine{}, 5.0, 2);
  for (int i = 0; i < 100; ++i) {
    many.add(0.01, 0.05 * i, 0.0);
    few.add(0.01, 0.05 * i, 0.0);
  }
  EXPECT_LT(many.fit()->per_force, 0.01);
  EXPECT_EQ(few.fit()->per_force, 0.05);
}

}  // namespace
}  // namespace palpate
