// Keeps the last second of ticks up to kTicksAfter after the beginning of a fault: the motion of the tool, the forces
// and the state of the device.
// Thread guarantee: one slow-side thread, which reads the loop's snapshots.
#pragma once

#include <cstddef>
#include <deque>
#include <string>

#include "engine/base/result.h"
#include "engine/live/live_tick.h"

namespace palpate {

class FaultRecorder {
 public:
  static constexpr std::size_t kTicks = 1000;
  static constexpr std::size_t kTicksAfter = 100;

  // Takes every snapshot in order. Returns true kTicksAfter ticks after the beginning of a fault that stops the force,
  // so that `ticks` includes the decay of the force. A further fault in the meantime belongs to it.
  bool add(const LoopSnapshot& snapshot);

  // Oldest first; fewer than kTicks in the first second of the loop.
  const std::deque<LoopSnapshot>& ticks() const noexcept { return ticks_; }

 private:
  std::deque<LoopSnapshot> ticks_;
  std::size_t left_ = 0;  // ticks until the fault is complete; 0: no fault
  bool in_fault_ = false;
};

// Writes the file of a fault: a header with the column names, one line for each tick. Errors: those of AtomicFile; an
// existing file is not overwritten.
Status write_fault_file(const std::string& path, const std::deque<LoopSnapshot>& ticks);

}  // namespace palpate
