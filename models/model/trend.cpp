#include "models/model/trend.h"

#include <algorithm>

namespace palpate {
namespace {

constexpr double kPieces = kElasticPieces;

using Quadratic = std::array<double, 3>;  // coefficients of t^0 to t^2 of a piece

// The three quadratic B-splines that are not 0 on a piece, N_piece to N_piece+2. The knots at the ends are threefold.
std::array<Quadratic, 3> b_splines(std::size_t piece) {
  const double first = piece == 0 ? 1.0 : 0.5;
  const double last = piece + 1 == kElasticPieces ? 1.0 : 0.5;
  return {{{first, -2.0 * first, first}, {1.0 - first, 2.0 * first, -first - last}, {0.0, 0.0, last}}};
}

}  // namespace

double ElasticSpline::at(double u) const noexcept {
  const double x = u * kPieces;
  const std::size_t piece = x < kPieces ? static_cast<std::size_t>(std::max(0.0, x)) : kElasticPieces - 1;
  const double* c = pieces_N.data() + piece * kElasticCoefficients;
  const double beyond = x > kPieces ? x - kPieces : 0.0;
  const double t = x - static_cast<double>(piece) - beyond;
  const double value = c[0] + t * (c[1] + t * (c[2] + t * c[3]));
  return value + beyond * (c[1] + t * (2.0 * c[2] + t * 3.0 * c[3]));
}

std::vector<ElasticSpline> spline_basis() {
  std::vector<ElasticSpline> basis(kElasticTerms);
  for (std::size_t i = 0; i < kElasticTerms; ++i) {
    double sum = 0.0;
    for (std::size_t piece = 0; piece < kElasticPieces; ++piece) {
      double* c = basis[i].pieces_N.data() + piece * kElasticCoefficients;
      c[0] = sum;
      if (i < piece || i > piece + 2) continue;
      const Quadratic spline = b_splines(piece)[i - piece];
      // The integral over u.
      for (std::size_t k = 0; k < spline.size(); ++k) {
        c[k + 1] = spline[k] / (static_cast<double>(k + 1) * kPieces);
      }
      sum += c[1] + c[2] + c[3];
    }
  }
  return basis;
}

ElasticSpline combined_spline(const std::vector<ElasticSpline>& basis, const double* weights) {
  ElasticSpline sum;
  for (std::size_t i = 0; i < basis.size(); ++i) {
    for (std::size_t j = 0; j < sum.pieces_N.size(); ++j) sum.pieces_N[j] += weights[i] * basis[i].pieces_N[j];
  }
  return sum;
}

ElasticSpline spline_from_powers(const std::array<double, 3>& power_N, const std::array<double, 7>& knot_N) {
  ElasticSpline spline;
  for (std::size_t piece = 0; piece < kElasticPieces; ++piece) {
    const double u = static_cast<double>(piece) / kPieces;
    double value = u * (power_N[0] + u * (power_N[1] + u * power_N[2]));
    double slope = power_N[0] + u * (2.0 * power_N[1] + u * 3.0 * power_N[2]);
    double half_curvature = power_N[1] + 3.0 * u * power_N[2];
    double cubic = power_N[2];
    for (std::size_t k = 0; k < knot_N.size(); ++k) {
      const double above = u - static_cast<double>(k + 1) / 8.0;
      if (above < 0.0) continue;
      value += knot_N[k] * above * above * above;
      slope += 3.0 * knot_N[k] * above * above;
      half_curvature += 3.0 * knot_N[k] * above;
      cubic += knot_N[k];
    }
    double* c = spline.pieces_N.data() + piece * kElasticCoefficients;
    c[0] = value;
    c[1] = slope / kPieces;
    c[2] = half_curvature / (kPieces * kPieces);
    c[3] = cubic / (kPieces * kPieces * kPieces);
  }
  return spline;
}

TrendInputs::TrendInputs(const std::vector<FeatureSpec>& specs) noexcept {
  for (std::size_t i = 0; i < specs.size(); ++i) {
    const auto index = static_cast<std::uint8_t>(i);
    // Low-pass features have no force, and the branches already follow the surface_lag.
    const FeatureKind kind = specs[i].kind;
    if (kind == FeatureKind::depth) depth = index;
    if (kind == FeatureKind::velocity) velocity = index;
    if (is_branch(kind) || is_bristle(kind)) force[force_count++] = index;
  }
}

double Trend::at(const double* features, const TrendInputs& inputs) const noexcept {
  const double depth_m = inputs.depth != TrendInputs::kNone ? features[inputs.depth] : 0.0;
  const double velocity_m_per_s = inputs.velocity != TrendInputs::kNone ? features[inputs.velocity] : 0.0;
  double branches_N = 0.0;
  for (std::size_t b = 0; b < inputs.force_count; ++b) branches_N += features[inputs.force[b]];
  const double u = depth_m / reference_depth_m;
  const double speed = std::clamp(velocity_m_per_s, -velocity_limit_m_per_s, velocity_limit_m_per_s);
  const double inside = std::min(u, 1.0);
  return elastic.at(u) + polynomial(viscosity_Ns_per_m, inside) * speed +
         polynomial(thinning_Ns_per_m, inside) * thinned_velocity(speed, thinning_velocity_m_per_s) + branches_N;
}

}  // namespace palpate
