#include "scenes/material/sphere_contact.h"

#include <algorithm>
#include <cmath>

namespace palpate {

double SphereContact::force_N(double depth_m) const noexcept {
  const double contact_m2 = radius_m * depth_m;
  const double stretch = std::max(0.5, 1.0 - 0.2 * std::sqrt(contact_m2) / radius_m);
  const double inverse = 1.0 / stretch;
  const double neo_N = 80.0 / 27.0 * modulus_Pa * contact_m2 * (inverse * inverse - stretch);
  if (stiffening == 0.0) return neo_N;
  return neo_N * std::exp(stiffening * (stretch * stretch + 2.0 * inverse - 3.0));
}

}  // namespace palpate
