#include "models/model/elastic_spline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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

TEST(ElasticSpline, EarlierFilesGiveTheSameCurve) {
  const std::array<double, 7> knots{1.0, -2.0, 3.0, 0.5, -0.25, 2.0, -4.0};
  const ElasticSpline spline = spline_from_powers({0.5, -0.25, 2.0}, knots);
  const auto closed_form = [&](double u) {
    double value = 0.5 * u - 0.25 * u * u + 2.0 * u * u * u;
    for (std::size_t k = 0; k < knots.size(); ++k) {
      value += knots[k] * std::pow(std::max(0.0, u - static_cast<double>(k + 1) / 8.0), 3);
    }
    return value;
  };
  for (int i = 0; i <= 1000; ++i) EXPECT_NEAR(spline.at(1e-3 * i), closed_form(1e-3 * i), 1e-12);
}

TEST(ElasticSpline, IsFiniteForEveryDepth) {
  const ElasticSpline spline = spline_from_powers({1.0, 0.0, 0.0}, {});
  EXPECT_EQ(spline.at(0.0), 0.0);
  EXPECT_NEAR(spline.at(1e6), 1e6, 1e-6);
  EXPECT_TRUE(std::isfinite(spline.at(-1.0)));
}

}  // namespace
}  // namespace palpate
