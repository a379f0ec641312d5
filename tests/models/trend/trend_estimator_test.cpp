#include "models/trend/trend_estimator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/exact_samples.h"
#include "tests/support/feature_specs.h"
#include "tests/support/message_parts.h"

namespace palpate {
namespace {

constexpr double kDepth_m = 5e-3;
constexpr int kFolds = 5;

// Strokes of growing depth and speed, a second each, measured at 500 Hz.
template <typename Force>
Samples samples_of(double force_noise_N, const Force& force_N) {
  Samples samples = test::exact_samples(10000, kDepth_m, [&](std::size_t i) {
    const double t = 2e-3 * static_cast<double>(i);
    const int stroke = static_cast<int>(i) / 500;
    const double angle = 2.0 * std::numbers::pi * (1.0 + stroke % 3) * t;
    const double amplitude_m = kDepth_m * (0.5 + 0.025 * stroke);
    const double position_m = amplitude_m * std::sin(angle);
    const double velocity_m_per_s = amplitude_m * std::cos(angle) * 2.0 * std::numbers::pi * (1.0 + stroke % 3);
    return test::ExactRow{t, position_m, velocity_m_per_s,
                          force_N({t, position_m, 0.0, 0.0}, {position_m, velocity_m_per_s}), stroke % kFolds};
  });
  samples.rms_velocity_m_per_s = 0.02;
  samples.force_noise_N = force_noise_N;
  return samples;
}

TrendColumns columns_of(const Samples& samples, const FeatureList& list = {}) {
  return test::must(TrendColumns::make(samples, list, samples.rows.size()));
}

double rms_of(const TrendColumns& rows, const Eigen::VectorXd& x) {
  double sum = 0.0;
  for (std::size_t i = 0; i < rows.count(); ++i) {
    const double error_N = rows.terms().row(static_cast<Eigen::Index>(i)).dot(x) - rows.force_N(i);
    sum += error_N * error_N;
  }
  return std::sqrt(sum / static_cast<double>(rows.count()));
}

// From -1 to 2 N: the elastic response begins at 0 N only where there is free air.
TEST(TrendEstimator, WithoutFreeAirAMaterialMayPullAtItsSurface) {
  Samples samples = samples_of(0.0, [](const ToolSample&, const MotionEstimate& motion) {
    return -1.0 + 3.0 * std::max(0.0, motion.position_m) / kDepth_m;
  });
  samples.lowest_force_N = -1.0;
  const auto error_N = [&](bool outside) {
    samples.surface_outside = outside;
    const TrendColumns rows = columns_of(samples);
    const TrendEstimator estimator(rows, {});
    return rms_of(rows, estimator.fit(estimator.all_columns()));
  };
  EXPECT_LT(error_N(true), 0.01);  // the smoothness bends no line
  EXPECT_GT(error_N(false), 0.1);
}

TEST(TrendEstimator, FindsWhatIsInTheDictionaryAndMakesNothingNegative) {
  FeatureFilter branch({test::spectrum({0.1}, {kDepth_m, {1.5, 0.5, 0.0, 0.0}})});
  FeatureList list;
  list.add(FeatureKind::velocity);
  list.add(FeatureKind::maxwell_spectrum, {0.01, 0.1, 1.0});
  Samples samples = samples_of(0.0, [&](const ToolSample& sample, const MotionEstimate& motion) {
    const double u = std::max(0.0, motion.position_m) / kDepth_m;
    return 2.0 * u + u * u + branch.update(sample, motion).values[0];
  });
  samples.lowest_force_N = -1.0;  // every force counts
  const TrendColumns rows = columns_of(samples, list);
  const TrendEstimator estimator(rows, {});
  const Eigen::VectorXd x = estimator.fit(estimator.all_columns());
  EXPECT_GE(x.minCoeff(), 0.0);
  // With forces of up to 4.5 N. The error is a bias of the penalty.
  EXPECT_LT(rms_of(rows, x), 0.02);
  EXPECT_LT(estimator.cross_validate(estimator.all_columns()).errors.rms(), 0.2);
}

// The features of the trend have an error of 3 %, and of 10 % if there is creep: a viscous force of 100 Ns/m, up to 9
// N, is fitted that much too small in the mean square.
TEST(TrendEstimator, FeaturesCountAsInexact) {
  Samples samples = samples_of(0.0, [](const ToolSample&, const MotionEstimate& motion) {
    return motion.position_m > 0.0 ? 100.0 * motion.velocity_m_per_s : 0.0;
  });
  samples.lowest_force_N = -10.0;  // every force counts
  double rms_N[2];
  for (const bool creep : {false, true}) {
    FeatureList list;
    list.add(FeatureKind::velocity);
    if (creep) list.add(FeatureKind::creep, {10.0});
    const TrendColumns rows = columns_of(samples, list);
    const TrendEstimator estimator(rows, {});
    rms_N[creep ? 1 : 0] = rms_of(rows, estimator.fit(estimator.all_columns()));
  }
  EXPECT_GT(rms_N[0], 1e-4);
  EXPECT_GT(rms_N[1], 5.0 * rms_N[0]);
}

// The force is 3 N at the greatest depth. On the way out one sample in four has no force,
// because the tool has left the material.
TEST(TrendEstimator, AForceThatWasNotMeasuredIsNoForceToFollow) {
  int sample_number = 0;
  const Samples samples = samples_of(1e-3, [&](const ToolSample&, const MotionEstimate& motion) {
    const bool left = motion.velocity_m_per_s < 0.0 && ++sample_number % 4 == 0;
    return left ? 0.0 : 3.0 * std::max(0.0, motion.position_m) / kDepth_m;
  });
  const TrendColumns rows = columns_of(samples);
  const TrendEstimator estimator(rows, {});
  const Trend trend = fitted_trend(rows, estimator.fit(estimator.all_columns()), true).trend;
  const double at[] = {kDepth_m};
  // Within a JND: samples that no feature explains get a small weight (trend_estimator.h).
  EXPECT_NEAR(trend.at(at, {FeatureSpec{}}), 3.0, 0.25);
}

// A soft layer on a hard plate: the force grows thirty-fold in the last tenth of the depth.
TEST(TrendEstimator, FollowsASharpBendOfTheElasticResponse) {
  const auto layer = [](double u) { return 0.3 * u + 9.0 * std::pow(std::max(0.0, u - 0.9) / 0.1, 2); };
  const Samples samples = samples_of(1e-4, [&](const ToolSample&, const MotionEstimate& motion) {
    return layer(std::max(0.0, motion.position_m) / kDepth_m);
  });
  const TrendColumns rows = columns_of(samples);
  const TrendEstimator estimator(rows, {});
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
  const auto samples_with = [](double other_N) {
    return samples_of(1e-4, [&](const ToolSample& sample, const MotionEstimate& motion) {
      const bool first_fold = static_cast<int>(sample.time_s) % kFolds == 0;
      return (first_fold ? other_N : 3.0) * std::max(0.0, motion.position_m) / kDepth_m;
    });
  };
  const Samples same = samples_with(3.0);
  const Samples larger = samples_with(30.0);
  const TrendColumns one = columns_of(same);
  const TrendColumns other = columns_of(larger);
  const TrendEstimator first(one, {}, TrendEstimator::kFirstSmoothness);
  const TrendEstimator second(other, {}, TrendEstimator::kFirstSmoothness);
  const CrossValidated a = first.cross_validate(first.all_columns());
  const CrossValidated b = second.cross_validate(second.all_columns());
  EXPECT_TRUE(a.solutions.col(0).isApprox(b.solutions.col(0), 1e-9));
  EXPECT_FALSE(a.solutions.col(1).isApprox(b.solutions.col(1), 1e-2));
}

}  // namespace
}  // namespace palpate
