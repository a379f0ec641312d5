// A rigid sphere pressed into a soft half-space at large strain: with the contact radius a = sqrt(R d) of Hertz and
// the representative stretch lambda = 1 - 0.2 a / R under the sphere,
//   F(d) = B a^2 (lambda^-2 - lambda),
// a neo-Hookean solid. For small d it is Hertz's law, F = (16/9) E sqrt(R) d^1.5 with B = (80/27) E. F rises with d
// everywhere. The stretch is limited to at least 0.5, which is reached at a depth of six radii.
// Source: Lin, Dimitriadis & Horkay (2009), "Spherical indentation of soft matter beyond the Hertzian regime", the
// neo-Hookean line; Hertz (1882).
// Thread guarantee: immutable; wait-free.
#pragma once

#include <algorithm>
#include <cmath>

namespace palpate {

struct SphereContact {
  double radius_m = 0.01;   // R > 0
  double modulus_Pa = 0.0;  // E >= 0, Young's modulus of the incompressible solid at rest

  // F(depth), newtons; depth_m >= 0.
  double force_N(double depth_m) const noexcept {
    const double contact_m2 = radius_m * depth_m;
    const double stretch = std::max(0.5, 1.0 - 0.2 * std::sqrt(contact_m2) / radius_m);
    const double inverse = 1.0 / stretch;
    return 80.0 / 27.0 * modulus_Pa * contact_m2 * (inverse * inverse - stretch);
  }
};

}  // namespace palpate
