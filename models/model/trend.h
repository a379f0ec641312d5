// The trend: a nonlinear viscoelastic solid fitted to the recording, which the
// radial basis functions correct near the data and which stands alone away
// from it.
//
//   T(x) = E(d) + eta(d) v + mu(d) v / (1 + |v| / v_0) + sum_b z_b + sum y
//          + sum_j S_j(d) (d / m)^p_j,   p = 1, 4, 12
//
// d depth, v velocity, z_b the force of Maxwell branch b (engine/tick/features.h),
// all taken from the feature vector; v_0 is the recording's RMS velocity, so
// that the two viscous terms together follow a viscosity that falls with speed.
// z_b also of a maxwell_spectrum, y the force of stop operators, m the fading
// deepest depth: S_j is what the material has only where it is pressed as deep as
// not for some time (softening). E rises with depth, eta, mu and the branch stiffnesses are never negative
// (the fit enforces it), and so are S_j and its slope. So the trend stores and
// dissipates energy and makes none: of the softening terms, with
//   psi(d, m) = integral_0^d sum_j S_j(s) (s / m)^p_j ds,  psi_m <= 0,
// psi - integral psi_m(m, m) dm is a store that pressing deeper fills by at least as
// much as healing can give back, since -psi_m(d, m) rises with d. A scene without velocity or branches has
// the terms that it has features for; position alone leaves E(d).
//
// Beyond the data: E continues along its tangent below the greatest recorded
// depth, v counts up to velocity_limit, so that the value stays bounded by what
// a recording can justify; the model clamps the rest.
//
// Thread guarantee: value type, `at` is wait-free and allocates nothing.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/tick/features.h"

namespace palpate {

inline constexpr std::size_t kElasticCoefficients = 6;
inline constexpr std::size_t kViscosityCoefficients = 3;
inline constexpr std::array kSofteningPowers{1, 4, 12};

// Where the trend finds its terms among the features: made once, so that a tick does
// not go through their specifications.
struct TrendInputs {
  explicit TrendInputs(const std::vector<FeatureSpec>& specs) noexcept;

  static constexpr std::uint8_t kNone = 255;
  std::uint8_t depth = kNone;
  std::uint8_t velocity = kNone;
  std::uint8_t peak = kNone;
  std::uint8_t force_count = 0;
  std::array<std::uint8_t, kMaxFeatures> force{};  // features that are forces, in order
};

struct Trend {
  double reference_depth_m = 1.0;  // greatest recorded depth; u = d / reference_depth_m
  std::array<double, kElasticCoefficients> elastic_N{};             // E = sum e_k u^(k+1)
  bool has_elastic_knots = false;
  std::array<double, kDriveKnots> elastic_knot_N{};  // of a cubic spline, on top (engine/tick/rising_curve.h)
  std::array<double, kViscosityCoefficients> viscosity_Ns_per_m{};  // eta = sum c_k u^k, u <= 1
  std::array<double, kViscosityCoefficients> thinning_Ns_per_m{};   // mu, likewise
  double thinning_velocity_m_per_s = 1.0;                           // v_0
  double velocity_limit_m_per_s = 0.0;
  std::array<DriveCurve, kSofteningPowers.size()> softening{};  // S_j; counts with a fading_peak feature

  // `features` as `inputs`, or `specs`, name them. Returns newtons, any sign.
  double at(const double* features, const TrendInputs& inputs) const noexcept;
  double at(const double* features, const std::vector<FeatureSpec>& specs) const noexcept {
    return at(features, TrendInputs(specs));
  }
};

// v / (1 + |v| / v_0).
inline double thinned_velocity(double velocity_m_per_s, double thinning_velocity_m_per_s) noexcept {
  return velocity_m_per_s / (1.0 + std::abs(velocity_m_per_s) / thinning_velocity_m_per_s);
}

// (d / m)^p_j; 1 where m is not above d.
inline std::array<double, kSofteningPowers.size()> softening_shares(double depth_m, double peak_m) noexcept {
  const double x = depth_m < peak_m ? depth_m / peak_m : 1.0;
  const double x4 = x * x * x * x;
  return {x, x4, x4 * x4 * x4};
}

}  // namespace palpate
