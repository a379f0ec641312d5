// What the tool did in the last minute, thinned: so that models which join in mid-press
// begin with the memory of the material that they would have had they been there, not
// with a material at rest under the tool.
// Thread guarantee: slow side (allocates); one thread.
#pragma once

#include <deque>

#include "engine/tick/haptics_tick.h"

namespace palpate {

class MotionHistory {
 public:
  // Every tick in order. `restarted`: a new stream began with it, and what was before is
  // forgotten, as the tick has.
  void add(const TickSnapshot& snapshot, bool restarted);
  // The tick's filters go through it; `HapticsTick::continue_from` goes on from there.
  void recall(HapticsTick& tick) const;

 private:
  std::deque<PastMotion> past_;
};

}  // namespace palpate
