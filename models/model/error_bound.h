// How wrong a model's force may be, where no measured force says so: the 95 % bound
//   b(x) = floor + per_force f(x) + per_distance max(0, distance(x) - inner radius)
// on |model - material|. f: the model's force; distance: from the nearest training
// data in the normalised feature space (domain_guard.h). The shape follows the errors
// on strokes (recordings) left out of the fit, the scale is split-conformal: the
// quantile of the normalised errors there (models/fit/decide_strength.h).
// Sources: Vovk, Gammerman & Shafer (2005), "Algorithmic learning in a random world";
// Lei, G'Sell, Rinaldo, Tibshirani & Wasserman (2018), section 5.2 (locally weighted).
// Thread guarantee: value type; `at` is wait-free.
#pragma once

#include <algorithm>

namespace palpate {

struct ErrorBound {
  double floor_N = 0.0;
  double per_force = 0.0;
  double per_distance_N = 0.0;

  // `distance`: beyond the inner radius, normalised; infinite gives an infinite bound.
  double at(double force_N, double distance) const noexcept {
    return floor_N + per_force * force_N + per_distance_N * std::max(0.0, distance);
  }
};

}  // namespace palpate
