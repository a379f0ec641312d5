#include "models/model/bernstein.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate {
namespace {

// B_k,n(u) = C(n,k) u^k (1-u)^(n-k), as it is defined.
double direct(int n, int k, double u) {
  return std::tgamma(n + 1) / (std::tgamma(k + 1) * std::tgamma(n - k + 1)) * std::pow(u, k) * std::pow(1.0 - u, n - k);
}

TEST(Bernstein, CoefficientsGiveTheDefinition) {
  for (std::size_t k = 0; k <= 5; ++k) {
    for (double u = 0.0; u <= 1.0; u += 0.0625) {
      // Coefficients up to 30 of both signs: some 100 eps.
      EXPECT_NEAR(polynomial(bernstein<5>(k), u), direct(5, static_cast<int>(k), u), 1e-13) << k << " at " << u;
      if (k <= 2) {
        EXPECT_NEAR(polynomial(bernstein<2>(k), u), direct(2, static_cast<int>(k), u), 1e-14);
      }
    }
  }
}

// The central difference has an error of h^2 / 6 times a second derivative of at most 60, and rounds to 1e-9.
TEST(Bernstein, IntegralHasThePolynomialAsItsDerivative) {
  for (std::size_t k = 0; k <= 5; ++k) {
    const auto integral = [&](double u) { return u * polynomial(bernstein_integral<5>(k), u); };
    const double h = 1e-5;
    for (const double u : {0.2, 0.7, 1.0 - h}) {
      EXPECT_NEAR((integral(u + h) - integral(u - h)) / (2.0 * h), direct(5, static_cast<int>(k), u), 1e-8) << k;
    }
  }
}

}  // namespace
}  // namespace palpate
