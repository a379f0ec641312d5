// Selects the model whose force is rendered, and fades from one to the next: F = sum_i w_i F_i, sum_i w_i = 1, moves to
// the selected model s by w <- w + a (e_s - w), so F <- F + a (F_s - F). Each tick takes the largest a <= 1 for which
// the step stays below a tenth of a JND, that of the smaller of |F| and |F_s|, per millisecond: a switch changes the
// force by at most one JND in 10 ms, and at once in air. Changes of the models' own forces are not limited.
// Thread guarantee: one thread at a time; wait-free, allocates nothing.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/tick/haptics_tick.h"
#include "engine/tick/jnd.h"

namespace palpate {

class ForceMixer {
 public:
  // The force, N, of every model of a set; the last element is that of the model selected in the previous set.
  static constexpr std::size_t kOutgoing = kMaxModels;
  using Forces = std::array<double, kMaxModels + 1>;

  explicit ForceMixer(const JndLine& jnd) noexcept : jnd_(jnd) { weights_[0] = 1.0; }

  // Selects at once, without a fade: for the start, and kOutgoing for the fade to a new set.
  void jump_to(std::size_t selected) noexcept {
    weights_.fill(0.0);
    weights_[selected] = 1.0;
  }

  // Moves the mixture towards `selected` for `step_s`, clamped to 0 to 10 ms, and returns it in newtons.
  double mix(const Forces& forces_N, std::size_t selected, double step_s) noexcept {
    // After the fade the force has the bits of the model.
    if (settled_on(selected)) return forces_N[selected];
    const double force_N = current(forces_N), difference_N = forces_N[selected] - force_N;
    const double step = step_s > 0.0 ? std::min(step_s, kJndTime_s) : 0.0;
    const double jnd_N = jnd_.at(std::min(std::abs(force_N), std::abs(forces_N[selected])));
    const double most_N = kShareOfJnd * jnd_N * step / kJndTime_s;
    if (!(std::abs(difference_N) > most_N)) {
      jump_to(selected);
      return forces_N[selected];
    }
    const double share = most_N / std::abs(difference_N);
    for (double& weight : weights_) weight *= 1.0 - share;
    weights_[selected] += share;
    return force_N + share * difference_N;
  }

  // The current mixture.
  double current(const Forces& forces_N) const noexcept {
    double force_N = 0.0;
    for (std::size_t i = 0; i < weights_.size(); ++i)
      if (weights_[i] != 0.0) force_N += weights_[i] * forces_N[i];
    return force_N;
  }

  bool settled_on(std::size_t index) const noexcept { return weights_[index] == 1.0; }

 private:
  static constexpr double kJndTime_s = 0.01;
  // A rising force increases its own JND by up to 3 % within 10 ms. This share of the JND compensates for that and for
  // rounding.
  static constexpr double kShareOfJnd = 0.95;

  JndLine jnd_;
  Forces weights_{};
};

}  // namespace palpate
