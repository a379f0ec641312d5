#include "models/fit/residual_rows.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/random_points.h"

namespace palpate {
namespace {

// Four rows on a line, in two folds whose trends differ.
ResidualRows four_rows() {
  ResidualRows rows;
  rows.points = Eigen::RowVector4d(0.0, 1.0, 1.25, 4.0);
  rows.force_N = Eigen::Vector4d(1.0, 0.0, 3.0, 4.0);
  rows.depth_m = Eigen::Vector4d::Constant(1e-3);
  rows.row_scale = Eigen::Vector4d(1.0, 2.0, 3.0, 4.0);
  rows.trend_N.resize(4, 2);
  rows.trend_N.col(0) << 0.5, -0.5, 2.0, 3.5;
  rows.trend_N.col(1) << 0.75, -0.25, 3.5, 4.25;
  rows.fold = {0, 0, 1, 1};
  rows.no_force = {0, 1, 0, 0};
  rows.find_distances();
  return rows;
}

// The second row has no force: a trend below 0 needs no correction there.
TEST(ResidualRows, SitesHaveTheResidualsOfTheTrendWithoutTheFold) {
  const Sites first = four_rows().sites_without(0, 0.1);
  EXPECT_EQ(first.target_N, Eigen::Vector2d(1.0, 0.5));
  EXPECT_EQ(first.row_scale, Eigen::Vector2d(3.0, 4.0));
  EXPECT_EQ(first.points, Eigen::RowVector2d(1.25, 4.0));
  EXPECT_EQ(first.smoothing, 0.1);
  const Sites second = four_rows().sites_without(1, 0.1);
  EXPECT_EQ(second.target_N, Eigen::Vector2d(0.25, 0.0));
  EXPECT_EQ(second.points, Eigen::RowVector2d(0.0, 1.0));
}

TEST(ResidualRows, ThePredictionIsThatOfTheOtherFolds) {
  const ResidualRows rows = four_rows();
  EXPECT_EQ(rows.distance, (std::vector<double>{1.25, 0.25, 0.25, 3.0}));
  ModelData common;
  common.correction_limit_N = 0.4;
  common.cover = {{}, 0.5, 1.0};
  EXPECT_DOUBLE_EQ(rows.predicted_N(common, 2, 0.5, 0.3), 3.8) << "within the inner radius";
  EXPECT_DOUBLE_EQ(rows.predicted_N(common, 2, 0.5, 0.9), 3.9) << "the correction is limited";
  EXPECT_DOUBLE_EQ(rows.predicted_N(common, 0, 0.5, 0.3), 0.5) << "beyond the outer radius only the trend counts";
  EXPECT_DOUBLE_EQ(rows.predicted_N(common, 1, 0.5, 0.3), 0.0) << "no force below the lowest";
}

double between(test::Numbers& numbers, double low, double high) {
  return low + 0.5 * (high - low) * (numbers.next() + 1.0);
}

constexpr int kFolds = 5;

// `shared`: size of the residual common to all strokes. `own`: size of the residual that differs
// between strokes. `first`: additional share of the rows in the first stroke.
ResidualRows make_rows(double shared, double own, double first = 0.0) {
  test::Numbers numbers(3);
  constexpr Eigen::Index kRows = 1000;
  ResidualRows rows;
  rows.points.resize(2, kRows);
  rows.force_N.resize(kRows);
  rows.depth_m = Eigen::VectorXd::Constant(kRows, 1e-3);
  rows.row_scale = Eigen::VectorXd::Constant(kRows, 1.0 / 0.1);
  rows.trend_N = Eigen::MatrixXd::Constant(kRows, kFolds, 2.0);
  rows.no_force.assign(kRows, 0);
  for (Eigen::Index i = 0; i < kRows; ++i) {
    const double along = (static_cast<double>(i) / kRows - first) / (1.0 - first);
    const int fold = along > 0.0 ? static_cast<int>(along * kFolds) : 0;
    for (Eigen::Index k = 0; k < 2; ++k) rows.points(k, i) = between(numbers, -1.0, 1.0);
    rows.force_N(i) =
        2.0 + shared * std::sin(3.0 * rows.points(0, i)) + own * std::cos(2.0 * fold) + between(numbers, -0.005, 0.005);
    rows.fold.push_back(fold);
  }
  rows.find_distances();
  return rows;
}

CorrectionChoice choose(const ResidualRows& rows) {
  ModelData common;
  common.correction_limit_N = 1.0;
  common.cover = {{}, 0.1, 0.3};
  return choose_correction(rows, common);
}

TEST(CorrectionChoice, WhatEveryStrokeHasIsCorrected) {
  const CorrectionChoice choice = choose(make_rows(0.3, 0.0));
  EXPECT_TRUE(choice.used);
  // The remaining error is the noise of 5 mN (with a JND of 190 mN) and the smoothing bias.
  EXPECT_LT(choice.error_over_jnd, 0.1 * choice.trend_error_over_jnd);
}

// The first stroke has nine tenths of the squared error, but every stroke has the same weight.
TEST(CorrectionChoice, AStrokeWithMostOfTheErrorHasOneVoteOfAll) { EXPECT_TRUE(choose(make_rows(0.3, 0.0, 0.8)).used); }

TEST(CorrectionChoice, WhatOnlyOneStrokeHasIsNot) {
  const CorrectionChoice choice = choose(make_rows(0.0, 0.3));
  EXPECT_FALSE(choice.used);
  EXPECT_EQ(choice.error_over_jnd, choice.trend_error_over_jnd);
}

// Every row has close rows of other strokes, so a larger reach than 0.1 has no significant
// gain in cross-validation.
TEST(CorrectionChoice, ReachesNoFartherThanStrokesLeftOutReward) {
  const CorrectionChoice choice = choose(make_rows(0.3, 0.1));
  EXPECT_TRUE(choice.used);
  EXPECT_EQ(choice.inner_radius, 0.1);
}

TEST(CorrectionChoice, NeverWorseThanNoneOnWhatIsLeftOut) {
  for (const double own : {0.05, 0.1, 0.2}) {
    const CorrectionChoice choice = choose(make_rows(0.1, own));
    EXPECT_LE(choice.error_over_jnd, choice.trend_error_over_jnd) << own;
  }
}

TEST(CorrectionChoice, NothingToLeaveOutMeansNone) { EXPECT_FALSE(choose({}).used); }

}  // namespace
}  // namespace palpate
