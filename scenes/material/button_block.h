// A button: a shallow dome that snaps through. The dome is a von Mises truss, two legs of
// length L0 over a half span b that rise by h; a press of s shortens each of them by
//   e(s) = L0 - L(s),  L = sqrt(b^2 + (h - s)^2)
// and a leg pushes back along itself,
//   N = k e + z + f,  dz/dt = k_m de/dt - z / tau        rubber: a standard linear solid
//   df = K_h de, clamped to +-mu k e                     dry friction of its foot on the board
//   F = 2 N (h - s) / L + k_p s + c ds/dt + k_b max(0, s - s_b)^1.5
// k_p is the skirt, which restores the dome, c its damping; the last term is the contact with the floor (Hertz). Beyond
// a peak the force decreases with depth (the click) until the floor; z and f cause hysteresis.
// Passive: the work 2 N de goes into springs, dashpots and friction, which stores at most
// f^2 / (2 K_h); the kinematics are lossless.
// Source: von Mises (1923) (the truss); Bazant & Cedolin (2010), Stability of Structures, section 4.4 (snap-through).
#pragma once

#include <algorithm>
#include <cmath>

#include "scenes/material/block.h"

namespace palpate {

class ButtonBlock final : public Block {
 public:
  static constexpr double kRise_m = 0.0025;               // h
  static constexpr double kHalfSpan_m = 0.006;            // b
  static constexpr double kLeg_N_per_m = 8000.0;          // k
  static constexpr double kLegBranch_N_per_m = 2500.0;    // k_m
  static constexpr double kLegTime_s = 0.25;              // tau
  static constexpr double kFriction = 0.10;               // mu
  static constexpr double kPresliding_N_per_m = 40000.0;  // K_h
  static constexpr double kSkirt_N_per_m = 600.0;         // k_p
  static constexpr double kSkirt_Ns_per_m = 10.0;         // c
  static constexpr double kFloor_m = 0.005;               // s_b
  static constexpr double kFloor_N_per_m1_5 = 30000.0;    // k_b

  // The static force up to the first peak. Beyond the peak a force has several depths, so the result rises by 1 N/m;
  // deeper than h it is at least the static force.
  double half_relaxed_force_N(double depth_m) const noexcept override {
    const auto at_rest_N = [](double s) {
      return dome_N(s, (kLeg_N_per_m + 0.5 * kLegBranch_N_per_m) * shortened_m(s), 0.0);
    };
    constexpr double kStep_m = 2e-5;
    constexpr double kLeast_N_per_m = 1.0;
    double peak_m = 0.0;
    while (peak_m < kRise_m && at_rest_N(peak_m + kStep_m) > at_rest_N(peak_m)) peak_m += kStep_m;
    if (depth_m <= peak_m) return at_rest_N(depth_m);
    return std::max(at_rest_N(peak_m) + kLeast_N_per_m * (depth_m - peak_m),
                    depth_m < kRise_m ? 0.0 : at_rest_N(depth_m));
  }

 private:
  struct Leg {
    double shortened_m = 0.0, branch_N = 0.0, friction_N = 0.0;
  };
  void prepare() noexcept override { branch_ = MaxwellStep(substep_s(), kLegTime_s); }
  double contact_force_N(double surface_m, double rate_m_per_s) const noexcept override {
    const Leg leg = leg_at(surface_m);
    return dome_N(surface_m, kLeg_N_per_m * leg.shortened_m + leg.branch_N + leg.friction_N, rate_m_per_s);
  }
  void update_state(double surface_m, bool) noexcept override {
    leg_ = leg_at(surface_m);
    if (std::abs(leg_.branch_N) < kNoForce_N) leg_.branch_N = 0.0;
  }
  void reset_state(double surface_m) noexcept override { leg_ = {shortened_m(surface_m), 0.0, 0.0}; }

  Leg leg_at(double surface_m) const noexcept {
    Leg leg;
    leg.shortened_m = shortened_m(surface_m);
    const double change_m = leg.shortened_m - leg_.shortened_m;
    leg.branch_N = leg_.branch_N * branch_.decay + kLegBranch_N_per_m * change_m * branch_.gain;
    const double limit_N = kFriction * kLeg_N_per_m * std::max(0.0, leg.shortened_m);
    leg.friction_N = std::clamp(leg_.friction_N + kPresliding_N_per_m * change_m, -limit_N, limit_N);
    return leg;
  }
  static double leg_length_m(double surface_m) noexcept { return std::hypot(kHalfSpan_m, kRise_m - surface_m); }
  // e(s), in a form without cancellation that is exactly 0 for a flat surface.
  static double shortened_m(double surface_m) noexcept {
    return surface_m * (2.0 * kRise_m - surface_m) / (leg_length_m(0.0) + leg_length_m(surface_m));
  }
  // F for the force N along each leg.
  static double dome_N(double surface_m, double leg_N, double rate_m_per_s) noexcept {
    const double beyond_m = std::max(0.0, surface_m - kFloor_m);
    return 2.0 * leg_N * (kRise_m - surface_m) / leg_length_m(surface_m) + kSkirt_N_per_m * surface_m +
           kSkirt_Ns_per_m * rate_m_per_s + kFloor_N_per_m1_5 * beyond_m * std::sqrt(beyond_m);
  }
  Leg leg_;  // at the last surface
  MaxwellStep branch_;
};

}  // namespace palpate
