// The last second of ticks before a fault, kept for inspection: what the tool
// did, what the models asked for, what the device got.
// Thread guarantee: one slow-side thread, the one that reads the loop's snapshots.
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
  static constexpr std::size_t kTicksAfter = 100;  // of these, after the fault

  // Every snapshot in order. True: `ticks` are those around a fault that takes the force
  // away, its first tick kTicksAfter before the end, so that the way to no force is in
  // them. A fault that begins in the meantime is part of it.
  bool add(const LoopSnapshot& snapshot);

  // Oldest first; fewer than kTicks when the loop has not run for a second.
  const std::deque<LoopSnapshot>& ticks() const noexcept { return ticks_; }

 private:
  std::deque<LoopSnapshot> ticks_;
  std::size_t left_ = 0;  // ticks until the fault is whole; 0: no fault
  bool in_fault_ = false;
};

// The file of one fault: a header that names the columns, one line a tick.
// Errors: as AtomicFile, never writes over.
Status write_fault_file(const std::string& path, const std::deque<LoopSnapshot>& ticks);

}  // namespace palpate
