// The laws of the virtual materials: how the force of a block follows the depth of its surface. Each has its equation,
// its source, and the reason why it is passive: from the undeformed state on, the work done on the block is never
// negative.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "scenes/material/material.h"

namespace palpate {

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

// Soft rubber under a sphere, with a continuous spectrum of relaxation times: quasi-linear viscoelasticity,
//   F = E(s) + M,   M(t) = integral K(t - u) dE/du du,   K(t) = c (E1(t / tau2) - E1(t / tau1)),
// where E is the contact law of SphereContact and K Fung's box spectrum: the same weight c for every ln tau between
// tau1 and tau2. There are no discrete relaxation times that a fit could identify, and E ~ d^1.5 at the surface is no
// polynomial. K is approximated to within 0.1 % by 48 times tau_i evenly spaced in log tau. Each sub-step is exact
// where E changes at a constant rate:
//   M_i <- M_i exp(-h/tau_i) + w dE (1 - exp(-h/tau_i)) tau_i / h.
// Derived classes add further forces.
// Passive for every E that rises with depth: see MaxwellBlock, with g_i = w E.
// Source: Fung (1993), Biomechanics, section 7.6 (quasi-linear viscoelasticity).

// A rigid sphere pressed into a soft half-space at large strain: with the contact radius a = sqrt(R d) of Hertz and
// the representative stretch lambda = 1 - 0.2 a / R under the sphere,
//   F(d) = B a^2 (lambda^-2 - lambda),
// a neo-Hookean solid. For small d it is Hertz's law, F = (16/9) E sqrt(R) d^1.5 with B = (80/27) E. F rises with d
// everywhere. The stretch is limited to at least 0.5, which is reached at a depth of six radii.
// Source: Lin, Dimitriadis & Horkay (2009), "Spherical indentation of soft matter beyond the Hertzian regime", the
// neo-Hookean line; Hertz (1882).
struct SphereContact {
  double radius_m = 0.01;   // R > 0
  double modulus_Pa = 0.0;  // E >= 0, Young's modulus of the incompressible solid at rest

  // F(depth), newtons; depth_m >= 0.
  double force_N(double depth_m) const noexcept {
    const double contact_m2 = radius_m * depth_m;
    const double stretch = std::max(0.5, 1.0 - 0.2 * std::sqrt(contact_m2) / radius_m);
    const double inverse = 1.0 / stretch;
    return 80.0 / 27.0 * modulus_Pa * contact_m2 * (inverse * inverse - stretch);
  }
};

class HereditaryBlock : public Block {
 public:
  // `weight`: c, of the spectrum from `shortest_s` (tau1) to `longest_s` (tau2), sampled by the midpoint rule.
  HereditaryBlock(const SphereContact& contact, double shortest_s, double longest_s, double weight)
      : contact_(contact) {
    const double spacing = std::log(longest_s / shortest_s) / static_cast<double>(kTimes);
    weight_ = weight * spacing;
    for (std::size_t i = 0; i < kTimes; ++i) {
      time_s_[i] = shortest_s * std::exp(spacing * (static_cast<double>(i) + 0.5));
      total_weight_ += weight_;
    }
  }

  // E(depth), newtons; rises with the depth.
  virtual double elastic_force_N(double depth_m) const noexcept { return contact_.force_N(depth_m); }

  double half_relaxed_force_N(double depth_m) const noexcept override {
    return elastic_force_N(depth_m) * (1.0 + 0.5 * total_weight_);
  }

 protected:
  // E + M after a move of the surface to `surface_m`, newtons.
  double hereditary_force_N(double surface_m) const noexcept {
    const double elastic_N = elastic_force_N(surface_m);
    return elastic_N + relaxed_N_ + gain_ * (elastic_N - elastic_N_);
  }

