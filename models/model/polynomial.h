// Thread guarantee: pure functions, any thread.
#pragma once

#include <array>
#include <cstddef>

namespace palpate {

// Value of sum_k coefficients[k] u^k.
template <std::size_t n>
constexpr double polynomial(const std::array<double, n>& coefficients, double u) noexcept {
  double value = 0.0;
  for (std::size_t k = n; k-- > 0;) value = value * u + coefficients[k];
  return value;
}

}  // namespace palpate
