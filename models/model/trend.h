// The trend: a nonlinear viscoelastic solid fitted to the recording, which the
// radial basis functions correct near the data and which stands alone away
// from it.
//
//   T(x) = E(d) + eta(d) v + mu(d) v / (1 + |v| / v_0) + sum_b z_b + sum y
//
// d depth, v velocity, z_b the force of Maxwell branch b (engine/tick/features.h),
// all taken from the feature vector; v_0 is the recording's RMS velocity, so
// that the two viscous terms together follow a viscosity that falls with speed.
// z_b also of a maxwell_spectrum, y the force of bristles, stops and those that creep. E
// rises with depth, eta, mu and the stiffnesses of branches and bristles are never negative
// (the fit enforces it), so that the trend stores and dissipates energy and makes none. A scene without velocity or
// branches has the terms that it has features for; position alone leaves E(d).
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
#include "models/model/elastic_spline.h"

namespace palpate {

inline constexpr std::size_t kViscosityCoefficients = 3;

// Where the trend finds its terms among the features: made once, so that a tick does
// not go through their specifications.
struct TrendInputs {
  explicit TrendInputs(const std::vector<FeatureSpec>& specs) noexcept;

  static constexpr std::uint8_t kNone = 255;
  std::uint8_t depth = kNone;
  std::uint8_t velocity = kNone;
  std::uint8_t force_count = 0;
  std::array<std::uint8_t, kMaxFeatures> force{};  // features that are forces, in order
};

struct Trend {
  double reference_depth_m = 1.0;  // greatest recorded depth; u = d / reference_depth_m
  ElasticSpline elastic;           // E
  std::array<double, kViscosityCoefficients> viscosity_Ns_per_m{};  // eta = sum c_k u^k, u <= 1
  std::array<double, kViscosityCoefficients> thinning_Ns_per_m{};   // mu, likewise
  double thinning_velocity_m_per_s = 1.0;                           // v_0
  double velocity_limit_m_per_s = 0.0;

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

}  // namespace palpate
