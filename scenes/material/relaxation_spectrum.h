// A dense relaxation spectrum: the hereditary part of quasi-linear
// viscoelasticity,
//   M(t) = integral K(t - u) dE/du du,   K(t) = sum_i w_i exp(-t / tau_i),
// with E the elastic response and 48 times evenly spaced in log tau, close enough
// that K is a continuous spectrum to within 0.1 % between its ends. Each sub-step
// is exact for an E that changes evenly:
//   M_i <- M_i exp(-h/tau_i) + w_i dE (1 - exp(-h/tau_i)) tau_i / h.
// Passive for every E that rises with depth: see maxwell_block.h, with
// g_i = w_i E.
// Source: Fung (1993), Biomechanics, section 7.6 (quasi-linear viscoelasticity).
// Thread guarantee: one thread at a time; all but the constructor are wait-free.
#pragma once

#include <array>
#include <cstddef>

namespace palpate {

class RelaxationSpectrum {
 public:
  static constexpr std::size_t kTimes = 48;

  // `density`: w per unit of ln tau, >= 0, at a time in seconds; from
  // `shortest_s` to `longest_s` by the midpoint rule in ln tau.
  template <typename Density>
  RelaxationSpectrum(double shortest_s, double longest_s, Density density) {
    for (std::size_t i = 0; i < kTimes; ++i) {
      time_s_[i] = midpoint_s(shortest_s, longest_s, i);
      weight_[i] = density(time_s_[i]) * spacing(shortest_s, longest_s);
      total_weight_ += weight_[i];
    }
  }

  // K(0), what the spectrum adds before anything has relaxed, over E.
  double total_weight() const noexcept { return total_weight_; }

  void prepare(double substep_s) noexcept;
  // Lets one sub-step's time pass.
  void relax() noexcept;
  // M after the sub-step, should E change by `change_N` in it.
  double memory_N(double change_N) const noexcept { return relaxed_N_ + gain_ * change_N; }
  // E has changed by `change_N` in the sub-step.
  void settle(double change_N) noexcept;
  void forget() noexcept;

 private:
  static double midpoint_s(double shortest_s, double longest_s, std::size_t index);
  static double spacing(double shortest_s, double longest_s);

  std::array<double, kTimes> time_s_{}, weight_{}, decay_{}, kick_{}, memory_N_{};
  double total_weight_ = 0.0;
  double gain_ = 0.0;       // sum of kick_
  double relaxed_N_ = 0.0;  // sum of memory_N_ after relax
  double settled_N_ = 0.0;  // last change, which the next sub-step adds: one pass for both
};

}  // namespace palpate
