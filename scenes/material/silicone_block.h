// Soft silicone rubber under a sphere: a neo-Hookean contact at large strain with
// a continuous spectrum of relaxation times,
//   F = E(s) + integral K(t - u) dE(s)/du du,
//   K(t) = c (E1(t / tau2) - E1(t / tau1)),
// where E is the contact law of sphere_contact.h and K is Fung's box spectrum: the same weight c for every ln tau
// between tau1 and tau2. The material has no discrete relaxation times that a fit could identify, and E ~ d^1.5 at
// the surface is no polynomial.
// Sphere of 10 mm radius; relaxed Young's modulus 25 kPa, as the softest platinum-cured silicones. The instantaneous
// force is 1.6 times the relaxed one.
// Passive: see hereditary_block.h.
// Source: Fung (1993), Biomechanics, section 7.6.
#pragma once

#include "scenes/material/hereditary_block.h"
#include "scenes/material/sphere_contact.h"

namespace palpate {

class SiliconeBlock final : public HereditaryBlock {
 public:
  static constexpr SphereContact kContact = {.radius_m = 0.01, .modulus_Pa = 25e3};
  static constexpr double kShortest_s = 0.001;  // tau1
  static constexpr double kLongest_s = 30.0;    // tau2
  static constexpr double kWeight = 0.06;       // c

  SiliconeBlock() : HereditaryBlock(kShortest_s, kLongest_s, [](double) { return kWeight; }) {}

  double elastic_force_N(double depth_m) const noexcept override { return kContact.force_N(depth_m); }
};

}  // namespace palpate
