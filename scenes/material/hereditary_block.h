// Soft rubber under a sphere, with a continuous spectrum of relaxation times: quasi-linear viscoelasticity,
//   F = E(s) + M,   M(t) = integral K(t - u) dE/du du,   K(t) = c (E1(t / tau2) - E1(t / tau1)),
// where E is the contact law of SphereContact and K Fung's box spectrum: the same weight c for every ln tau between
// tau1 and tau2. There are no discrete relaxation times that a fit could identify, and E ~ d^1.5 at the surface is no
// polynomial. K is approximated to within 0.1 % by 48 times tau_i evenly spaced in log tau. Each sub-step is exact
// where E changes at a constant rate:
//   M_i <- M_i exp(-h/tau_i) + w dE (1 - exp(-h/tau_i)) tau_i / h.
// Derived classes add further forces.
// Passive for every E that rises with depth: see maxwell_block.h, with g_i = w E.
// Source: Fung (1993), Biomechanics, section 7.6 (quasi-linear viscoelasticity).
// Thread guarantee: as Block; SphereContact is immutable and wait-free.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "scenes/material/block.h"

namespace palpate {

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
    constexpr std::size_t kLanes = 4;
    static_assert(kTimes % kLanes == 0);
    double sum_N[kLanes] = {};
    for (std::size_t i = 0; i < kTimes; i += kLanes) {
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
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

}  // namespace palpate
