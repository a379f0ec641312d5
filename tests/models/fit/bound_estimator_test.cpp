#include "models/fit/residual_rows.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "tests/support/random_points.h"

namespace palpate {
namespace {

double between(test::Numbers& numbers, double low, double high) {
  return low + 0.5 * (high - low) * (numbers.next() + 1.0);
}

std::optional<ErrorBound> bound_of(const std::vector<Prediction>& predictions) {
  ModelData common;
  common.largest_force_N = 5.0;
  return fit_bound(predictions, common);
}

// `units` of 50 rows with the error 0.1 N times their number, from 1 on, at a force of 1 N.
std::vector<Prediction> of_units(int units) {
  std::vector<Prediction> predictions;
  for (int i = 0; i < 50 * units; ++i) predictions.push_back({0.1 * (i / 50 + 1), 1.0, 0.0, i / 50});
  return predictions;
}

// Units whose errors differ in scale, as those of recordings do.
TEST(FitBound, CoversNewUnitsAndGrowsAwayFromTheData) {
  test::Numbers numbers(5);
  std::vector<Prediction> past, future;
  for (int unit = 0; unit < 80; ++unit) {
    const double scale = std::exp(between(numbers, -1.0, 1.0));
    for (int i = 0; i < 100; ++i) {
      const double force_N = between(numbers, 0.0, 5.0);
      // A triangular error that grows with the force.
      const double error_N =
          scale * (0.01 + 0.02 * force_N) * std::abs(between(numbers, -1.0, 1.0) + between(numbers, -1.0, 1.0));
      (unit % 2 == 0 ? past : future).push_back({error_N, force_N, 0.0, unit});
    }
  }
  const auto bound = bound_of(past);
  ASSERT_TRUE(bound.has_value());
  int covered = 0;
  for (std::size_t unit = 0; unit < 40; ++unit) {
    const auto first = future.begin() + static_cast<std::ptrdiff_t>(100 * unit);
    const auto within = [&](const Prediction& one) { return one.error_N <= bound->at(one.predicted_N, 0.0); };
    covered += std::count_if(first, first + 100, within) >= 95 ? 1 : 0;
  }
  // Nine of ten are expected; the tolerance is three standard deviations.
  EXPECT_GE(covered, 36 - 6);
  EXPECT_GE(bound->at(1.0, 1.0), bound->at(1.0, 0.0) + 1.25) << "a quarter of the largest force";
}

// The bound depends on the absolute force, so that a material that pulls has the same one.
TEST(FitBound, IsTheSameForPullingForces) {
  test::Numbers numbers(5);
  std::vector<Prediction> pushing, pulling;
  for (int i = 0; i < 1000; ++i) {
    const double force_N = between(numbers, 0.0, 5.0);
    const double error_N = 0.05 * force_N * between(numbers, 0.0, 1.0);
    pushing.push_back({error_N, force_N, 0.0, i / 100});
    pulling.push_back({error_N, -force_N, 0.0, i / 100});
  }
  const auto of_pushing = bound_of(pushing);
  const auto of_pulling = bound_of(pulling);
  ASSERT_TRUE(of_pushing && of_pulling);
  for (const double force_N : {0.0, 1.0, 5.0}) EXPECT_EQ(of_pulling->at(-force_N, 0.0), of_pushing->at(force_N, 0.0));
}

// One row of 50, too few for the 95 % quantile of all, has an error of 1 N: in no phase, or first, or deep, or fast.
TEST(FitBound, HoldsInEveryPhase) {
  struct Phase {
    std::size_t row;
    double depth_m, speed_m_per_s, bound_N;
  };
  for (const Phase& phase : {Phase{25, 0.0, 0.0, 0.1}, {0, 0.0, 0.0, 1.0}, {25, 1e-3, 0.0, 1.0}, {25, 0.0, 0.1, 1.0}}) {
    std::vector<Prediction> predictions = of_units(2);
    for (Prediction& one : predictions) one.error_N = 0.1;
    for (std::size_t unit = 0; unit < 2; ++unit)
      predictions[50 * unit + phase.row] = {1.0, 1.0, 0.0, static_cast<int>(unit), phase.depth_m, phase.speed_m_per_s};
    EXPECT_NEAR(bound_of(predictions)->at(1.0, 0.0), phase.bound_N, 0.011) << phase.depth_m << phase.speed_m_per_s;
  }
}

// Errors of 3 N for each unit of distance beyond the inner radius, 0.1; a recording that as recorded reads 0.2 N more,
// with an uncertainty of 0.1 N.
TEST(FitBound, DistancesCountFromTheInnerRadiusAndForcesAsRecorded) {
  constexpr Eigen::Index kRows = 200;
  ResidualRows rows;
  rows.points = Eigen::MatrixXd::Zero(1, kRows);
  rows.force_N = Eigen::VectorXd::Constant(kRows, 2.0);
  rows.depth_m = rows.speed_m_per_s = rows.moved_N = rows.moved_error_N = Eigen::VectorXd::Zero(kRows);
  rows.trend_N.resize(kRows, 2);
  for (Eigen::Index i = 0; i < kRows; ++i) {
    rows.fold.push_back(i < kRows / 2 ? 0 : 1);
    rows.unit.push_back(rows.fold.back());
    rows.distance.push_back(0.5 * static_cast<double>(i % 100) / 100.0);
    rows.trend_N.row(i).setConstant(2.0 - 3.0 * std::max(0.0, rows.distance.back() - 0.1));
  }
  ModelData common;
  common.cover = {{}, 0.1, 0.3};
  common.largest_force_N = 5.0;
  const auto bound = fit_bound(predictions_of(rows, common, {}), common);
  ASSERT_TRUE(bound.has_value());
  EXPECT_NEAR(bound->per_distance_N, 3.0, 0.1);
  EXPECT_LT(bound->at(2.0, 0.0), 0.05);
  rows.moved_N.tail(kRows / 2).setConstant(-0.2);
  rows.moved_error_N.tail(kRows / 2).setConstant(0.1);
  EXPECT_NEAR(predictions_of(rows, common, {}).back().error_N - predictions_of(rows, common, {})[99].error_N, 0.3,
              1e-12);
}

}  // namespace
}  // namespace palpate
