#include "models/training/cross_validated_trend.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "models/training/fit_trend.h"

namespace palpate {
namespace {

constexpr int kFolds = 4;

// Strokes of a spring with a branch; the last stroke is the deepest.
TrendRows strokes() {
  TrendRows rows(TrendTerms{10e-3, 0.05, {0.1}, {}, {}});
  FeatureFilter branch({{FeatureKind::maxwell_branch, 0.1, {10e-3, {2.0, 0.0, 0.0, 0.0}}}});
  double t = 0.0;
  for (int stroke = 0; stroke < 8; ++stroke) {
    for (int i = 0; i < 400; ++i, t += 1e-3) {
      const double depth_m = (5e-3 + 0.5e-3 * stroke) * std::sin(3.14159265358979 * i / 400.0);
      const ToolSample sample{t, depth_m, 0.0, 0.0};
      const MotionEstimate motion{depth_m, 0.0};
      const double z = branch.update(sample, motion).values[0];
      const double noise = 0.01 * std::sin(12.9898 * i + 78.233 * stroke);
      rows.add(sample, motion, 100.0 * depth_m + z + noise, stroke % kFolds);
    }
  }
  return rows;
}

ColumnList all_columns(const TrendRows& rows) {
  ColumnList list(rows.columns());
  std::iota(list.begin(), list.end(), Eigen::Index{0});
  return list;
}

TEST(CrossValidatedTrend, EqualsFittingWithoutTheFold) {
  const TrendRows rows = strokes();
  const JndLine jnd;
  // No sample is one-sided, so that every row counts.
  const CrossValidatedTrend problem(rows, kFolds, Weighting::jnd, jnd, -1e3);
  const CrossValidation result = problem.left_out(all_columns(rows));
  const auto n = static_cast<Eigen::Index>(rows.columns());
  for (int fold = 0; fold < kFolds; ++fold) {
    Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
    double elsewhere_m = 0.0;
    for (std::size_t i = 0; i < rows.count(); ++i) {
      if (rows.stroke(i) == fold) continue;
      const Eigen::Map<const Eigen::VectorXd> row(rows.row(i), n);
      const double scale = 1.0 / jnd.at(rows.force_N(i));
      gram += scale * scale * row * row.transpose();
      right += scale * scale * rows.force_N(i) * row;
      elsewhere_m = std::max(elsewhere_m, rows.depth_m(i));
    }
    const Eigen::VectorXd x = solve_non_negative(gram, right);
    double squares = 0.0;
    double count = 0.0;
    for (std::size_t i = 0; i < rows.count(); ++i) {
      if (rows.stroke(i) != fold || rows.depth_m(i) > elsewhere_m) continue;
      const double trend_N = Eigen::Map<const Eigen::VectorXd>(rows.row(i), n).dot(x);
      squares += std::pow(jnd.error_over_jnd(trend_N, rows.force_N(i)), 2);
      count += 1.0;
    }
    const auto k = static_cast<std::size_t>(fold);
    EXPECT_EQ(result.fold_count[k], count);
    // The rows' robust scale takes some 1e-2 of the largest errors.
    EXPECT_NEAR(result.fold_error[k], squares / count, 0.05 * squares / count) << fold;
  }
}

TEST(CrossValidatedTrend, AWarmStartGivesTheSame) {
  const TrendRows rows = strokes();
  const CrossValidatedTrend problem(rows, kFolds, Weighting::jnd, JndLine{}, 0.0);
  ColumnList elastic(kElasticCoefficients);
  std::iota(elastic.begin(), elastic.end(), Eigen::Index{0});
  const CrossValidation few = problem.left_out(elastic);
  const CrossValidation cold = problem.left_out(all_columns(rows));
  const CrossValidation warm = problem.left_out(all_columns(rows), &few);
  EXPECT_NEAR(warm.mean(), cold.mean(), 1e-6 * cold.mean());
  EXPECT_LT(cold.mean(), few.mean()) << "the branch is worth something";
  EXPECT_GT(few.standard_error_against(cold), 0.0);
  EXPECT_EQ(cold.standard_error_against(cold), 0.0);
}

}  // namespace
}  // namespace palpate
