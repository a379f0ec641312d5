#include "models/fit/bound_estimator.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

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

// Of 199 errors the 195th, ceil(200 x 0.975), is the bound; the least floor, 10 mN, may be added.
TEST(BoundEstimator, IsTheQuantileOfTheErrors) {
  BoundEstimator estimator(JndLine{}, 5.0, kManyStrokes);
  for (int i = 1; i <= 199; ++i) estimator.add(0.1 * i, 1.0, 0.0);
  EXPECT_NEAR(estimator.fit()->at(1.0, 0.0), 19.5, 0.011);
}

// Mean errors that are no line over the force: 20, 200 and 110 mN at 0, 2.5 and 5 N. Least squares with rows over the
// JND follow the small force.
TEST(BoundEstimator, ErrorsCountInJnd) {
  const JndLine jnd;
  BoundEstimator estimator(jnd, 5.0, kManyStrokes);
  Eigen::Matrix2d gram = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (const auto& [force_N, error_N] : {std::pair{0.0, 0.02}, {2.5, 0.2}, {5.0, 0.11}}) {
    for (int i = 0; i < 50; ++i) estimator.add(error_N, force_N, 0.0);
    const Eigen::Vector2d row = Eigen::Vector2d(1.0, force_N) / jnd.at(force_N);
    gram += row * row.transpose();
    right += row * error_N / jnd.at(force_N);
  }
  const Eigen::Vector2d shape = gram.inverse() * right;
  EXPECT_NEAR(estimator.fit()->floor_N / estimator.fit()->per_force, shape(0) / shape(1), 1e-6);
}

// Errors of 3 N for each unit of distance beyond the inner radius, 0.1.
TEST(BoundEstimator, DistancesCountFromTheInnerRadius) {
  constexpr Eigen::Index kRows = 200;
  ResidualRows rows;
  rows.points = Eigen::MatrixXd::Zero(1, kRows);
  rows.force_N = Eigen::VectorXd::Constant(kRows, 2.0);
  rows.trend_N.resize(kRows, 2);
  for (Eigen::Index i = 0; i < kRows; ++i) {
    rows.fold.push_back(i < kRows / 2 ? 0 : 1);
    rows.distance.push_back(0.5 * static_cast<double>(i % 100) / 100.0);
    rows.trend_N.row(i).setConstant(2.0 - 3.0 * std::max(0.0, rows.distance.back() - 0.1));
  }
  ModelData common;
  common.cover = {{}, 0.1, 0.3};
  BoundEstimator estimator(common.jnd, 5.0, kManyStrokes);
  const FoldErrors errors = estimator.add(rows, common, {});
  EXPECT_EQ(errors.counts, (std::vector<double>{100.0, 100.0}));
  const auto bound = estimator.fit();
  ASSERT_TRUE(bound.has_value());
  EXPECT_NEAR(bound->per_distance_N, 3.0, 0.1);
  EXPECT_LT(bound->at(2.0, 0.0), 0.05);
}

}  // namespace
}  // namespace palpate
