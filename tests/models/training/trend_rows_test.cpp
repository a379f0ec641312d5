#include "models/trend/trend_columns.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "models/model/trend.h"
#include "tests/support/feature_specs.h"

namespace palpate {
namespace {

constexpr double kDepth_m = 5e-3;
constexpr double kThinning_m_per_s = 0.02;

// Two strokes a second and a half long, half of the time outside.
MotionRow row_at(int i) {
  const double time_s = 1e-3 * i;
  const double angle = 2.0 * std::numbers::pi * time_s / 1.5;
  const double position_m = kDepth_m * std::sin(angle);
  const double velocity_m_per_s = kDepth_m * std::cos(angle) * 2.0 * std::numbers::pi / 1.5;
  return {{{time_s, position_m, 0.0, 0.0}, {position_m, velocity_m_per_s}, 0.5}, 0, 0, 7, i == 0};
}

// One branch for each drive curve of the basis.
std::vector<FeatureSpec> branch_basis(double relaxation_time_s) {
  std::vector<FeatureSpec> specs;
  for (const DriveCurve& drive : curve_basis(FeatureKind::maxwell_spectrum, kDepth_m)) {
    specs.push_back(test::spectrum({relaxation_time_s}, drive));
  }
  return specs;
}

TEST(TrendRows, ColumnsAreTheTrendsTerms) {
  FeatureList list;
  list.add(FeatureKind::velocity);
  list.add(FeatureKind::maxwell_spectrum, {0.17});
  list.add(FeatureKind::maxwell_spectrum, {1.27});
  TrendRows rows(list, {kDepth_m, kThinning_m_per_s});
  const std::vector<ElasticSpline> elastic = spline_basis();
  ASSERT_EQ(rows.columns(), kElasticTerms + 2 * kViscosityCoefficients + 2 * kCurveTerms);
  FeatureFilter first(branch_basis(0.17));
  FeatureFilter second(branch_basis(1.27));
  std::size_t contact = 0;
  for (int i = 0; i < 3000; ++i) {
    const MotionRow added = row_at(i);
    const auto& [sample, motion, force_N] = static_cast<const SurfaceRow&>(added);
    rows.add(added);
    const FeatureVector a = first.update(sample, motion);
    const FeatureVector b = second.update(sample, motion);
    if (!(sample.position_m > 0.0)) continue;
    ASSERT_EQ(rows.count(), ++contact);
    const double* row = rows.terms().row(static_cast<Eigen::Index>(contact) - 1).data();
    const double u = motion.position_m / kDepth_m;
    const double v = motion.velocity_m_per_s;
    for (std::size_t k = 0; k < kElasticTerms; ++k) ASSERT_EQ(row[k], elastic[k].at(std::min(u, 1.0)));
    row += kElasticTerms;
    const double basis[] = {(1 - u) * (1 - u), 2 * u * (1 - u), u * u};
    for (std::size_t k = 0; k < kViscosityCoefficients; ++k) {
      ASSERT_NEAR(row[k], v * basis[k], 1e-15);
      ASSERT_NEAR(row[3 + k], v / (1 + std::abs(v) / kThinning_m_per_s) * basis[k], 1e-15);
    }
    for (std::size_t k = 0; k < kCurveTerms; ++k) {
      ASSERT_EQ(row[6 + k], a.values[k]);
      ASSERT_EQ(row[9 + k], b.values[k]);
    }
    ASSERT_EQ(rows[contact - 1].fold, 7);
    ASSERT_EQ(rows[contact - 1].force_N, force_N);
  }
  EXPECT_GT(contact, 1000u);
}

// A weighted sum of branch features is one branch with the combined drive:
// the filter is linear in it.
TEST(TrendRows, CombinedDriveIsTheWeightedSumOfTheBasis) {
  const double weights[] = {0.5, 2.0, 0.25};
  FeatureFilter basis(branch_basis(0.3));
  FeatureFilter one({test::spectrum({0.3}, combined_curve(FeatureKind::maxwell_spectrum, weights, kDepth_m))});
  for (int i = 0; i < 2000; ++i) {
    const MotionRow row = row_at(i);
    const FeatureVector& parts = basis.update(row.sample, row.motion);
    const double sum = 0.5 * parts.values[0] + 2.0 * parts.values[1] + 0.25 * parts.values[2];
    ASSERT_NEAR(one.update(row.sample, row.motion).values[0], sum, 1e-12);  // rounding of 2,000 steps
  }
}

// The coarse curve locates the surface. It must reproduce a line and stay monotonic.
TEST(TrendRows, TheCoarseCurveIsTheSplineAndRises) {
  const std::vector<ElasticSpline> basis = spline_basis();
  const std::vector<double> ones(kElasticTerms, 1.0);
  const DriveCurve straight = surface_lag_of(combined_spline(basis, ones.data()), kDepth_m).drive;
  std::vector<double> stiffening(kElasticTerms);
  for (std::size_t i = 0; i < kElasticTerms; ++i) stiffening[i] = 1.0 + static_cast<double>(i);
  const ElasticSpline elastic = combined_spline(basis, stiffening.data());
  const DriveCurve coarse = surface_lag_of(elastic, kDepth_m).drive;
  const DriveCurve bend = surface_lag_of(basis[16], kDepth_m).drive;
  for (int i = 1; i <= 240; ++i) {
    const double u = i / 200.0;
    EXPECT_NEAR(straight.at(u * kDepth_m), u, 1e-12);
    // The error of Schoenberg's approximation is E'' h^2 / 6, with h = 1/8 and E'' at most 34 here.
    EXPECT_NEAR(coarse.at(std::min(u, 1.0) * kDepth_m), elastic.at(std::min(u, 1.0)), 34.0 / 64.0 / 6.0);
    EXPECT_GE(bend.at(u * kDepth_m), bend.at((u - 0.005) * kDepth_m) - 1e-13);
  }
}

TEST(TrendRows, RelaxationThatDependsOnDepthIsThatOfTheFeatures) {
  FeatureList list;
  list.add(FeatureKind::maxwell_spectrum, {0.02, 0.3});
  list.features.back().slowing = 2.0;
  TrendRows rows(list, {kDepth_m});
  std::vector<FeatureSpec> specs = branch_basis(0.3);
  for (FeatureSpec& spec : specs) spec.slowing = 2.0;
  FeatureFilter filter(specs);
  for (int i = 0; i < 2000; ++i) {
    const MotionRow row = row_at(i);
    rows.add(row);
    const FeatureVector& vector = filter.update(row.sample, row.motion);
    if (!vector.in_contact) continue;
    const auto terms = rows.terms().bottomRows<1>();
    for (std::size_t k = 0; k < kCurveTerms; ++k) {
      ASSERT_DOUBLE_EQ(terms(static_cast<Eigen::Index>(kElasticTerms + kCurveTerms + k)), vector.values[k]);
    }
  }
}

TEST(TrendRows, WithoutVelocityOrTimesOnlyTheElasticColumnsAreLeft) {
  EXPECT_EQ(TrendRows({}, {kDepth_m}).columns(), kElasticTerms);
}

TEST(TrendRows, AListIsSortedByKind) {
  FeatureList list;
  list.add(FeatureKind::creep, {1.0});
  list.add(FeatureKind::maxwell_spectrum, {0.1, 0.3});
  list.add(FeatureKind::velocity);
  list.add(FeatureKind::maxwell_spectrum, {0.02});
  EXPECT_EQ(relaxation_times_s(list.features), (std::vector{0.1, 0.3, 0.02}));
  const TrendRows rows(list, {kDepth_m});
  const std::size_t counts[] = {kElasticTerms, 2 * kViscosityCoefficients, 2 * kCurveTerms, kCurveTerms, kCurveTerms};
  ASSERT_EQ(rows.feature_columns().size(), std::size(counts));
  for (std::size_t f = 0; f < std::size(counts); ++f) EXPECT_EQ(rows.feature_columns()[f].size(), counts[f]) << f;
}

TEST(TrendRows, AStrideKeepsEveryNthSampleInContact) {
  TrendRows rows({}, {1.0}, 8);
  for (int i = 0; i < 4800; ++i) {
    rows.add({{{1e-3 * i, 0.5, 0.0, 0.0}, {0.5, 0.0}, static_cast<double>(i)}, 0, 0, i, i == 0});
  }
  ASSERT_EQ(rows.count(), 600u);
  for (std::size_t i = 0; i < rows.count(); ++i) {
    ASSERT_EQ(rows[i].force_N, 8.0 * static_cast<double>(i));
    ASSERT_EQ(rows[i].fold, 8 * static_cast<int>(i));
  }
}

}  // namespace
}  // namespace palpate
