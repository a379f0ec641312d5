// The bound on the error of a model's force where no force is measured, at 95 %:
//   b(x) = floor + per_force |f(x)| + per_distance max(0, distance(x) - inner radius) >= |model - material|
// f: the model's force; distance: to the nearest training data in the normalised feature space (domain_guard.h). The
// coefficients are fitted to cross-validated errors and scaled by split-conformal prediction, with the quantile of the
// normalised errors (models/fit/bound_calibration.h).
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

  // `force_N`: absolute; `distance`: beyond the inner radius, normalised. An infinite distance gives an infinite
  // bound.
  double at(double force_N, double distance) const noexcept {
    return floor_N + per_force * force_N + per_distance_N * std::max(0.0, distance);
  }
};

}  // namespace palpate
