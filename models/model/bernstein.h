// Bernstein polynomials on [0, 1] in powers of u. A polynomial with non-negative coefficients in this basis is
// non-negative on [0, 1]; the fit of the trend uses that.
// Thread guarantee: pure functions, any thread.
#pragma once

#include <array>
#include <cstddef>

namespace palpate {

// n over k.
constexpr double binomial(std::size_t n, std::size_t k) noexcept {
  double value = 1.0;
  for (std::size_t i = 1; i <= k; ++i) value = value * static_cast<double>(n - k + i) / static_cast<double>(i);
  return value;
}

// Coefficients of B_k,n(u) = C(n,k) u^k (1-u)^(n-k) in u^0 .. u^n.
template <std::size_t n>
constexpr std::array<double, n + 1> bernstein(std::size_t k) noexcept {
  std::array<double, n + 1> power{};
  for (std::size_t j = k; j <= n; ++j) {
    const double sign = (j - k) % 2 == 0 ? 1.0 : -1.0;
    power[j] = sign * binomial(n, j) * binomial(j, k);
  }
  return power;
}

// Coefficients of the integral of B_k,n from 0 to u in u^1 .. u^(n+1). It increases with u.
template <std::size_t n>
constexpr std::array<double, n + 1> bernstein_integral(std::size_t k) noexcept {
  std::array<double, n + 1> power = bernstein<n>(k);
  for (std::size_t j = 0; j <= n; ++j) power[j] /= static_cast<double>(j + 1);
  return power;
}

// Value of sum_k coefficients[k] u^k.
template <std::size_t n>
constexpr double polynomial(const std::array<double, n>& coefficients, double u) noexcept {
  double value = 0.0;
  for (std::size_t k = n; k-- > 0;) value = value * u + coefficients[k];
  return value;
}

}  // namespace palpate
