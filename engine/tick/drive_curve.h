// Drive curves g: the force at a depth d of an elastic material, or of a branch before it relaxes.
//   g(d) = sum_k coefficient_N[k] u^(k+1) + sum_k knot_N[k] max(0, u - (k + 1) / (knots + 1))^3
// with u = d / reference_depth_m, for u <= 1; beyond, g continues along its tangent at u = 1. With knots it is a cubic
// spline.
// Thread guarantee: pure, wait-free.
#pragma once

#include <array>
#include <cstddef>

namespace palpate {

inline constexpr std::size_t kDriveCoefficients = 4;
inline constexpr std::size_t kDriveKnots = 7;

struct DriveCurve {
  double reference_depth_m = 1.0;
  std::array<double, kDriveCoefficients> coefficient_N{};
  bool has_knots = false;
  std::array<double, kDriveKnots> knot_N{};

  double at(double depth_m) const noexcept;
  bool operator==(const DriveCurve&) const = default;
};

constexpr double knot_position(std::size_t k) noexcept { return static_cast<double>(k + 1) / (kDriveKnots + 1); }

// The value at u <= 1. `curve`: a DriveCurve for one Number, or CurveLanes (feature_lanes.h) for four at once; the
// results are bit-identical.
template <typename Number, typename Curve>
[[gnu::always_inline]] inline void curve_value(Number& value, const Curve& curve, const Number& u) noexcept {
  value = Number{};
  for (std::size_t k = kDriveCoefficients; k-- > 0;) value = (value + curve.coefficient_N[k]) * u;
  if (!curve.has_knots) return;
  Number sum{};
  for (std::size_t k = 0; k < kDriveKnots; ++k) {
    const Number above = u - knot_position(k);
    const Number beyond = above > 0.0 ? above : Number{};
    sum += curve.knot_N[k] * beyond * beyond * beyond;
  }
  value += sum;
}

// The derivative dg/du at u = 1.
template <typename Number, typename Curve>
[[gnu::always_inline]] inline void curve_slope(Number& slope, const Curve& curve) noexcept {
  slope = Number{};
  for (std::size_t k = kDriveCoefficients; k-- > 0;) slope += static_cast<double>(k + 1) * curve.coefficient_N[k];
  if (!curve.has_knots) return;
  Number sum{};
  for (std::size_t k = 0; k < kDriveKnots; ++k) {
    const double beyond = 1.0 - knot_position(k);
    sum += 3.0 * (curve.knot_N[k] * beyond * beyond);
  }
  slope += sum;
}

inline double DriveCurve::at(double depth_m) const noexcept {
  const double u = depth_m / reference_depth_m;
  double value = 0.0;
  curve_value(value, *this, u > 1.0 ? 1.0 : u);
  if (u > 1.0) [[unlikely]] {
    double slope = 0.0;
    curve_slope(slope, *this);
    value += slope * (u - 1.0);
  }
  return value;
}

}  // namespace palpate
