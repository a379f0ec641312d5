// Soft tissue under a sphere: an elastic response that stiffens exponentially, and relaxation by a power law of time,
// which has no characteristic time,
//   F = integral G(t - u) dE(s)/du du,  G(t) = (1 - p) + p (t / 1 s)^-alpha,
// where E is the force 1 s after a step, the Fung contact of sphere_contact.h. The power law is a spring-pot (a
// fractional derivative) and is integrated as the spectrum
//   t^-alpha = 1 / Gamma(alpha) integral tau^-alpha exp(-t / tau) dln tau
// for tau from 0.1 ms to 1,000 s. Slower parts do not relax within a recording and are treated as elastic; faster
// parts relax within a tick and are omitted.
// Sphere of 8 mm radius; 25 kPa and b = 3; alpha = 0.15, in the range of liver and kidney (0.1 to 0.2).
// Passive: see hereditary_block.h.
// Source: Kiss, Varghese & Hall (2004) (liver as a fractional solid); Nicolle,
// Vezin & Palierne (2010) (kidney's power law); Lin et al. (2009) (contact).
#pragma once

#include <cmath>

#include "scenes/material/hereditary_block.h"
#include "scenes/material/sphere_contact.h"

namespace palpate {

class TissueBlock final : public HereditaryBlock {
 public:
  static constexpr SphereContact kContact = {.radius_m = 0.008, .modulus_Pa = 25e3, .stiffening = 3.0};
  static constexpr double kShortest_s = 1e-4;
  static constexpr double kLongest_s = 1000.0;
  static constexpr double kExponent = 0.15;         // alpha
  static constexpr double kFractionalShare = 0.45;  // p

  TissueBlock() : HereditaryBlock(kShortest_s, kLongest_s, density) {}

  double elastic_force_N(double depth_m) const noexcept override { return kContact.force_N(depth_m); }
  double half_relaxed_force_N(double depth_m) const noexcept override { return kContact.force_N(depth_m); }

 private:
  // The density of the power law, per unit of ln tau.
  static double density(double time_s) {
    return kFractionalShare * std::pow(time_s, -kExponent) / std::tgamma(kExponent);
  }
  double contact_force_N(double surface_m, double) const noexcept override {
    return hereditary_force_N(surface_m, held_share_);
  }

  // The elastic share of E: 1 - p plus the integral of the density beyond the longest time.
  double held_share_ = 1.0 - kFractionalShare + density(kLongest_s) / kExponent;
};

}  // namespace palpate
