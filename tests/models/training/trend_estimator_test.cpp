#include "models/trend/trend_estimator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "tests/support/feature_specs.h"
#include "tests/support/random_points.h"

namespace palpate {
namespace {

constexpr double kDepth_m = 5e-3;
constexpr int kFolds = 5;

// Strokes of growing depth and speed, a second each, measured at 500 Hz.
template <typename Force>
TrendRows rows_of(const FeatureList& list, double force_noise_floor_N, Force force_N) {
  TrendRows rows(list, {.reference_depth_m = kDepth_m,
                        .rms_velocity_m_per_s = 0.02,
                        .force_noise_floor_N = force_noise_floor_N,
                        .folds = kFolds});
  for (int i = 0; i < 10000; ++i) {
    const double t = 2e-3 * i;
    const int stroke = i / 500;
    const double angle = 2.0 * std::numbers::pi * (1.0 + stroke % 3) * t;
    const double amplitude_m = kDepth_m * (0.5 + 0.025 * stroke);
    const double position_m = amplitude_m * std::sin(angle);
    const ToolSample sample{t, position_m, 0.0, 0.0};
    const MotionEstimate motion{position_m,
                                amplitude_m * std::cos(angle) * 2.0 * std::numbers::pi * (1.0 + stroke % 3)};
    rows.add({{sample, motion, force_N(sample, motion)}, 0, stroke, stroke % kFolds, i == 0});
  }
  return rows;
}

double rms_of(const TrendRows& rows, const Eigen::VectorXd& x) {
  double sum = 0.0;
  for (std::size_t i = 0; i < rows.count(); ++i) {
    const double error_N = rows.terms().row(static_cast<Eigen::Index>(i)).dot(x) - rows[i].force_N;
    sum += error_N * error_N;
  }
  return std::sqrt(sum / static_cast<double>(rows.count()));
}

TEST(TrendEstimator, FindsWhatIsInTheDictionaryAndMakesNothingNegative) {
  FeatureFilter branch({test::spectrum({0.1}, {kDepth_m, {1.5, 0.5, 0.0, 0.0}})});
  FeatureList list;
  list.add(FeatureKind::velocity);
  list.add(FeatureKind::maxwell_spectrum, {0.01, 0.1, 1.0});
  const TrendRows rows = rows_of(list, -std::numeric_limits<double>::infinity(),
                                 [&](const ToolSample& sample, const MotionEstimate& motion) {
                                   const double u = std::max(0.0, motion.position_m) / kDepth_m;
                                   return 2.0 * u + u * u + branch.update(sample, motion).values[0];
                                 });
  const TrendEstimator estimator(rows);
  const Eigen::VectorXd x = estimator.fit(estimator.all_columns());
  EXPECT_GE(x.minCoeff(), 0.0);
  // With forces of up to 4.5 N. The error is a bias of the penalty.
  EXPECT_LT(rms_of(rows, x), 0.02);
  EXPECT_LT(estimator.cross_validate(estimator.all_columns()).errors.rms(), 0.2);
}

// The force is 3 N at the greatest depth. On the way out one sample in four has no force,
// because the tool has left the material.
TEST(TrendEstimator, AForceThatWasNotMeasuredIsNoForceToFollow) {
  int sample_number = 0;
  const TrendRows rows = rows_of(FeatureList{}, 0.01, [&](const ToolSample&, const MotionEstimate& motion) {
    const bool left = motion.velocity_m_per_s < 0.0 && ++sample_number % 4 == 0;
    return left ? 0.0 : 3.0 * std::max(0.0, motion.position_m) / kDepth_m;
  });
  const TrendEstimator estimator(rows);
  const Trend trend = fitted_trend(rows, estimator.fit(estimator.all_columns()), true).trend;
  const double at[] = {kDepth_m};
  // Within a JND: samples that no feature explains get a small weight (sites.h).
  EXPECT_NEAR(trend.at(at, {FeatureSpec{}}), 3.0, 0.25);
}

// A soft layer on a hard plate: the force grows thirty-fold in the last tenth of the depth.
TEST(TrendEstimator, FollowsASharpBendOfTheElasticResponse) {
  const auto layer = [](double u) { return 0.3 * u + 9.0 * std::pow(std::max(0.0, u - 0.9) / 0.1, 2); };
  const TrendRows rows = rows_of(FeatureList{}, 1e-3, [&](const ToolSample&, const MotionEstimate& motion) {
    return layer(std::max(0.0, motion.position_m) / kDepth_m);
  });
  const TrendEstimator estimator(rows);
  const Trend trend = fitted_trend(rows, estimator.fit(estimator.all_columns()), true).trend;
  // The strokes end at 0.975.
  for (const double u : {0.2, 0.5, 0.85, 0.92, 0.95}) {
    const double at[] = {u * kDepth_m};
    // The tolerance is the JND of the true force.
    EXPECT_NEAR(trend.at(at, {FeatureSpec{}}), layer(u), 0.065 + 0.0633 * layer(u)) << u;
  }
}

// A left-out fold does not influence the solution that predicts it, nor the robust row weights.
TEST(TrendEstimator, AFoldThatIsLeftOutHasNoInfluence) {
  const FeatureList depth_alone;
  const auto rows_with = [&](double other_N) {
    return rows_of(depth_alone, 1e-3, [&](const ToolSample& sample, const MotionEstimate& motion) {
      const bool first_fold = static_cast<int>(sample.time_s) % kFolds == 0;
      return (first_fold ? other_N : 3.0) * std::max(0.0, motion.position_m) / kDepth_m;
    });
  };
  const TrendRows one = rows_with(3.0);
  const TrendRows other = rows_with(30.0);
  const TrendEstimator first(one, TrendEstimator::Smoothness::fixed);
  const TrendEstimator second(other, TrendEstimator::Smoothness::fixed);
  const CrossValidated a = first.cross_validate(first.all_columns());
  const CrossValidated b = second.cross_validate(second.all_columns());
  EXPECT_TRUE(a.solutions.col(0).isApprox(b.solutions.col(0), 1e-9));
}

}  // namespace
}  // namespace palpate
