// Selects the model whose force is rendered, and fades from one to the next: F = sum_i w_i F_i, sum_i w_i = 1, moves to
// the selected model s by w <- w + a (e_s - w), so F <- F + a (F_s - F). Each tick takes the largest a <= 1 for which
// the step stays below a tenth of a JND, that of the smaller of |F| and |F_s|, per millisecond: a switch changes the
// force by at most one JND in 10 ms, and at once in air. Changes of the models' own forces are not limited. Thread
// guarantee: one thread at a time; wait-free, allocates nothing.
#pragma once

#include <array>

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
  void jump_to(std::size_t selected) noexcept;

  // Moves the mixture towards `selected` for `step_s`, clamped to 0 to 10 ms, and returns it in newtons.
  double mix(const Forces& forces_N, std::size_t selected, double step_s) noexcept;

  // The current mixture.
  double current(const Forces& forces_N) const noexcept;

  bool settled_on(std::size_t index) const noexcept { return weights_[index] == 1.0; }

 private:
  JndLine jnd_;
  Forces weights_{};
};

}  // namespace palpate
