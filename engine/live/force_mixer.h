// Which model's force is rendered, and how one fades into the next.
//
// The force is a mixture, F = sum_i w_i F_i with sum_i w_i = 1, that moves
// towards the selected model s:
//   w <- w + a (e_s - w),   so that   F <- F + a (F_s - F).
// Each tick takes the largest a <= 1 for which the step |a (F_s - F)| stays
// below a tenth of one JND per millisecond, the JND at the smaller of the two
// forces. So switching never moves the force by more than one JND in 10 ms,
// whatever the models differ by, and takes no time at all in the air, where all
// forces are 0. The models' own changes pass through unhindered.
//
// Thread guarantee: one thread at a time; wait-free, allocates nothing.
#pragma once

#include <array>
#include <cstddef>

#include "engine/tick/haptics_tick.h"
#include "engine/tick/jnd.h"

namespace palpate {

class ForceMixer {
 public:
  // Room for every model of a set and, as the last one, for the mixture of the
  // set before it.
  static constexpr std::size_t kOutgoing = kMaxModels;
  using Forces = std::array<double, kMaxModels + 1>;

  explicit ForceMixer(const JndLine& jnd) noexcept : jnd_(jnd) { weights_[0] = 1.0; }

  // At once, without a fade: for a beginning in which nothing was felt yet.
  void jump_to(std::size_t selected) noexcept;

  // A new set takes over: all of what was felt is now the outgoing force.
  void begin_transition() noexcept { jump_to(kOutgoing); }

  // The mixture of `forces_N` after moving towards `selected` for `step_s`, which
  // counts as between 0 and 10 ms.
  double mix(const Forces& forces_N, std::size_t selected, double step_s) noexcept;

  // The mixture as it is.
  double current(const Forces& forces_N) const noexcept;

  const Forces& weights() const noexcept { return weights_; }
  bool settled_on(std::size_t index) const noexcept { return weights_[index] == 1.0; }

 private:
  JndLine jnd_;
  Forces weights_{};
};

}  // namespace palpate
