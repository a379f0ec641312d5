// A drive curve g(d) is a force at depth d, N: the elastic response, or a Maxwell branch before it relaxes.
//   g(d) = sum_k coefficient_N[k] u^(k+1) + sum_k knot_N[k] max(0, u - (k + 1) / (knots + 1))^3
// with u = d / reference_depth_m <= 1. Beyond u = 1, g continues along its tangent. With knots it is a cubic spline.
// Thread guarantee: pure, wait-free.
#pragma once

#include <array>
#include <cstddef>

namespace palpate {

inline constexpr std::size_t kDriveCoefficients = 4;
inline constexpr std::size_t kDriveKnots = 7;

// Sets `value` to g. `curve`: a DriveCurve for one Number, or CurveLanes (feature_lanes.h) for four at once; the
// results are bit-identical.
template <typename Number, typename Curve>
[[gnu::always_inline]] inline void evaluate_curve(Number& value, const Curve& curve, double depth_m) noexcept {
  const auto knot_position = [](std::size_t k) { return static_cast<double>(k + 1) / (kDriveKnots + 1); };
  const Number u = depth_m / curve.reference_depth_m;
  const Number inside = u > 1.0 ? Number{} + 1.0 : u;
  Number sum{};
  for (std::size_t k = kDriveCoefficients; k-- > 0;) sum = (sum + curve.coefficient_N[k]) * inside;
  Number knots{};
  for (std::size_t k = 0; curve.has_knots && k < kDriveKnots; ++k) {
    const Number above = inside - knot_position(k);
    const Number beyond = above > 0.0 ? above : Number{};
    knots += curve.knot_N[k] * beyond * beyond * beyond;
  }
  value = sum + knots;
  if (depth_m > curve.least_reference_m()) [[unlikely]] {
    Number slope{};  // dg/du at u = 1
    for (std::size_t k = kDriveCoefficients; k-- > 0;) slope += static_cast<double>(k + 1) * curve.coefficient_N[k];
    Number knots_slope{};
    for (std::size_t k = 0; curve.has_knots && k < kDriveKnots; ++k) {
      const double beyond = 1.0 - knot_position(k);
      knots_slope += 3.0 * (curve.knot_N[k] * beyond * beyond);
    }
    value = u > 1.0 ? value + (slope + knots_slope) * (u - 1.0) : value;
  }
}

struct DriveCurve {
  double reference_depth_m = 1.0;
  std::array<double, kDriveCoefficients> coefficient_N{};
  bool has_knots = false;
  std::array<double, kDriveKnots> knot_N{};

  double at(double depth_m) const noexcept {
    double value = 0.0;
    evaluate_curve(value, *this, depth_m);
    return value;
  }
  // Beyond this depth g is linear.
  double least_reference_m() const noexcept { return reference_depth_m; }
  bool operator==(const DriveCurve&) const = default;
};

}  // namespace palpate
