#include "models/model/trend.h"

#include <algorithm>

#include "models/model/bernstein.h"

namespace palpate {

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
