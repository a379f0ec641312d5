#include "models/model/trend.h"

#include <algorithm>

#include "models/model/bernstein.h"

namespace palpate {
namespace {

double elastic_force_N(const Trend& trend, double u) noexcept {
  return rising_curve(trend.elastic_N, trend.has_elastic_knots ? &trend.elastic_knot_N : nullptr, u);
}

}  // namespace

TrendInputs::TrendInputs(const std::vector<FeatureSpec>& specs) noexcept {
  for (std::size_t i = 0; i < specs.size(); ++i) {
    const auto index = static_cast<std::uint8_t>(i);
    switch (specs[i].kind) {
      case FeatureKind::depth:
        depth = index;
        break;
      case FeatureKind::velocity:
        velocity = index;
        break;
      case FeatureKind::maxwell_branch:
      case FeatureKind::maxwell_spectrum:
      case FeatureKind::stops:
      case FeatureKind::creep:
        force[force_count++] = index;
        break;
      case FeatureKind::lowpass_velocity:
        break;  // the paper's features carry no stiffness
      case FeatureKind::surface_lag:
        break;  // the branches follow it
    }
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
  return elastic_force_N(*this, u) + polynomial(viscosity_Ns_per_m, inside) * speed +
         polynomial(thinning_Ns_per_m, inside) * thinned_velocity(speed, thinning_velocity_m_per_s) + branches_N;
}

}  // namespace palpate
