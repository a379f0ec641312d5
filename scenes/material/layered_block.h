// A soft block with a stiff inclusion at a depth of 6 mm, as a lump under the skin. The soft top is a neo-Hookean
// contact that relaxes. Deeper than the inclusion the tool also presses on the inclusion, in series with its
// support of a spring and a Maxwell branch (a standard linear solid):
//   F   = E(s) + integral K(t - u) dE(s)/du du + F_i
//   F_i = k_i max(0, s - g - y)^1.5                       Hertz, tool on inclusion
//   F_i = k_s y + z,   dz/dt = k_m dy/dt - z / tau_m       the support, y its depth
// K is a box spectrum, 20 ms to 4 s. y is the solution at the end of each sub-step (implicit Euler with the exact
// Maxwell step).
// Passive: springs, dashpots and a contact that only pushes, in series and in parallel; implicit Euler dissipates.
// Source: Hertz (1882); Lin et al. (2009) (soft top); Samani, Zubovits & Plewes (2007) (stiffness ratio of about
// ten, as of breast tumours).
#pragma once

#include <algorithm>
#include <cmath>

#include "scenes/material/hereditary_block.h"

namespace palpate {

class LayeredBlock final : public HereditaryBlock {
 public:
  static constexpr SphereContact kTop = {.radius_m = 0.01, .modulus_Pa = 14e3};
  static constexpr double kGap_m = 0.006;                   // g
  static constexpr double kInclusion_N_per_m1_5 = 90000.0;  // k_i
  static constexpr double kSupport_N_per_m = 3000.0;        // k_s
  static constexpr double kSupportBranch_N_per_m = 2000.0;  // k_m
  static constexpr double kSupportTime_s = 0.3;             // tau_m
  static constexpr double kWeight = 0.06;                   // of the box spectrum, per unit of ln tau

  LayeredBlock() : HereditaryBlock(kTop, 0.02, 4.0, kWeight) {}

  double half_relaxed_force_N(double depth_m) const noexcept override {
    constexpr double kHalfRelaxed_N_per_m = kSupport_N_per_m + 0.5 * kSupportBranch_N_per_m;
    return HereditaryBlock::half_relaxed_force_N(depth_m) +
           kHalfRelaxed_N_per_m * balance_m(depth_m, kHalfRelaxed_N_per_m, 0.0, 0.0);
  }
  double inclusion_depth_m() const noexcept { return inclusion_m_; }

 private:
  void prepare() noexcept override {
    HereditaryBlock::prepare();
    support_ = MaxwellStep(substep_s(), kSupportTime_s);
  }
  double contact_force_N(double surface_m, double) const noexcept override {
    const double squeezed_m = surface_m - kGap_m - inclusion_after_m(surface_m);
    const double inclusion_N = squeezed_m > 0.0 ? kInclusion_N_per_m1_5 * squeezed_m * std::sqrt(squeezed_m) : 0.0;
    return hereditary_force_N(surface_m) + inclusion_N;
  }
  void update_state(double surface_m, bool touching) noexcept override {
    HereditaryBlock::update_state(surface_m, touching);
    const double inclusion_m = inclusion_after_m(surface_m);
    branch_N_ = branch_N_ * support_.decay + kSupportBranch_N_per_m * support_.gain * (inclusion_m - inclusion_m_);
    if (std::abs(branch_N_) < kNoForce_N) branch_N_ = 0.0;
    inclusion_m_ = std::abs(inclusion_m) < 1e-30 ? 0.0 : inclusion_m;
  }
  void reset_state(double surface_m) noexcept override {
    HereditaryBlock::reset_state(surface_m);
    inclusion_m_ = balance_m(surface_m, kSupport_N_per_m, 0.0, 0.0);
    branch_N_ = 0.0;
  }

  double inclusion_after_m(double surface_m) const noexcept {
    const double branch_N_per_m = kSupportBranch_N_per_m * support_.gain;
    return balance_m(surface_m, kSupport_N_per_m + branch_N_per_m,
                     branch_N_ * support_.decay - branch_N_per_m * inclusion_m_, inclusion_m_);
  }
  // Solves k_i max(0, s - g - y)^1.5 = slope y + offset for y by Newton's method. The difference of both sides
  // decreases with y and is convex, so that Newton steps approach the root from below; each is clamped to the range
  // from the y of an open contact to s - g.
  static double balance_m(double surface_m, double slope_N_per_m, double offset_N, double guess_m) noexcept {
    constexpr int kNewtonSteps = 6;
    constexpr double kSolved_N = 1e-12;
    const double reach_m = surface_m - kGap_m;
    const double open_m = -offset_N / slope_N_per_m;
    if (open_m >= reach_m) return open_m;
    double y_m = std::clamp(guess_m, open_m, reach_m);
    for (int i = 0; i < kNewtonSteps; ++i) {
      const double squeezed_m = std::max(0.0, reach_m - y_m);
      const double root = std::sqrt(squeezed_m);
      const double excess_N = kInclusion_N_per_m1_5 * squeezed_m * root - slope_N_per_m * y_m - offset_N;
      if (std::abs(excess_N) < kSolved_N) break;
      const double slope = 1.5 * kInclusion_N_per_m1_5 * root + slope_N_per_m;
      y_m = std::clamp(y_m + excess_N / slope, open_m, reach_m);
    }
    return y_m;
  }

  double inclusion_m_ = 0.0;  // y
  double branch_N_ = 0.0;     // z
  MaxwellStep support_;
};

}  // namespace palpate
