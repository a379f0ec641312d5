// Selects the model whose force is rendered, and fades from one to the next.
//
// The force is a mixture, F = sum_i w_i F_i with sum_i w_i = 1, that moves towards the selected model s:
//   w <- w + a (e_s - w),   e_s the unit vector of s,   so that   F <- F + a (F_s - F).
// Each tick takes the largest a <= 1 for which the step |a (F_s - F)| stays below a tenth of a JND per millisecond; the
// JND is that of the smaller of |F| and |F_s|. A switch thus changes the force by at most one JND in 10 ms, for any
// difference between the models, and is immediate in air, where all forces are 0. Changes of the models' own forces are
// not limited.
// Thread guarantee: one thread at a time; wait-free, allocates nothing.
#pragma once

#include <array>
#include <cstddef>

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
