#include "models/training/trend_rows.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "models/model/bernstein.h"
#include "models/model/trend.h"
#include "tests/support/feature_specs.h"

namespace palpate {
namespace {

constexpr double kDepth_m = 5e-3;
constexpr double kThinning_m_per_s = 0.02;

struct Step {
  ToolSample sample;
  MotionEstimate motion;
};

// Two strokes a second and a half long, half of the time outside.
Step step_at(int i) {
  const double time_s = 1e-3 * i;
  const double angle = 2.0 * std::numbers::pi * time_s / 1.5;
  const double position_m = kDepth_m * std::sin(angle);
  return {{time_s, position_m, 0.0, 0.0}, {position_m, kDepth_m * std::cos(angle) * 2.0 * std::numbers::pi / 1.5}};
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
  list.velocity = true;
  list.relaxation_times_s = {{0.17}, {1.27}};
  TrendRows rows(list, {kDepth_m, kThinning_m_per_s}, 4000);
  const std::vector<ElasticSpline> elastic = spline_basis();
  ASSERT_EQ(rows.columns(), kElasticTerms + 2 * kViscosityCoefficients + 2 * kCurveTerms);
  FeatureFilter first(branch_basis(0.17));
  FeatureFilter second(branch_basis(1.27));
  rows.begin_recording();
  std::size_t contact = 0;
  for (int i = 0; i < 3000; ++i) {
    const auto [sample, motion] = step_at(i);
    rows.add(sample, motion, 0.5, 7);
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
    const auto [sample, motion] = step_at(i);
    const FeatureVector& parts = basis.update(sample, motion);
    const double sum = 0.5 * parts.values[0] + 2.0 * parts.values[1] + 0.25 * parts.values[2];
    ASSERT_NEAR(one.update(sample, motion).values[0], sum, 1e-12);  // rounding of 2,000 steps
  }
}

// The coarse curve locates the surface. It must reproduce a line and stay monotonic.
TEST(TrendRows, TheCoarseCurveIsTheSplineAndRises) {
  const std::vector<ElasticSpline> basis = spline_basis();
  const std::vector<double> ones(kElasticTerms, 1.0);
  const DriveCurve straight = coarse_curve(combined_spline(basis, ones.data()), kDepth_m);
  std::vector<double> stiffening(kElasticTerms);
  for (std::size_t i = 0; i < kElasticTerms; ++i) stiffening[i] = 1.0 + static_cast<double>(i);
  const ElasticSpline elastic = combined_spline(basis, stiffening.data());
  const DriveCurve coarse = coarse_curve(elastic, kDepth_m);
  const DriveCurve bend = coarse_curve(basis[16], kDepth_m);
  for (int i = 1; i <= 240; ++i) {
    const double u = i / 200.0;
    EXPECT_NEAR(straight.at(u * kDepth_m), u, 1e-12);
    // The error of Schoenberg's approximation is E'' h^2 / 6, with h = 1/8 and E'' at most 34 here.
    EXPECT_NEAR(coarse.at(std::min(u, 1.0) * kDepth_m), elastic.at(std::min(u, 1.0)), 34.0 / 64.0 / 6.0);
    EXPECT_GE(bend.at(u * kDepth_m), bend.at((u - 0.005) * kDepth_m) - 1e-13);
  }
}

TEST(TrendRows, ALadderIsItsBranches) {
  for (const double slowing : {0.0, 2.0}) {
    std::vector<FeatureSpec> specs = branch_basis(0.3);
    for (FeatureSpec& spec : specs) spec.slowing = slowing;
    FeatureFilter filter(specs);
    BranchLadder ladder({0.02, 0.3}, kDepth_m, slowing);
    for (int i = 0; i < 2000; ++i) {
      const auto [sample, motion] = step_at(i);
      const double depth_m = std::max(0.0, motion.position_m);
      ladder.update(sample.time_s, depth_m, depth_m);
      const FeatureVector& vector = filter.update(sample, motion);
      for (std::size_t k = 0; k < kCurveTerms; ++k)
        ASSERT_DOUBLE_EQ(ladder.values()[kCurveTerms + k], vector.values[k]);
    }
  }
}

TEST(TrendRows, WithoutVelocityOrTimesOnlyTheElasticColumnsAreLeft) {
  TrendRows rows({}, {kDepth_m}, 1000);
  EXPECT_EQ(rows.columns(), kElasticTerms);
  EXPECT_EQ(rows.viscous_columns(), 0u);
}

TEST(TrendRows, HalvingBoundsTheRowsAndKeepsEvenOnesInOrder) {
  TrendRows rows({}, {1.0}, 1000);
  rows.begin_recording();
  const int count = 4800;
  for (int i = 0; i < count; ++i) {
    rows.add({1e-3 * i, 0.5, 0.0, 0.0}, {0.5, 0.0}, static_cast<double>(i), i);
    ASSERT_LE(rows.count(), 1000u);
  }
  // 4,800 rows are more than four times the maximum, so every eighth row is kept.
  ASSERT_EQ(rows.count(), 600u);
  for (std::size_t i = 0; i < rows.count(); ++i) {
    ASSERT_EQ(rows[i].force_N, 8.0 * static_cast<double>(i));
    ASSERT_EQ(rows[i].fold, 8 * static_cast<int>(i));
  }
}

}  // namespace
}  // namespace palpate
