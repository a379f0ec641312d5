// The motion of the tool in the last minute, thinned to 4 ms. Models that are added during a press start with the
// memory of the material for this motion, not with a material at rest under the tool.
// Thread guarantee: slow side (allocates); one thread.
#pragma once

#include <deque>

#include "engine/tick/haptics_tick.h"

namespace palpate {

class MotionHistory {
 public:
  // Takes the snapshot of every tick in order. `restarted`: it begins a new stream; the earlier motion is deleted.
  void add(const TickSnapshot& snapshot, bool restarted);
  // Advances the filters of `tick` by this motion; `HapticsTick::continue_from` continues from there.
  void recall(HapticsTick& tick) const;

 private:
  std::deque<PastMotion> past_;
};

}  // namespace palpate
