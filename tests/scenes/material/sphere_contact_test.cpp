#include "scenes/material/sphere_contact.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate {
namespace {

TEST(SphereContact, IsHertzNearTheSurface) {
  const SphereContact contact{.radius_m = 0.01, .modulus_Pa = 20e3};
  // The next term is 0.2 a / R, here 0.2 %.
  const double depth_m = 1e-6;
  const double hertz_N = 16.0 / 9.0 * 20e3 * std::sqrt(0.01) * depth_m * std::sqrt(depth_m);
  EXPECT_NEAR(contact.force_N(depth_m) / hertz_N, 1.0, 3e-3);
  EXPECT_EQ(contact.force_N(0.0), 0.0);
}

// Lin et al. (2009) give the neo-Hookean force as a quotient of polynomials in a.
TEST(SphereContact, IsThePublishedQuotientWithoutStiffening) {
  const double r = 0.01, modulus_Pa = 30e3;
  const SphereContact contact{.radius_m = r, .modulus_Pa = modulus_Pa};
  for (double depth_m = 1e-4; depth_m < 0.02; depth_m *= 2.0) {
    const double a = std::sqrt(r * depth_m);
    const double quotient = (std::pow(a, 5) - 15.0 * r * std::pow(a, 4) + 75.0 * r * r * std::pow(a, 3)) /
                            (5.0 * r * a * a - 50.0 * r * r * a + 125.0 * r * r * r);
    EXPECT_NEAR(contact.force_N(depth_m) / (80.0 / 27.0 * modulus_Pa * quotient), 1.0, 1e-12);
  }
}

}  // namespace
}  // namespace palpate
