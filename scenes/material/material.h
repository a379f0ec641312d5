// Virtual materials: what a block of silicone, foam or gel answers to a tool
// that presses into it along one direction.
//
// With s the indentation of the surface (the tool's depth while they touch):
//   F = E(s) + V(s, ds/dt) + sum_b F_b + F_h            never below 0
//   E(s)    = k1 s + k2 s^2 + k3 s^3                    elasticity
//   V(s, v) = c s v (w + (1 - w) / (1 + |v| / v0))      viscosity, thinning with speed
//   dF_b/dt = K_b(s) ds/dt - F_b / tau_b                Maxwell branches,
//             K_b(s) = K_b0 + K_b1 s
//   dF_h/dt = K_h ds/dt, held within +-mu E(s)          dry friction of cell walls
// The surface never pulls. When the tool retracts faster than the material
// follows, they separate: the force is 0 although the depth is positive, and
// the free surface comes back by itself, so that the sum above stays 0, until
// it meets the tool or is flat again. Branches go on relaxing meanwhile.
// Every element is passive: each F_b is g_b(s) - y_b with g_b' = K_b > 0 and
// y_b drawn towards g_b, which can store and lose energy but not make any.
// SI units; force along the outward normal, positive when it pushes the tool
// out. Source: Hoever & Harders (2009), section 2.2 and eq. 1 (Maxwell
// branches); Hunt & Crossley (1975) (damping that grows with depth).
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "engine/base/result.h"

namespace palpate {

inline constexpr std::size_t kMaximumBranches = 3;

// One Maxwell branch: a spring that stiffens with depth, in series with a
// dashpot that lets it relax.
struct RelaxationBranch {
  double relaxation_time_s = 1.0;           // tau_b > 0
  double stiffness_N_per_m = 0.0;           // K_b0 >= 0
  double stiffness_slope_N_per_m2 = 0.0;    // K_b1 >= 0
};

struct Material {
  std::string_view name;
  std::string_view summary;  // one line for people
  double elastic_linear_N_per_m = 0.0;      // k1 > 0; E must rise with depth
  double elastic_quadratic_N_per_m2 = 0.0;  // k2
  double elastic_cubic_N_per_m3 = 0.0;      // k3
  double viscosity_Ns_per_m2 = 0.0;         // c: damping per metre of depth
  double thick_fraction = 1.0;              // w, in 0..1: what is left at high speed
  double thinning_speed_m_per_s = 1.0;      // v0 > 0
  double friction_fraction = 0.0;           // mu >= 0, of the elastic force
  double friction_stiffness_N_per_m = 0.0;  // K_h >= 0
  std::size_t branch_count = 0;
  std::array<RelaxationBranch, kMaximumBranches> branches{};
  double recording_seconds = 41.499;        // length of a recording unless told otherwise

  // E(depth), newtons; depth_m >= 0.
  double elastic_force_N(double depth_m) const noexcept;
  // g_b(depth): what branch b would hold had it not relaxed at all, newtons.
  double unrelaxed_force_N(std::size_t branch, double depth_m) const noexcept;
  // V(depth, rate), newtons.
  double viscous_force_N(double depth_m, double rate_m_per_s) const noexcept;
};

// All materials, in the order in which they are listed to people.
std::span<const Material> materials() noexcept;

// The material of that name. Errors: unknown name; the message lists the known.
Result<Material> find_material(std::string_view name);

// The material's true relaxation times as text, e.g. "0.17 s, 1.27 s", or
// "none".
std::string relaxation_times_text(const Material& material);

// One block of a material with its memory. A copy is an independent block.
// Thread guarantee: one thread at a time; `step` is wait-free, allocates
// nothing and fits the haptic tick.
class MaterialState {
 public:
  explicit MaterialState(const Material& material) noexcept : material_(material) {}

  // Moves the tool to `position_m` (positive inside the block), where it has
  // `velocity_m_per_s`, `dt_s` later; returns the force then, newtons, >= 0.
  // In between position and velocity follow the cubic through both ends, in
  // sub-steps of 0.1 ms or less (longer ones only when dt_s exceeds 0.1 s).
  // Errors: an argument that is not finite, or dt_s <= 0, changes nothing and
  // returns the last force.
  double step(double position_m, double velocity_m_per_s, double dt_s) noexcept;

  // Puts the tool at `position_m` at rest with all memory gone.
  void reset(double position_m = 0.0) noexcept;

  const Material& material() const noexcept { return material_; }
  double force_N() const noexcept { return force_N_; }
  // Indentation of the surface: the tool's depth in contact, more when the
  // tool has left a surface that still comes back.
  double surface_depth_m() const noexcept { return surface_m_; }
  double branch_force_N(std::size_t branch) const noexcept { return branch_force_N_[branch]; }
  bool touching() const noexcept { return touching_; }

 private:
  struct Inner {
    std::array<double, kMaximumBranches> branch_N{};
    double friction_N = 0.0;
    double static_force_N = 0.0;  // all but viscosity
  };
  void prepare(double substep_s) noexcept;
  void substep(double position_m, double velocity_m_per_s) noexcept;
  Inner inner_at(double surface_m) const noexcept;
  double residual_N(double surface_m) const noexcept;
  double free_surface_m(double depth_m, double depth_residual_N) const noexcept;
  void settle(double surface_m, const Inner& inner) noexcept;

  Material material_;
  double position_m_ = 0.0;
  double velocity_m_per_s_ = 0.0;
  double surface_m_ = 0.0;
  double friction_N_ = 0.0;
  double force_N_ = 0.0;
  bool touching_ = false;
  std::array<double, kMaximumBranches> branch_force_N_{};
  double substep_s_ = 0.0;
  std::array<double, kMaximumBranches> decay_{};  // exp(-h / tau)
  std::array<double, kMaximumBranches> gain_{};   // (1 - exp(-h / tau)) tau / h
};

}  // namespace palpate
