// A foam that softens below its deepest press and heals: the Mullins effect as
// pseudo-elasticity, with a deepest depth that fades,
//   F = eta(s, m) E(s) + integral K(t - u) dE(s)/du du,
//   eta = 1 - r erf((W(m) - W(s)) / (w0 + beta W(m))),
//   m = s while s is the deepest,  dm/dt = -(m - s) / tau_heal otherwise,
// W the energy under E. A first press follows E; what comes after, up to the
// deepest recent depth m, is softer by up to 15 %, and 6 s later mostly healed.
// K is a weak box spectrum, 10 ms to 3 s.
//   E(s) = k s^1.5 (1 + (s / s0)^2)
// Passive: the stored energy V = integral_0^s eta E ds + U(m) with
// U'(m) = -d/dm of that integral at s = m; pressing deeper pays for the damage
// what healing may give back, at most.
// Source: Mullins (1969); Ogden & Roxburgh (1999), eq. 3.9 (eta); Diani, Fayolle
// & Gilormini (2009) (review; recovery with time).
#pragma once

#include "scenes/material/block.h"
#include "scenes/material/relaxation_spectrum.h"

namespace palpate {

class SofteningBlock final : public Block {
 public:
  static constexpr double kStiffness_N_per_m1_5 = 5200.0;  // k
  static constexpr double kStiffening_m = 0.012;           // s0
  static constexpr double kSoftening = 0.15;               // r
  static constexpr double kSharpness_J = 1e-3;             // w0
  static constexpr double kSharpnessShare = 0.3;           // beta
  static constexpr double kHealing_s = 6.0;                // tau_heal
  static constexpr double kWeight = 0.03;                  // of the box spectrum, per unit of ln tau

  SofteningBlock();
  double held_force_N(double depth_m) const noexcept override;
  double relaxed_force_N(double depth_m) const noexcept override;
  std::string relaxation_times_text() const override;

  // m, metres.
  double deepest_recent_m() const noexcept { return deepest_m_; }

 private:
  void prepare() noexcept override;
  void begin_substep() noexcept override;
  double contact_force_N(double surface_m, double rate_m_per_s) const noexcept override;
  void settle(double surface_m, bool touching) noexcept override;
  void forget(double surface_m) noexcept override;
  double softened(double surface_m) const noexcept;

  RelaxationSpectrum spectrum_;
  double elastic_N_ = 0.0;  // E at the last surface
  double deepest_m_ = 0.0;
  double deepest_J_ = 0.0;  // W(m)
  double fade_ = 1.0;       // exp(-h / tau_heal)
};

}  // namespace palpate
