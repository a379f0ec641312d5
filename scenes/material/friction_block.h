// A soft block that grips the probe: a neo-Hookean contact with weak relaxation, and dry
// friction at the side of the probe, modelled by bristles that bend elastically and then
// slip (Dahl). The number of bristles is proportional to the depth, up to 4 mm:
//   F = E(s) + integral K(t - u) dE(s)/du du + F_c(s) z     never below 0
//   dz/ds = (1 - z sgn(ds)) / x_p                            presliding, then slip
//   F_c(s) = F_c min(1, s / d_c)
// On the way in new bristles are unbent and do not change F_c(s) z; on the way out bristles
// leave with their share of the force. Friction that holds the probe back does not exceed the
// force that pushes it out, so that the block does not grip it. A free surface has no friction.
// F_c = 0.35 N, x_p = 0.1 mm, d_c = 4 mm; sphere of 10 mm radius, 12 kPa; K is a box spectrum from 50 ms to 2 s.
// Passive: at most V = F_c(s) x_p z^2 / 2 is stored, and F_c z ds - dV >= z^2 F_c |ds| on the
// way in, more on the way out.
// Source: Dahl (1968); Canudas de Wit, Olsson, Astrom & Lischinsky (1995)
// (bristles, presliding); Okamura, Simone & O'Leary (2004) (friction of soft tissue along a probe).
#pragma once

#include <algorithm>
#include <cmath>

#include "scenes/material/hereditary_block.h"

namespace palpate {

class FrictionBlock final : public HereditaryBlock {
 public:
  static constexpr SphereContact kContact = {.radius_m = 0.01, .modulus_Pa = 12e3};
  static constexpr double kFriction_N = 0.35;    // F_c
  static constexpr double kPresliding_m = 1e-4;  // x_p
  static constexpr double kGripped_m = 0.004;    // d_c
  static constexpr double kWeight = 0.03;        // of the box spectrum, per unit of ln tau

  FrictionBlock() : HereditaryBlock(kContact, 0.05, 2.0, kWeight) {}

  // F_c(depth), newtons: the largest friction.
  static double friction_limit_N(double depth_m) noexcept { return kFriction_N * std::min(1.0, depth_m / kGripped_m); }

 private:
  double contact_force_N(double surface_m, double) const noexcept override {
    return hereditary_force_N(surface_m) + friction_after_N(surface_m);
  }
  double free_force_N(double surface_m, double) const noexcept override { return hereditary_force_N(surface_m); }
  void update_state(double surface_m, bool touching) noexcept override {
    const double limit_N = friction_limit_N(surface_m);
    const double friction_N = std::max(friction_after_N(surface_m), -hereditary_force_N(surface_m));
    bend_ = touching && limit_N > kNoForce_N ? std::clamp(friction_N / limit_N, -1.0, 1.0) : 0.0;
    HereditaryBlock::update_state(surface_m, touching);
  }
  void reset_state(double surface_m) noexcept override {
    HereditaryBlock::reset_state(surface_m);
    bend_ = 0.0;
  }
  // F_c(s) z after the probe has moved to `surface_m`, exact for each bristle.
  double friction_after_N(double surface_m) const noexcept {
    const double travel_m = surface_m - surface_depth_m();
    const double side = travel_m < 0.0 ? -1.0 : 1.0;
    const double slipped = -std::expm1(-std::abs(travel_m) / kPresliding_m);
    const double bend = bend_ + (side - bend_) * slipped;
    // Bristles that are added in this sub-step are unbent.
    return bend * friction_limit_N(std::min(surface_m, surface_depth_m()));
  }

  double bend_ = 0.0;  // z, -1 .. 1
};

}  // namespace palpate
