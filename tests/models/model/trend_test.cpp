#include "models/model/fitted_model.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/example_model.h"

namespace palpate {
namespace {

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

TEST(Trend, ContinuesAlongItsTangentBeyondTheReferenceDepth) {
  const Trend trend = example_trend();
  const double edge = at(trend, 5e-3, 0.0);
  const double slope_N_per_u = 6.0;  // of the last weight (example_model.h)
  EXPECT_NEAR(at(trend, 10e-3, 0.0), edge + slope_N_per_u, 1e-13);
  EXPECT_NEAR(at(trend, 20e-3, 0.0), edge + 3.0 * slope_N_per_u, 1e-13);
  // Beyond the edge the viscosities are constant.
  EXPECT_NEAR(at(trend, 10e-3, 0.01) - at(trend, 10e-3, 0.0), at(trend, 5e-3, 0.01) - edge, 1e-13);
}

}  // namespace
}  // namespace palpate
