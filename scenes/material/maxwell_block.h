// Springs, dashpots and Maxwell branches: the family of materials whose
// relaxation times are known. With s the indentation of the surface:
//   F = E(s) + V(s, ds/dt) + sum_b F_b + F_h            never below 0
//   E(s)    = k1 s + k2 s^2 + k3 s^3                    elasticity
//   V(s, v) = c s v (w + (1 - w) / (1 + |v| / v0))      viscosity, thinning with speed
//   dF_b/dt = K_b(s) ds/dt - F_b / tau_b                Maxwell branches,
//             K_b(s) = K_b0 + K_b1 s
//   dF_h/dt = K_h ds/dt, clamped to +-mu E(s)           dry friction of cell walls
// The trend of the models has the same elements, so that the accuracy on these materials
// does not generalise to others. They are for tests that need known relaxation times.
// Passive: F_b = g_b(s) - y_b with g_b' = K_b > 0 and y_b relaxing towards g_b, which
// stores and dissipates energy only.
// Source: Hoever & Harders (2009), section 2.2 and eq. 1 (Maxwell branches);
// Hunt & Crossley (1975) (damping that grows with depth).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "scenes/material/block.h"

namespace palpate {

inline constexpr std::size_t kMaximumBranches = 2;

// One Maxwell branch: a spring that stiffens with depth, in series with a dashpot.
struct RelaxationBranch {
  double relaxation_time_s = 1.0;         // tau_b > 0
  double stiffness_N_per_m = 0.0;         // K_b0 >= 0
  double stiffness_slope_N_per_m2 = 0.0;  // K_b1 >= 0
};

struct MaxwellParameters {
  double elastic_linear_N_per_m = 0.0;      // k1 > 0; E must rise with depth
  double elastic_quadratic_N_per_m2 = 0.0;  // k2
  double elastic_cubic_N_per_m3 = 0.0;      // k3
  double viscosity_Ns_per_m2 = 0.0;         // c: damping per metre of depth
  double thick_fraction = 1.0;              // w, in 0..1: share of the viscosity that remains at high speed
  double thinning_speed_m_per_s = 1.0;      // v0 > 0
  double friction_fraction = 0.0;           // mu >= 0, of the elastic force
  double friction_stiffness_N_per_m = 0.0;  // K_h >= 0
  std::array<RelaxationBranch, kMaximumBranches> branches{};  // those of stiffness 0 have no force

  // E(depth), newtons; depth_m >= 0.
  double elastic_force_N(double depth_m) const noexcept {
    return depth_m *
           (elastic_linear_N_per_m + depth_m * (elastic_quadratic_N_per_m2 + depth_m * elastic_cubic_N_per_m3));
  }
  // g_b(depth): the force of branch b without relaxation, newtons.
  double unrelaxed_force_N(std::size_t branch, double depth_m) const noexcept {
    const RelaxationBranch& b = branches[branch];
    return depth_m * (b.stiffness_N_per_m + 0.5 * b.stiffness_slope_N_per_m2 * depth_m);
  }
  // V(depth, rate), newtons.
  double viscous_force_N(double depth_m, double rate_m_per_s) const noexcept {
    const double thinned = (1.0 - thick_fraction) / (1.0 + std::abs(rate_m_per_s) / thinning_speed_m_per_s);
    return viscosity_Ns_per_m2 * depth_m * rate_m_per_s * (thick_fraction + thinned);
  }
};

inline constexpr MaxwellParameters kMaxwell = {.elastic_linear_N_per_m = 330.0,
                                               .elastic_quadratic_N_per_m2 = 1.2e4,
                                               .elastic_cubic_N_per_m3 = 1.2e6,
                                               .viscosity_Ns_per_m2 = 800.0,
                                               .thick_fraction = 0.5,
                                               .thinning_speed_m_per_s = 0.15,
                                               .branches = {{{0.17, 70.0, 9.0e3}, {1.27, 50.0, 6.0e3}}}};

inline constexpr MaxwellParameters kFoam = {.elastic_linear_N_per_m = 520.0,
                                            .elastic_quadratic_N_per_m2 = -6.5e4,
                                            .elastic_cubic_N_per_m3 = 3.6e6,
                                            .viscosity_Ns_per_m2 = 260.0,
                                            .thick_fraction = 0.6,
                                            .thinning_speed_m_per_s = 0.1,
                                            .friction_fraction = 0.025,
                                            .friction_stiffness_N_per_m = 60.0,
                                            .branches = {{{0.08, 60.0, 5.0e3}, {0.9, 45.0, 3.0e3}}}};

inline constexpr MaxwellParameters kElastic = {
    .elastic_linear_N_per_m = 400.0, .elastic_quadratic_N_per_m2 = 1.5e4, .elastic_cubic_N_per_m3 = 2.0e6};

inline constexpr MaxwellParameters kStiff = {.elastic_linear_N_per_m = 3000.0, .viscosity_Ns_per_m2 = 2000.0};

class MaxwellBlock final : public Block {
 public:
  explicit MaxwellBlock(const MaxwellParameters& parameters) noexcept : material_(parameters) {}

  double half_relaxed_force_N(double depth_m) const noexcept override {
    double held_N = material_.elastic_force_N(depth_m);
    for (std::size_t b = 0; b < kMaximumBranches; ++b) held_N += 0.5 * material_.unrelaxed_force_N(b, depth_m);
    return held_N;
  }

 private:
  // The elements with memory.
  struct Inner {
    std::array<double, kMaximumBranches> branch_N{};
    double friction_N = 0.0;
  };
  void prepare() noexcept override {
    for (std::size_t b = 0; b < kMaximumBranches; ++b)
      steps_[b] = MaxwellStep(substep_s(), material_.branches[b].relaxation_time_s);
  }
  double contact_force_N(double surface_m, double rate_m_per_s) const noexcept override {
    const Inner inner = inner_at(surface_m);
    double static_N = material_.elastic_force_N(surface_m);
    for (std::size_t b = 0; b < kMaximumBranches; ++b) static_N += inner.branch_N[b];
    return static_N + inner.friction_N + material_.viscous_force_N(surface_m, rate_m_per_s);
  }
  void update_state(double surface_m, bool) noexcept override {
    inner_ = inner_at(surface_m);
    for (double& branch_N : inner_.branch_N) branch_N = std::abs(branch_N) > kNoForce_N ? branch_N : 0.0;
  }
  void reset_state(double) noexcept override { inner_ = {}; }

  // The state after a move of the surface to `surface_m` within one sub-step, exact for a constant rate of g_b.
  Inner inner_at(double surface_m) const noexcept {
    Inner inner;
    for (std::size_t b = 0; b < kMaximumBranches; ++b) {
      const double change_N =
          material_.unrelaxed_force_N(b, surface_m) - material_.unrelaxed_force_N(b, surface_depth_m());
      inner.branch_N[b] = inner_.branch_N[b] * steps_[b].decay + change_N * steps_[b].gain;
    }
    const double limit_N = material_.friction_fraction * material_.elastic_force_N(surface_m);
    const double dragged_N = inner_.friction_N + material_.friction_stiffness_N_per_m * (surface_m - surface_depth_m());
    inner.friction_N = std::clamp(dragged_N, -limit_N, limit_N);
    return inner;
  }

  MaxwellParameters material_;
  Inner inner_;
  std::array<MaxwellStep, kMaximumBranches> steps_{};
};

}  // namespace palpate
