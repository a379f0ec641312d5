// A block with an elastic response and a memory of it, quasi-linear viscoelasticity:
//   F = E(s) + M,   M(t) = integral K(t - u) dE/du du,   K(t) = sum_i w_i exp(-t / tau_i),
// with the elastic response E of the derived class and 48 times tau_i evenly spaced in log tau, which approximate
// a continuous spectrum to within 0.1 % between its ends. Derived classes may add further forces. Each sub-step is
// exact where E changes at a constant rate:
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

  double half_relaxed_force_N(double depth_m) const noexcept override {
    return elastic_force_N(depth_m) * (1.0 + 0.5 * total_weight_);
  }

 protected:
  // `density(time_s)`: w per unit of ln tau, >= 0, sampled from `shortest_s` to `longest_s` by the midpoint rule.
  template <typename Density>
  HereditaryBlock(double shortest_s, double longest_s, Density density) {
    const double spacing = std::log(longest_s / shortest_s) / static_cast<double>(kTimes);
    for (std::size_t i = 0; i < kTimes; ++i) {
      time_s_[i] = shortest_s * std::exp(spacing * (static_cast<double>(i) + 0.5));
      weight_[i] = density(time_s_[i]) * spacing;
      total_weight_ += weight_[i];
    }
  }

  // share x E + M after a move of the surface to `surface_m`, newtons.
  double hereditary_force_N(double surface_m, double share = 1.0) const noexcept {
    const double elastic_N = elastic_force_N(surface_m);
    return share * elastic_N + relaxed_N_ + gain_ * (elastic_N - elastic_N_);
  }

  void prepare() noexcept override {
    for (std::size_t i = 0; i < kTimes; ++i) memory_N_[i] += kick_[i] * settled_N_;
    settled_N_ = gain_ = 0.0;
    for (std::size_t i = 0; i < kTimes; ++i) {
      const double ratio = substep_s() / time_s_[i];
      decay_[i] = std::exp(-ratio);
      kick_[i] = weight_[i] * -std::expm1(-ratio) / ratio;
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

  std::array<double, kTimes> time_s_{}, weight_{}, decay_{}, kick_{}, memory_N_{};
  double total_weight_ = 0.0;  // K(0)
  double gain_ = 0.0;          // sum of kick_
  double relaxed_N_ = 0.0;     // sum of memory_N_ after the decay of this sub-step
  double settled_N_ = 0.0;     // last change of E, which the next sub-step adds to memory_N_
  double elastic_N_ = 0.0;     // E at the last surface
};

}  // namespace palpate
