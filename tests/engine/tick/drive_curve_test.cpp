#include "engine/tick/feature_lanes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

const DriveCurve kCurve{5e-3, {0.5, -0.2, 0.7, 0.1}, true, {1.0, -2.0, 3.0, 0.5, -0.25, 2.0, -4.0}};

double by_powers(double u) {
  double sum = 0.0;
  for (std::size_t k = 0; k < kDriveCoefficients; ++k)
    sum += kCurve.coefficient_N[k] * std::pow(u, static_cast<double>(k + 1));
  for (std::size_t k = 0; k < kDriveKnots; ++k) {
    sum += kCurve.knot_N[k] * std::pow(std::max(0.0, u - static_cast<double>(k + 1) / 8.0), 3.0);
  }
  return sum;
}

// The rounding error of a dozen terms below 4.
constexpr double kRounding = 1e-14;

TEST(DriveCurve, IsThePolynomialAndTheKnots) {
  for (double u = 0.0; u <= 1.0; u += 0.01) EXPECT_NEAR(kCurve.at(5e-3 * u), by_powers(u), kRounding);
  DriveCurve plain = kCurve;
  plain.has_knots = false;
  EXPECT_NEAR(plain.at(2.5e-3), 0.25 - 0.05 + 0.0875 + 0.00625, kRounding);
}

TEST(DriveCurve, ContinuesAlongItsTangent) {
  const double h = 1e-6;  // cbrt(eps)
  const double slope = (kCurve.at(5e-3) - kCurve.at(5e-3 * (1.0 - h))) / h;
  for (const double u : {1.0, 1.5, 30.0}) {
    EXPECT_NEAR(kCurve.at(5e-3 * u), by_powers(1.0) + slope * (u - 1.0), 1e-4 * u);
  }
}

}  // namespace
}  // namespace palpate
