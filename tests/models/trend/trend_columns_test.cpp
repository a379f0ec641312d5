#include "models/trend/trend_columns.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "models/model/trend.h"
#include "tests/support/exact_samples.h"
#include "tests/support/feature_specs.h"
#include "tests/support/message_parts.h"

namespace palpate {
namespace {

constexpr double kDepth_m = 5e-3;
constexpr double kThinning_m_per_s = 0.02;
constexpr std::size_t kAll = 1000000;

// Two strokes of a second and a half, half of the time outside.
Samples strokes() {
  Samples samples = test::exact_samples(3000, kDepth_m, [](std::size_t i) {
    const double time_s = 1e-3 * static_cast<double>(i);
    const double angle = 2.0 * std::numbers::pi * time_s / 1.5;
    const double velocity_m_per_s = kDepth_m * std::cos(angle) * 2.0 * std::numbers::pi / 1.5;
    return test::ExactRow{time_s, kDepth_m * std::sin(angle), velocity_m_per_s, 0.5};
  });
  samples.rms_velocity_m_per_s = kThinning_m_per_s;
  return samples;
}

TrendColumns columns_of(const Samples& samples, const FeatureList& list, std::size_t most_rows = kAll) {
  return test::must(TrendColumns::make(samples, list, most_rows));
}

// The columns times any weights are the trend of the model whose features they become.
TEST(TrendColumns, TimesWeightsAreTheTrendOfTheModel) {
  const Samples samples = strokes();
  FeatureList list;
  list.add(FeatureKind::velocity);
  list.add(FeatureKind::maxwell_spectrum, {0.05, 0.3});
  list.features.back().slowing = 1.5;
  list.add(FeatureKind::stops, {2e-4});
  list.add(FeatureKind::creep, {0.1, 1.0});
  const TrendColumns columns = columns_of(samples, list);
  ASSERT_EQ(columns.rows(), samples.contact);
  Eigen::VectorXd x(columns.columns());
  for (Eigen::Index k = 0; k < x.size(); ++k) x(k) = 0.3 + 0.1 * static_cast<double>(k % 7);
  const FittedTrend fitted = fitted_trend(columns, x, true);
  FeatureFilter filter(fitted.features);
  const Eigen::VectorXd force_N = columns.terms() * x;
  Eigen::Index row = 0;
  for (const Sample& sample : samples.rows) {
    const FeatureVector& vector = filter.update(sample.tool, sample.motion);
    if (!vector.in_contact) continue;
    // Rounding of sums of forces of some newtons.
    ASSERT_NEAR(fitted.trend.at(vector.values.data(), fitted.features), force_N(row++), 1e-11);
  }
  EXPECT_EQ(row, force_N.size());
}

TEST(TrendColumns, WithoutVelocityOrTimesOnlyTheElasticColumnsAreLeft) {
  EXPECT_EQ(columns_of(strokes(), {}).columns(), kElasticTerms);
}

TEST(TrendColumns, AListIsSortedByKind) {
  FeatureList list;
  list.add(FeatureKind::creep, {1.0});
  list.add(FeatureKind::maxwell_spectrum, {0.1, 0.3});
  list.add(FeatureKind::velocity);
  list.add(FeatureKind::maxwell_spectrum, {0.02});
  list.add(FeatureKind::stops, {});  // nothing
  EXPECT_EQ(relaxation_times_s(list.features), (std::vector{0.1, 0.3, 0.02}));
  const TrendColumns columns = columns_of(strokes(), list);
  const std::size_t counts[] = {kElasticTerms, 2 * kViscosityCoefficients, 2 * kCurveTerms, kCurveTerms, kCurveTerms};
  ASSERT_EQ(columns.feature_columns().size(), std::size(counts));
  Eigen::Index next = 0;
  for (std::size_t f = 0; f < std::size(counts); ++f) {
    ASSERT_EQ(columns.feature_columns()[f].size(), counts[f]) << f;
    for (const Eigen::Index column : columns.feature_columns()[f]) EXPECT_EQ(column, next++);
  }
  const ColumnList some = columns.columns_of([](std::size_t f) { return f == 1 || f == 4; });
  EXPECT_EQ(some.size(), counts[1] + counts[4]);
  EXPECT_EQ(some.front(), columns.feature_columns()[1].front());
  EXPECT_EQ(some.back(), next - 1);
}

TEST(TrendColumns, HaveEveryNthSampleInContact) {
  const Samples samples = test::exact_samples(4800, 1.0, [](std::size_t i) {
    return test::ExactRow{1e-3 * static_cast<double>(i), 0.5, 0.0, static_cast<double>(i), static_cast<int>(i)};
  });
  const TrendColumns columns = columns_of(samples, {}, 640);  // 4800 / 640 = 7.5
  EXPECT_EQ(columns.stride(), 8u);
  ASSERT_EQ(columns.count(), 600u);
  for (std::size_t i = 0; i < columns.count(); ++i) {
    ASSERT_EQ(columns.force_N(i), 8.0 * static_cast<double>(i));
    ASSERT_EQ(columns.fold(i), 8 * static_cast<int>(i));
  }
}

TEST(TrendColumns, CanBeInterrupted) {
  FeatureList list;
  list.add(FeatureKind::maxwell_spectrum, {0.1});
  const FitControl stop{[](double) { return false; }};
  EXPECT_EQ(test::message_of(TrendColumns::make(strokes(), list, kAll, stop)), "interrupted");
}

// Parts without weight are left out, unless all are asked for.
TEST(FittedTrend, HasTheFeaturesWithWeights) {
  const Samples samples = strokes();
  FeatureList list;
  list.add(FeatureKind::velocity);
  list.add(FeatureKind::maxwell_spectrum, {0.05, 0.3});
  list.add(FeatureKind::stops, {2e-4});
  const TrendColumns columns = columns_of(samples, list);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(columns.columns());
  x(columns.feature_columns()[2][4]) = 2.0;  // the second basis function of 0.3 s
  const FittedTrend fitted = fitted_trend(columns, x, false);
  ASSERT_EQ(fitted.features.size(), 3u);
  EXPECT_EQ(constants_of(fitted.features[2]), std::vector{0.3});
  const DriveCurve& drive = fitted.features[2].parts[0].drive;
  EXPECT_EQ(drive.reference_depth_m, kDepth_m);
  EXPECT_EQ(drive.coefficient_N, (std::array{0.0, 2.0, -4.0 / 3.0, 0.0}));
  EXPECT_EQ(fitted.trend.reference_depth_m, kDepth_m);
  EXPECT_EQ(fitted.trend.thinning_velocity_m_per_s, kThinning_m_per_s);
  // 1.5 times the greatest velocity.
  EXPECT_NEAR(fitted.trend.velocity_limit_m_per_s, 1.5 * kDepth_m * 2.0 * std::numbers::pi / 1.5, 1e-6);
  EXPECT_EQ(fitted_trend(columns, x, true).features.size(), 4u);
}

TEST(FittedTrend, LimitsTheVelocityByTheFastestOfBothDirections) {
  Samples samples = strokes();
  for (Sample& row : samples.rows) row.motion.velocity_m_per_s = std::min(row.motion.velocity_m_per_s, 1e-3);
  const TrendColumns columns = columns_of(samples, {});
  const FittedTrend fitted = fitted_trend(columns, Eigen::VectorXd::Zero(columns.columns()), false);
  EXPECT_NEAR(fitted.trend.velocity_limit_m_per_s, 1.5 * kDepth_m * 2.0 * std::numbers::pi / 1.5, 1e-6);
}

// 60 s at 1 kHz: four times a decade from 2 samples to a third of the recording.
TEST(Dictionary, HasWhatARecordingCanIdentify) {
  Samples samples = strokes();
  samples.sample_s = 1e-3;
  samples.longest_recording_s = 60.0;
  samples.sensor.encoder_step_m = 30e-6;
  const std::vector<double> times_s = dictionary_times_s(samples);
  ASSERT_EQ(times_s.size(), 17u);
  EXPECT_DOUBLE_EQ(times_s.front(), 2e-3);
  EXPECT_NEAR(times_s.back(), 20.0, 1e-9);
  const FeatureList list = dictionary(samples);
  ASSERT_EQ(list.features.size(), 7u);  // depth, velocity, three bands, stops, creep
  EXPECT_EQ(relaxation_times_s(list.features), times_s);
  // Halves of 2.5 mm, not below 30 um.
  const std::vector<double> thresholds_m = constants_of(list.features[5]);
  ASSERT_EQ(thresholds_m.size(), 7u);
  EXPECT_DOUBLE_EQ(thresholds_m.back(), 2.5e-3);
  EXPECT_DOUBLE_EQ(thresholds_m.front(), 2.5e-3 / 64.0);
  EXPECT_EQ(constants_of(list.features[6]).size(), 5u);  // 1 ms to 10 s
  EXPECT_EQ(term_name(list.features[1]), "velocity");
  EXPECT_EQ(term_name(list.features[5]), "stops 0.0391-2.5 mm");
  EXPECT_EQ(term_name(list.features[6]), "creep 0.001-10 s");
  samples.longest_recording_s = 3e-3;
  EXPECT_TRUE(dictionary_times_s(samples).empty());
}

}  // namespace
}  // namespace palpate