  void prepare() noexcept override {
    for (std::size_t i = 0; i < kTimes; ++i) memory_N_[i] += kick_[i] * settled_N_;
    settled_N_ = gain_ = 0.0;
    for (std::size_t i = 0; i < kTimes; ++i) {
      const double ratio = substep_s() / time_s_[i];
      decay_[i] = std::exp(-ratio);
      kick_[i] = weight_ * -std::expm1(-ratio) / ratio;
      gain_ += kick_[i];
    }
  }
  void begin_substep() noexcept override {
    // Four independent sums, so that no addition waits for the one before.
    constexpr std::size_t kTimesAtOnce = 4;
    static_assert(kTimes % kTimesAtOnce == 0);
    double sum_N[kTimesAtOnce] = {};
    for (std::size_t i = 0; i < kTimes; i += kTimesAtOnce) {
      for (std::size_t lane = 0; lane < kTimesAtOnce; ++lane) {
        const double left_N = (memory_N_[i + lane] + kick_[i + lane] * settled_N_) * decay_[i + lane];
        memory_N_[i + lane] = std::abs(left_N) > kNoForce_N ? left_N : 0.0;
        sum_N[lane] += memory_N_[i + lane];
      }
    }
    settled_N_ = 0.0;
    relaxed_N_ = (sum_N[0] + sum_N[1]) + (sum_N[2] + sum_N[3]);
  }
  double contact_force_N(double surface_m, double) const noexcept override { return hereditary_force_N(surface_m); }
  void update_state(double surface_m, bool) noexcept override {
    const double elastic_N = elastic_force_N(surface_m);
    settled_N_ = elastic_N - elastic_N_;
    elastic_N_ = elastic_N;
  }
  void reset_state(double surface_m) noexcept override {
    memory_N_.fill(0.0);
    relaxed_N_ = settled_N_ = 0.0;
    elastic_N_ = elastic_force_N(surface_m);
  }

 private:
  static constexpr std::size_t kTimes = 48;

  SphereContact contact_;
  std::array<double, kTimes> time_s_{}, decay_{}, kick_{}, memory_N_{};
  double weight_ = 0.0;        // w
  double total_weight_ = 0.0;  // K(0)
  double gain_ = 0.0;          // sum of kick_
  double relaxed_N_ = 0.0;     // sum of memory_N_ after the decay of this sub-step
  double settled_N_ = 0.0;     // last change of E, which the next sub-step adds to memory_N_
  double elastic_N_ = 0.0;     // E at the last surface
};

// A soft block that grips the probe: a neo-Hookean contact with weak relaxation, and dry
// friction at the side of the probe, modelled by bristles that bend elastically and then
// slip (Dahl). The number of bristles is proportional to the depth, up to 4 mm:
//   F = E(s) + integral K(t - u) dE(s)/du du + F_c(s) z     never below 0
//   dz/ds = (1 - z sgn(ds)) / x_p                            presliding, then slip
//   F_c(s) = F_c min(1, s / d_c)
// On the way in new bristles are unbent and do not change F_c(s) z; on the way out bristles
// leave with their share of the force. Friction that holds the probe back does not exceed the
// force that pushes it out, so that the block does not grip it. A free surface has no friction.
// Passive: at most V = F_c(s) x_p z^2 / 2 is stored, and F_c z ds - dV >= z^2 F_c |ds| on the
// way in, more on the way out.
// Source: Dahl (1968); Canudas de Wit, Olsson, Astrom & Lischinsky (1995)
// (bristles, presliding); Okamura, Simone & O'Leary (2004) (friction of soft tissue along a probe).
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

// A wet sponge under a flat tool: the skeleton carries a part of the load and the pore fluid the rest, until the
// fluid has drained radially from under the tool. With the strain e = s / L of the column under the tool and the pore
// pressure p(r, t):
//   F = A (sigma(e) + mean of p over the tool)
//   dp/dt = M de/dt + (1 / r) d/dr (r k(e) M dp/dr),   p(a) = 0,  dp/dr(0) = 0
//   sigma(e) = E e / (1 - e / e_d)                      densification of open cells
//   k(e) = k0 exp(-b e)                                 permeability decreases with strain
// The drainage has a series of relaxation times a^2 / (k M j_n^2) with the zeros j_n of J0 (2.405, 5.52, ...), which
// are twelve times longer at a strain of 0.5. The pressure is integrated by finite volumes in 12 rings with implicit
// Euler, with k(e) of the beginning of the sub-step.
// Passive: A L (integral of sigma de + mean p^2 / (2 M)) is stored, drainage dissipates, and so does implicit Euler.
// Source: Biot (1941); Mow, Kuei, Lai & Armstrong (1980) (biphasic theory); Armstrong, Lai & Mow (1984) (radial
// drainage under a plate); Lai & Mow (1980) (permeability and strain); Gibson & Ashby (1997) (densification).
class SpongeBlock final : public Block {
 public:
  static constexpr std::size_t kRings = 12;
  static constexpr double kHeight_m = 0.03;                 // L
  static constexpr double kRadius_m = 0.012;                // a
  static constexpr double kSkeleton_Pa = 9e3;               // E
  static constexpr double kClosed_strain = 0.8;             // e_d
  static constexpr double kPore_Pa = 160e3;                 // M
  static constexpr double kDiffusivity_m2_per_s = 1.25e-4;  // k0 M
  static constexpr double kPermeabilityFall = 5.0;          // b

