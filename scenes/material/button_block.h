// A button: a shallow dome that snaps through. The dome is a von Mises truss, two legs of
// length L0 over a half span b that rise by h; a press of s shortens each of them by
//   e(s) = L0 - L(s),  L = sqrt(b^2 + (h - s)^2)
// and a leg pushes back along itself,
//   N = k e + z + f,  dz/dt = k_m de/dt - z / tau        rubber: a standard linear solid
//   df = K_h de, held within +-mu k e                    its foot slides on the board, dry
//   F = 2 N (h - s) / L + k_p s + c ds/dt + k_b max(0, s - s_b)^1.5
// k_p is the skirt, which brings the dome back, c its damping, the last the floor that the
// dome meets (Hertz). Beyond a peak the force falls although the press goes on, a click,
// until the floor; the way back is another one, by z and f.
// Passive: N does the work 2 N de, in springs, dashpots and a friction of which at most
// f^2 / (2 K_h) is stored; the geometry makes no energy.
// Source: von Mises (1923) (the truss); Bazant & Cedolin (2010), Stability of Structures,
// section 4.4 (snap-through).
#pragma once

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

  // Where a hand aims: what the press met at most on its way there, for beyond the peak no
  // force belongs to one depth.
  double held_force_N(double depth_m) const noexcept override;
  double relaxed_force_N(double depth_m) const noexcept override;
  std::string relaxation_times_text() const override { return "0.25 s; dry friction"; }

 private:
  struct Leg {
    double shortened_m = 0.0, branch_N = 0.0, friction_N = 0.0;
  };
  void prepare() noexcept override;
  double contact_force_N(double surface_m, double rate_m_per_s) const noexcept override;
  void settle(double surface_m, bool touching) noexcept override;
  void forget(double surface_m) noexcept override;
  Leg leg_at(double surface_m) const noexcept;

  Leg leg_;  // at the last surface
  double branch_decay_ = 1.0, branch_gain_ = 1.0;
};

}  // namespace palpate
