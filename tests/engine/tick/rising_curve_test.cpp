#include "engine/tick/rising_curve.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate {
namespace {

const std::array<double, 3> kCoefficients{0.5, -0.2, 0.7};
const std::array<double, kDriveKnots> kKnots{1.0, -2.0, 3.0, 0.5, -0.25, 2.0, -4.0};

double by_powers(double u) {
  double sum = 0.0;
  for (std::size_t k = 0; k < kCoefficients.size(); ++k)
    sum += kCoefficients[k] * std::pow(u, static_cast<double>(k + 1));
  for (std::size_t k = 0; k < kDriveKnots; ++k) {
    sum += kKnots[k] * std::pow(std::max(0.0, u - static_cast<double>(k + 1) / 8.0), 3.0);
  }
  return sum;
}

// The rounding error of a dozen terms below 4.
constexpr double kRounding = 1e-14;

TEST(RisingCurve, IsThePolynomialAndTheKnots) {
  for (double u = 0.0; u <= 1.0; u += 0.01)
    EXPECT_NEAR(rising_curve(kCoefficients, &kKnots, u), by_powers(u), kRounding);
  EXPECT_NEAR(rising_curve(kCoefficients, nullptr, 0.5), 0.25 - 0.05 + 0.0875, kRounding);
}

TEST(RisingCurve, GoesOnAlongItsTangent) {
  const double h = 1e-6;  // cbrt(eps)
  const double slope = (rising_curve(kCoefficients, &kKnots, 1.0) - rising_curve(kCoefficients, &kKnots, 1.0 - h)) / h;
  for (const double u : {1.0, 1.5, 30.0}) {
    EXPECT_NEAR(rising_curve(kCoefficients, &kKnots, u), by_powers(1.0) + slope * (u - 1.0), 1e-4 * u);
  }
}

}  // namespace
}  // namespace palpate
