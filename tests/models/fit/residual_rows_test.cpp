#include "models/fit/residual_rows.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace palpate
