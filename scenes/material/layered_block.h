// A soft block with a stiff inclusion 6 mm down: a lump under the skin. The soft
// top is a neo-Hookean contact that relaxes; once the tool has come as deep as
// the inclusion, it meets it as well, and the inclusion floats on a support that
// is a spring and a Maxwell branch (a standard linear solid), in series with it:
//   F   = E(s) + integral K(t - u) dE(s)/du du + F_i
//   F_i = k_i max(0, s - g - y)^1.5                       Hertz, tool on inclusion
//   F_i = k_s y + z,   dz/dt = k_m dy/dt - z / tau_m       the support, y its depth
// K is a box spectrum, 20 ms to 4 s. y is solved for at the end of each sub-step
// (implicit Euler with the exact Maxwell step).
// Passive: springs, dashpots and a contact that only pushes, in series and beside
// each other; implicit Euler only loses energy.
// Source: Hertz (1882); Lin et al. (2009) (soft top); stiffness ratio of about
// ten, as of breast tumours: Samani, Zubovits & Plewes (2007).
#pragma once

#include "scenes/material/block.h"
#include "scenes/material/relaxation_spectrum.h"
#include "scenes/material/sphere_contact.h"

namespace palpate {

class LayeredBlock final : public Block {
 public:
  static constexpr SphereContact kTop = {.radius_m = 0.01, .modulus_Pa = 14e3};
  static constexpr double kGap_m = 0.006;                   // g
  static constexpr double kInclusion_N_per_m1_5 = 90000.0;  // k_i
  static constexpr double kSupport_N_per_m = 3000.0;        // k_s
  static constexpr double kSupportBranch_N_per_m = 2000.0;  // k_m
  static constexpr double kSupportTime_s = 0.3;             // tau_m
  static constexpr double kWeight = 0.06;                   // of the box spectrum, per unit of ln tau

  LayeredBlock();
  double held_force_N(double depth_m) const noexcept override;
  double relaxed_force_N(double depth_m) const noexcept override;
  std::string relaxation_times_text() const override;

  double inclusion_depth_m() const noexcept { return inclusion_m_; }

 private:
  void prepare() noexcept override;
  void begin_substep() noexcept override { spectrum_.relax(); }
  double contact_force_N(double surface_m, double rate_m_per_s) const noexcept override;
  void settle(double surface_m, bool touching) noexcept override;
  void forget(double surface_m) noexcept override;
  double inclusion_after_m(double surface_m) const noexcept;
  static double balance_m(double surface_m, double slope_N_per_m, double offset_N, double guess_m) noexcept;

  RelaxationSpectrum spectrum_;
  double elastic_N_ = 0.0;    // E at the last surface
  double inclusion_m_ = 0.0;  // y
  double branch_N_ = 0.0;     // z
  double branch_decay_ = 1.0, branch_gain_ = 1.0;
};

}  // namespace palpate
