// The curves of the trend and the features:
//   g(u) = sum_k c_k u^(k+1) + sum_k knot_k max(0, u - (k + 1) / (knots + 1))^3
// for u <= 1; beyond, g continues along its tangent at u = 1. With knots it is a cubic spline. Results for one number
// and for vectors (lanes.h) are bit-identical.
// Thread guarantee: pure, wait-free.
#pragma once

#include <array>
#include <cstddef>
#include <iterator>

namespace palpate {

inline constexpr std::size_t kDriveKnots = 7;
constexpr double knot_place(std::size_t k) noexcept { return static_cast<double>(k + 1) / (kDriveKnots + 1); }

// g(u) for u <= 1. `coefficient`, `knot`: arrays of Number or of double; `knot` is null without knots.
template <typename Number, typename List, typename Knots>
[[gnu::always_inline]] inline void rising_value(Number& value, const List& coefficient, const Knots* knot,
                                                const Number& u) noexcept {
  value = Number{};
  for (std::size_t k = std::size(coefficient); k-- > 0;) value = (value + coefficient[k]) * u;
  if (knot == nullptr) return;
  Number sum{};
  for (std::size_t k = 0; k < kDriveKnots; ++k) {
    const Number above = u - knot_place(k);
    const Number beyond = above > 0.0 ? above : Number{};
    sum += (*knot)[k] * beyond * beyond * beyond;
  }
  value += sum;
}

// g'(1).
template <typename Number, typename List, typename Knots>
[[gnu::always_inline]] inline void slope_at_end(Number& slope, const List& coefficient, const Knots* knot) noexcept {
  slope = Number{};
  for (std::size_t k = std::size(coefficient); k-- > 0;) slope = slope + static_cast<double>(k + 1) * coefficient[k];
  if (knot == nullptr) return;
  Number sum{};
  for (std::size_t k = 0; k < kDriveKnots; ++k) {
    const double beyond = 1.0 - knot_place(k);
    sum += 3.0 * ((*knot)[k] * beyond * beyond);
  }
  slope += sum;
}

template <std::size_t n>
double rising_curve(const std::array<double, n>& coefficient, const std::array<double, kDriveKnots>* knot,
                    double u) noexcept {
  double value = 0.0;
  rising_value(value, coefficient, knot, u > 1.0 ? 1.0 : u);
  if (u > 1.0) [[unlikely]] {
    double slope = 0.0;
    slope_at_end(slope, coefficient, knot);
    value += slope * (u - 1.0);
  }
  return value;
}

}  // namespace palpate
