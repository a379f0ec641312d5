// A block with an elastic response and a memory of it, quasi-linear viscoelasticity:
//   F = E(s) + M,   M(t) = integral K(t - u) dE/du du,   K(t) = sum_i w_i exp(-t / tau_i),
// with E the law's and 48 times evenly spaced in log tau, close enough that K is a continuous
// spectrum to within 0.1 % between its ends; laws add to it what else they have. Each sub-step
// is exact for an E that changes evenly:
//   M_i <- M_i exp(-h/tau_i) + w_i dE (1 - exp(-h/tau_i)) tau_i / h.
// Passive for every E that rises with depth: see maxwell_block.h, with g_i = w_i E.
// Source: Fung (1993), Biomechanics, section 7.6 (quasi-linear viscoelasticity).
// Thread guarantee: as Block.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "scenes/material/block.h"

namespace palpate {

class HereditaryBlock : public Block {
 public:
  // E(depth), newtons; rises with the depth.
  virtual double elastic_force_N(double depth_m) const noexcept = 0;

  double held_force_N(double depth_m) const noexcept override {
    return elastic_force_N(depth_m) * (1.0 + 0.5 * total_weight_);
  }
  double relaxed_force_N(double depth_m) const noexcept override { return elastic_force_N(depth_m); }

 protected:
  // `density`: w per unit of ln tau, >= 0, at a time in seconds; from `shortest_s` to `longest_s`
  // by the midpoint rule in ln tau.
  template <typename Density>
  HereditaryBlock(double shortest_s, double longest_s, Density density) {
    const double spacing = std::log(longest_s / shortest_s) / static_cast<double>(kTimes);
    for (std::size_t i = 0; i < kTimes; ++i) {
      time_s_[i] = shortest_s * std::exp(spacing * (static_cast<double>(i) + 0.5));
      weight_[i] = density(time_s_[i]) * spacing;
      total_weight_ += weight_[i];
    }
  }

  // `share` of E and all of the memory, should the surface go to `surface_m`.
  double hereditary_force_N(double surface_m, double share = 1.0) const noexcept {
    const double elastic_N = elastic_force_N(surface_m);
    return share * elastic_N + relaxed_N_ + gain_ * (elastic_N - elastic_N_);
  }

  void prepare() noexcept override;
  void begin_substep() noexcept override;
  double contact_force_N(double surface_m, double) const noexcept override { return hereditary_force_N(surface_m); }
  void settle(double surface_m, bool) noexcept override {
    const double elastic_N = elastic_force_N(surface_m);
    settled_N_ = elastic_N - elastic_N_;
    elastic_N_ = elastic_N;
  }
  void forget(double surface_m) noexcept override {
    memory_N_.fill(0.0);
    relaxed_N_ = settled_N_ = 0.0;
    elastic_N_ = elastic_force_N(surface_m);
  }

 private:
  static constexpr std::size_t kTimes = 48;

  std::array<double, kTimes> time_s_{}, weight_{}, decay_{}, kick_{}, memory_N_{};
  double total_weight_ = 0.0;  // K(0)
  double gain_ = 0.0;          // sum of kick_
  double relaxed_N_ = 0.0;     // sum of memory_N_ when a sub-step's time has passed
  double settled_N_ = 0.0;     // last change of E, which the next sub-step adds: one pass for both
  double elastic_N_ = 0.0;     // E at the last surface
};

}  // namespace palpate
