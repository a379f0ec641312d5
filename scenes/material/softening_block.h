// A foam that a press softens for later presses that are less deep, and that heals:
// the Mullins effect as pseudo-elasticity, with a deepest depth m that decays,
//   F = eta(s, m) E(s) + integral K(t - u) dE(s)/du du,
//   eta = 1 - r erf((W(m) - W(s)) / (w0 + beta W(m))),
//   m = s where s >= m,  dm/dt = -(m - s) / tau_heal otherwise,
//   E(s) = k s^1.5 (1 + (s / s0)^2),  W(s) = integral_0^s E.
// A first press follows E. A later press up to the depth m is softer by up to 15 %; the
// softening decays with the time constant tau_heal = 6 s.
// K is a weak box spectrum, 10 ms to 3 s.
// Passive: the stored energy is V = integral_0^s eta E ds + U(m) with U'(m) = -d/dm of that
// integral at s = m; healing releases at most the energy that a deeper press has stored.
// Source: Mullins (1969); Ogden & Roxburgh (1999), eq. 3.9 (eta); Diani, Fayolle
// & Gilormini (2009) (review; recovery with time).
#pragma once

#include <cmath>

#include "scenes/material/hereditary_block.h"

namespace palpate {

class SofteningBlock final : public HereditaryBlock {
 public:
  static constexpr double kStiffness_N_per_m1_5 = 5200.0;  // k
  static constexpr double kStiffening_m = 0.012;           // s0
  static constexpr double kSoftening = 0.15;               // r
  static constexpr double kSharpness_J = 1e-3;             // w0
  static constexpr double kSharpnessShare = 0.3;           // beta
  static constexpr double kHealing_s = 6.0;                // tau_heal
  static constexpr double kWeight = 0.03;                  // of the box spectrum, per unit of ln tau

  SofteningBlock() : HereditaryBlock(0.01, 3.0, [](double) { return kWeight; }) {}

  double elastic_force_N(double depth_m) const noexcept override {
    return kStiffness_N_per_m1_5 * depth_m * std::sqrt(depth_m) * (1.0 + stiffened(depth_m));
  }

 private:
  void prepare() noexcept override {
    HereditaryBlock::prepare();
    fade_ = std::exp(-substep_s() / kHealing_s);
  }
  void begin_substep() noexcept override {
    HereditaryBlock::begin_substep();
    deepest_m_ = surface_depth_m() + (deepest_m_ - surface_depth_m()) * fade_;
    if (deepest_m_ < 1e-12) deepest_m_ = 0.0;  // healed
    deepest_J_ = elastic_energy_J(deepest_m_);
  }
  double contact_force_N(double surface_m, double) const noexcept override {
    return hereditary_force_N(surface_m, softened(surface_m));
  }
  void update_state(double surface_m, bool touching) noexcept override {
    HereditaryBlock::update_state(surface_m, touching);
    if (surface_m > deepest_m_) deepest_m_ = surface_m;
  }
  void reset_state(double surface_m) noexcept override {
    HereditaryBlock::reset_state(surface_m);
    deepest_m_ = surface_m;
  }
  static double stiffened(double depth_m) noexcept {
    const double share = depth_m / kStiffening_m;
    return share * share;
  }
  // W(depth).
  static double elastic_energy_J(double depth_m) noexcept {
    return kStiffness_N_per_m1_5 * depth_m * depth_m * std::sqrt(depth_m) *
           (2.0 / 5.0 + 2.0 / 9.0 * stiffened(depth_m));
  }
  // eta at `surface_m`.
  double softened(double surface_m) const noexcept {
    if (surface_m >= deepest_m_) return 1.0;
    const double below_J = deepest_J_ - elastic_energy_J(surface_m);
    return 1.0 - kSoftening * std::erf(below_J / (kSharpness_J + kSharpnessShare * deepest_J_));
  }

  double deepest_m_ = 0.0;
  double deepest_J_ = 0.0;  // W(m)
  double fade_ = 1.0;       // exp(-h / tau_heal)
};

}  // namespace palpate
