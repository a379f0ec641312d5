#include "models/fit/residual_rows.h"

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

std::optional<ErrorBound> bound_of(const std::vector<Prediction>& predictions, std::size_t strokes = kManyStrokes) {
  ModelData common;
  common.largest_force_N = 5.0;
  return fit_bound(predictions, common, strokes);
}

TEST(FitBound, HoldsItsShareAndGrowsAwayFromTheData) {
  test::Numbers numbers(5);
  std::vector<Prediction> past;
  std::vector<std::pair<double, double>> future;  // error, force
  for (int i = 0; i < 8000; ++i) {
    const double force_N = between(numbers, 0.0, 5.0);
    // A triangular error that grows with the force.
    const double error_N =
        (0.01 + 0.02 * force_N) * std::abs(between(numbers, -1.0, 1.0) + between(numbers, -1.0, 1.0));
    if (i % 2 == 0) {
      past.push_back({error_N, force_N, 0.0});
    } else {
      future.emplace_back(error_N, force_N);
    }
  }
  const auto bound = bound_of(past);
  ASSERT_TRUE(bound.has_value());
  int held = 0;
  for (const auto& [error_N, force_N] : future) held += error_N <= bound->at(force_N, 0.0) ? 1 : 0;
  // The expected coverage is 97 % of 4000. The tolerance is three standard deviations of each half.
  EXPECT_NEAR(held / 4000.0, 0.97, 0.012);
  EXPECT_GE(bound->at(1.0, 1.0), bound->at(1.0, 0.0) + 1.25) << "a quarter of the largest force";
  EXPECT_FALSE(bound_of({}).has_value());
}

// The bound depends on the absolute force, so that a material that pulls has the same one.
TEST(FitBound, IsTheSameForPullingForces) {
  test::Numbers numbers(5);
  std::vector<Prediction> pushing, pulling;
  for (int i = 0; i < 1000; ++i) {
    const double force_N = between(numbers, 0.0, 5.0);
    const double error_N = 0.05 * force_N * between(numbers, 0.0, 1.0);
    pushing.push_back({error_N, force_N, 0.0});
    pulling.push_back({error_N, -force_N, 0.0});
  }
  const auto of_pushing = bound_of(pushing);
  const auto of_pulling = bound_of(pulling);
  ASSERT_TRUE(of_pushing && of_pulling);
  for (const double force_N : {0.0, 1.0, 5.0}) EXPECT_EQ(of_pulling->at(-force_N, 0.0), of_pushing->at(force_N, 0.0));
}

TEST(FitBound, TwoStrokesDoNotShowHowTheNextOneDiffers) {
  std::vector<Prediction> predictions;
  for (int i = 0; i < 100; ++i) predictions.push_back({0.01, 0.05 * i, 0.0});
  EXPECT_LT(bound_of(predictions, 3)->per_force, 0.01);
  EXPECT_EQ(bound_of(predictions, 2)->per_force, 0.05);
}

// Of 199 errors the 195th, ceil(200 x 0.975), is the bound; the least floor, 10 mN, may be added.
TEST(FitBound, IsTheQuantileOfTheErrors) {
  std::vector<Prediction> predictions;
  for (int i = 1; i <= 199; ++i) predictions.push_back({0.1 * i, 1.0, 0.0});
  EXPECT_NEAR(bound_of(predictions)->at(1.0, 0.0), 19.5, 0.011);
}

// Mean errors that are no line over the force: 20, 200 and 110 mN at 0, 2.5 and 5 N. Least squares with rows over the
// JND follow the small force.
TEST(FitBound, ErrorsCountInJnd) {
  const JndLine jnd;
  std::vector<Prediction> predictions;
  Eigen::Matrix2d gram = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (const auto& [force_N, error_N] : {std::pair{0.0, 0.02}, {2.5, 0.2}, {5.0, 0.11}}) {
    for (int i = 0; i < 50; ++i) predictions.push_back({error_N, force_N, 0.0});
    const Eigen::Vector2d row = Eigen::Vector2d(1.0, force_N) / jnd.at(force_N);
    gram += row * row.transpose();
    right += row * error_N / jnd.at(force_N);
  }
  const Eigen::Vector2d shape = gram.inverse() * right;
  const auto bound = bound_of(predictions);
  EXPECT_NEAR(bound->floor_N / bound->per_force, shape(0) / shape(1), 1e-6);
}

// Errors of 3 N for each unit of distance beyond the inner radius, 0.1.
TEST(FitBound, DistancesCountFromTheInnerRadius) {
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
  common.largest_force_N = 5.0;
  FoldErrors errors;
  const auto predictions = predictions_of(rows, common, {}, errors);
  EXPECT_EQ(errors.counts, (std::vector<double>{100.0, 100.0}));
  const auto bound = fit_bound(predictions, common, kManyStrokes);
  ASSERT_TRUE(bound.has_value());
  EXPECT_NEAR(bound->per_distance_N, 3.0, 0.1);
  EXPECT_LT(bound->at(2.0, 0.0), 0.05);
}

}  // namespace
}  // namespace palpate
