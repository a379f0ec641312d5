#include "models/model/trend.h"

#include <algorithm>

#include "models/model/bernstein.h"

namespace palpate {
namespace {

double elastic_force_N(const Trend& trend, double u) noexcept {
  const double inside = std::min(u, 1.0);
  double value = 0.0;
  double slope = 0.0;
  for (std::size_t k = kElasticCoefficients; k-- > 0;) {
    slope = slope * inside + static_cast<double>(k + 1) * trend.elastic_N[k];
    value = (value + trend.elastic_N[k]) * inside;
  }
  return u > 1.0 ? value + slope * (u - 1.0) : value;
}

}  // namespace

double Trend::at(const double* features, const std::vector<FeatureSpec>& specs) const noexcept {
  double depth_m = 0.0;
  double velocity_m_per_s = 0.0;
  double branches_N = 0.0;
  double peak_m = 0.0;
  bool softens = false;
  for (std::size_t i = 0; i < specs.size(); ++i) {
    switch (specs[i].kind) {
      case FeatureKind::depth: depth_m = features[i]; break;
      case FeatureKind::velocity: velocity_m_per_s = features[i]; break;
      case FeatureKind::maxwell_branch:
      case FeatureKind::maxwell_spectrum:
      case FeatureKind::stops: branches_N += features[i]; break;
      case FeatureKind::fading_peak:
        peak_m = features[i];
        softens = true;
        break;
      case FeatureKind::lowpass_velocity: break;  // the paper's features carry no stiffness
    }
  }
  if (softens) {
    const auto shares = softening_shares(depth_m, peak_m);
    for (std::size_t j = 0; j < shares.size(); ++j) branches_N += softening[j].at(depth_m) * shares[j];
  }
  const double u = depth_m / reference_depth_m;
  const double speed = std::clamp(velocity_m_per_s, -velocity_limit_m_per_s, velocity_limit_m_per_s);
  const double inside = std::min(u, 1.0);
  return elastic_force_N(*this, u) + polynomial(viscosity_Ns_per_m, inside) * speed +
         polynomial(thinning_Ns_per_m, inside) * thinned_velocity(speed, thinning_velocity_m_per_s) + branches_N;
}

}  // namespace palpate
