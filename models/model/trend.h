// The trend, a nonlinear viscoelastic solid fitted to the recordings; away from the data it is the model.
//   T(x) = E(d) + eta(d) v + mu(d) v / (1 + |v| / v_0) + sum_b z_b + sum_k y_k
// d: depth, v: velocity, z_b: force of a Maxwell spectrum, y_k: force of stops and creeping bristles; all are features
// (engine/tick/features.h). E increases with depth, and eta, mu and the stiffnesses of branches and bristles are not
// negative, so that the trend is passive. v is clamped to velocity_limit.
// Thread guarantee: value types; `at` is wait-free and allocates nothing.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/tick/features.h"

namespace palpate {

// Enough for a force that grows thirty-fold in the last tenth of the depth. The penalty determines the smoothness.
inline constexpr std::size_t kElasticPieces = 32;
inline constexpr std::size_t kElasticCoefficients = 4;  // of a piece

inline constexpr std::size_t kViscosityCoefficients = 3;

// The source text that exported models share with the library.
namespace trend_equation {
using real = double;
using motion_filter::larger;
using motion_filter::smaller;
static_assert(kViscosityCoefficients == 3 && kElasticCoefficients == 4);
#define R(x) (x)
#define ELASTIC_PIECES kElasticPieces
#include "models/model/trend.inc"
#undef ELASTIC_PIECES
#undef R
}  // namespace trend_equation

// The elastic response, a cubic spline on equal pieces of the recorded depth,
//   E(u) = sum_j c_ij t^j,  i = floor(n u),  t = n u - i,  n = kElasticPieces,
// with u = depth / reference depth >= 0. Beyond u = 1 it continues along its tangent there. An evaluation takes one
// look-up and one polynomial, independent of the number of pieces.
struct ElasticSpline {
  // The coefficients of t^0 to t^3 of every piece, N.
  std::array<double, kElasticPieces * kElasticCoefficients> pieces_N{};

  double at(double u) const noexcept { return trend_equation::elastic_at(pieces_N.data(), u); }
  bool operator==(const ElasticSpline&) const = default;
};

// The kElasticTerms basis splines are the integrals from 0 to u of the quadratic B-splines on the pieces. E therefore
// increases if all weights, in newtons, are non-negative. With a penalty on the differences of neighbouring weights it
// is a P-spline (Eilers & Marx 1996).
inline constexpr std::size_t kElasticTerms = kElasticPieces + 2;
std::vector<ElasticSpline> spline_basis();
ElasticSpline combined_spline(const std::vector<ElasticSpline>& basis, const double* weights);

// The indices of the trend's inputs among the features, determined once outside the tick.
struct TrendInputs {
  explicit TrendInputs(const std::vector<FeatureSpec>& specs) noexcept;

  static constexpr std::uint8_t kNone = 255;
  std::uint8_t depth = kNone;
  std::uint8_t velocity = kNone;
  std::uint8_t force_count = 0;
  std::array<std::uint8_t, kMaxFeatures> force{};  // indices of features that are forces, ascending
};

struct Trend {
  double reference_depth_m = 1.0;  // greatest recorded depth; u = d / reference_depth_m
  ElasticSpline elastic;           // E
  std::array<double, kViscosityCoefficients> viscosity_Ns_per_m{};  // eta = sum c_k u^k, u <= 1
  std::array<double, kViscosityCoefficients> thinning_Ns_per_m{};   // mu, in the same way
  double thinning_velocity_m_per_s = 1.0;                           // v_0
  double velocity_limit_m_per_s = 0.0;

  // T(x) in newtons, of any sign. `inputs`, or `specs`: of the list of features.
  double at(const double* features, const TrendInputs& inputs) const noexcept;
  double at(const double* features, const std::vector<FeatureSpec>& specs) const noexcept {
    return at(features, TrendInputs(specs));
  }
};

}  // namespace palpate
