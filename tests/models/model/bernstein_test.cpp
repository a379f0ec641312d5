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

// Simpson's rule over 64 panels of a fifth-order polynomial: error far below 1e-8.
TEST(Bernstein, IntegralMatchesQuadrature) {
  for (std::size_t k = 0; k <= 5; ++k) {
    for (const double u : {0.2, 0.7, 1.0}) {
      const double h = u / 128.0;
      double sum = 0.0;
      for (int i = 0; i < 64; ++i) {
        const double at = 2.0 * i * h;
        const int degree = static_cast<int>(k);
        sum += h / 3.0 * (direct(5, degree, at) + 4.0 * direct(5, degree, at + h) + direct(5, degree, at + 2.0 * h));
      }
      EXPECT_NEAR(u * polynomial(bernstein_integral<5>(k), u), sum, 1e-8) << k << " to " << u;
    }
  }
}

}  // namespace
}  // namespace palpate