  // After a press of some tenths of a second the pore pressure is about a tenth of its undrained value.
  double half_relaxed_force_N(double depth_m) const noexcept override {
    return relaxed_force_N(depth_m) + 0.1 * kArea_m2 * kPore_Pa * depth_m / kHeight_m;
  }
  // A sigma(e).
  double relaxed_force_N(double depth_m) const noexcept {
    constexpr double kMostClosed = 0.9;  // upper limit of e / e_d in the denominator
    const double strain = depth_m / kHeight_m;
    const double closed = std::min(kMostClosed, strain / kClosed_strain);
    return kArea_m2 * kSkeleton_Pa * strain / (1.0 - closed);
  }

 private:
  using Rings = std::array<double, kRings>;
  static constexpr double kArea_m2 = 3.14159265358979324 * kRadius_m * kRadius_m;
  static constexpr double kRingCount = static_cast<double>(kRings);

  // The ring's share of the tool's area. Rings have equal width.
  static constexpr double ring_share(std::size_t ring) {
    return (2.0 * static_cast<double>(ring) + 1.0) / (kRingCount * kRingCount);
  }
  // Conductance of the outer edge of `ring`: perimeter / distance of the pressures, over 2 pi. The boundary pressure
  // 0 is only half a ring's width away.
  static constexpr double ring_edge(std::size_t ring) {
    const double outer = static_cast<double>(ring) + 1.0;
    return ring + 1 == kRings ? 2.0 * outer : outer;
  }
  // Solves (I - h D) p = p_old + M de for any de: one elimination with two right-hand sides.
  void begin_substep() noexcept override {
    const double strain = surface_depth_m() / kHeight_m;
    const double width_m = kRadius_m / kRingCount;
    const double flow =
        substep_s() * kDiffusivity_m2_per_s * std::exp(-kPermeabilityFall * strain) / (width_m * width_m);
    Rings above{};  // upper diagonal, divided by the pivot
    double from_inside = 0.0, last_drained = 0.0, last_squeezed = 0.0;
    for (std::size_t i = 0; i < kRings; ++i) {
      const double volume = static_cast<double>(i) + 0.5;
      const double inner = i == 0 ? 0.0 : flow * ring_edge(i - 1);
      const double outer = flow * ring_edge(i);
      const double pivot = 1.0 / (volume + inner + outer - inner * from_inside);
      drained_Pa_[i] = last_drained = (volume * pressure_Pa_[i] + inner * last_drained) * pivot;
      squeezed_Pa_[i] = last_squeezed = (volume * kPore_Pa + inner * last_squeezed) * pivot;
      above[i] = from_inside = i + 1 < kRings ? outer * pivot : 0.0;
    }
    mean_drained_Pa_ = mean_squeezed_Pa_ = 0.0;
    for (std::size_t i = kRings; i-- > 0;) {
      if (i + 1 < kRings) {
        drained_Pa_[i] += above[i] * drained_Pa_[i + 1];
        squeezed_Pa_[i] += above[i] * squeezed_Pa_[i + 1];
      }
      mean_drained_Pa_ += ring_share(i) * drained_Pa_[i];
      mean_squeezed_Pa_ += ring_share(i) * squeezed_Pa_[i];
    }
  }
  double strained(double surface_m) const noexcept { return (surface_m - surface_depth_m()) / kHeight_m; }
  double contact_force_N(double surface_m, double) const noexcept override {
    return relaxed_force_N(surface_m) + kArea_m2 * (mean_drained_Pa_ + mean_squeezed_Pa_ * strained(surface_m));
  }
  void update_state(double surface_m, bool) noexcept override {
    constexpr double kNoPressure_Pa = 1e-25;
    for (std::size_t i = 0; i < kRings; ++i) {
      const double pressure_Pa = drained_Pa_[i] + squeezed_Pa_[i] * strained(surface_m);
      pressure_Pa_[i] = std::abs(pressure_Pa) > kNoPressure_Pa ? pressure_Pa : 0.0;
    }
  }
  void reset_state(double) noexcept override { pressure_Pa_.fill(0.0); }

  Rings pressure_Pa_{};
  // At the end of the sub-step pressure = drained_ + squeezed_ x change of strain, likewise for the means over the
  // tool.
  Rings drained_Pa_{}, squeezed_Pa_{};
  double mean_drained_Pa_ = 0.0, mean_squeezed_Pa_ = 0.0;
};

}  // namespace palpate
