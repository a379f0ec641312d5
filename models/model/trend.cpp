#include "models/model/trend.h"

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
      for (std::size_t k = 0; k < spline.size(); ++k) c[k + 1] = spline[k] / (static_cast<double>(k + 1) * kPieces);
      sum += c[1] + c[2] + c[3];
    }
  }
  return basis;
}

ElasticSpline combined_spline(const std::vector<ElasticSpline>& basis, const double* weights) {
  ElasticSpline sum;
  for (std::size_t i = 0; i < basis.size(); ++i)
    for (std::size_t j = 0; j < sum.pieces_N.size(); ++j) sum.pieces_N[j] += weights[i] * basis[i].pieces_N[j];
  return sum;
}

TrendInputs::TrendInputs(const std::vector<FeatureSpec>& specs) noexcept {
  for (std::size_t i = 0; i < specs.size(); ++i) {
    const auto index = static_cast<std::uint8_t>(i);
    // Low-pass features have no force.
    const FeatureKind kind = specs[i].kind;
    if (kind == FeatureKind::depth) depth = index;
    if (kind == FeatureKind::velocity) velocity = index;
    if (is_branch(kind) || is_bristle(kind)) force[force_count++] = index;
  }
}

double Trend::at(const double* features, const TrendInputs& inputs) const noexcept {
  const double depth_m = inputs.depth != TrendInputs::kNone ? features[inputs.depth] : 0.0;
  const double velocity_m_per_s = inputs.velocity != TrendInputs::kNone ? features[inputs.velocity] : 0.0;
  double memory_N = 0.0;
  for (std::size_t b = 0; b < inputs.force_count; ++b) memory_N += features[inputs.force[b]];
  return trend_equation::trend_at(elastic.pieces_N.data(), viscosity_Ns_per_m.data(), thinning_Ns_per_m.data(),
                                  thinning_velocity_m_per_s, depth_m / reference_depth_m, velocity_m_per_s,
                                  velocity_limit_m_per_s, memory_N);
}

}  // namespace palpate
