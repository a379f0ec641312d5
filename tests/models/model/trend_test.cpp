#include "models/model/trend.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/example_model.h"

namespace palpate {
namespace {

// The B-splines sum to 1 and are nowhere negative, so their integrals rise and sum to u.
TEST(ElasticSpline, BasisRisesAndSumsToAStraightLine) {
  const std::vector<ElasticSpline> basis = spline_basis();
  const std::vector<double> ones(kElasticTerms, 1.0);
  const ElasticSpline straight = combined_spline(basis, ones.data());
  for (int i = 1; i <= 240; ++i) {
    const double u = i / 200.0;
    EXPECT_NEAR(straight.at(u), u, 1e-12);
    for (const ElasticSpline& curve : basis) EXPECT_GE(curve.at(u), curve.at(u - 0.005) - 1e-13);
  }
}

TEST(ElasticSpline, IsFiniteForEveryDepth) {
  const ElasticSpline spline = test::even_spline(1.0, 1.0);
  EXPECT_EQ(spline.at(0.0), 0.0);
  EXPECT_NEAR(spline.at(1e6), 1e6, 1e-6);
  EXPECT_TRUE(std::isfinite(spline.at(-1.0)));
}

Trend example_trend() {
  Trend trend;
  trend.reference_depth_m = 5e-3;
  trend.elastic = test::even_spline(1.0, 6.0);
  trend.viscosity_Ns_per_m = {2.0, 1.0, 0.5};
  trend.thinning_Ns_per_m = {3.0, 0.0, 1.0};
  trend.thinning_velocity_m_per_s = 0.02;
  trend.velocity_limit_m_per_s = 0.1;
  return trend;
}

double at(const Trend& trend, double depth_m, double velocity_m_per_s) {
  const double x[] = {depth_m, velocity_m_per_s, 0.3, 0.4};
  return trend.at(x, test::paper_features());
}

TEST(Trend, IsItsClosedFormInsideTheData) {
  const Trend trend = example_trend();
  for (const double u : {0.0, 0.3, 1.0}) {
    for (const double v : {-0.05, 0.0, 0.08}) {
      const double elastic = trend.elastic.at(u);
      const double viscous = (2.0 + u + 0.5 * u * u) * v;
      const double thinning = (3.0 + u * u) * v / (1.0 + std::abs(v) / 0.02);
      EXPECT_NEAR(at(trend, u * 5e-3, v), elastic + viscous + thinning, 1e-14) << u << " " << v;
    }
  }
}

TEST(Trend, BranchesAddTheirForceAndLowPassesNothing) {
  const Trend trend = example_trend();
  const double x[] = {2e-3, 0.01, 0.3, 0.4};
  EXPECT_NEAR(trend.at(x, test::maxwell_features()), trend.at(x, test::paper_features()) + 0.7, 1e-15);
}

TEST(Trend, ContinuesAlongItsTangentBeyondTheReferenceDepth) {
  const Trend trend = example_trend();
  const double edge = at(trend, 5e-3, 0.0);
  const double slope_N_per_u = 6.0;  // of the last weight (example_model.h)
  EXPECT_NEAR(at(trend, 10e-3, 0.0), edge + slope_N_per_u, 1e-13);
  EXPECT_NEAR(at(trend, 20e-3, 0.0), edge + 3.0 * slope_N_per_u, 1e-13);
  // Beyond the edge the viscosities are constant.
  EXPECT_NEAR(at(trend, 10e-3, 0.01) - at(trend, 10e-3, 0.0), at(trend, 5e-3, 0.01) - edge, 1e-13);
}

TEST(Trend, VelocityCountsUpToItsLimit) {
  const Trend trend = example_trend();
  EXPECT_EQ(at(trend, 3e-3, 0.5), at(trend, 3e-3, 0.1));
  EXPECT_EQ(at(trend, 3e-3, -9.0), at(trend, 3e-3, -0.1));
  EXPECT_LT(at(trend, 3e-3, 0.09), at(trend, 3e-3, 0.1));
}

TEST(Trend, PositionAloneLeavesTheElasticPart) {
  const Trend trend = example_trend();
  const double x[] = {3e-3};
  EXPECT_EQ(trend.at(x, test::position_features()), at(trend, 3e-3, 0.0));
}

}  // namespace
}  // namespace palpate
