// What a session tells the user: notices, and the log of the faults of loop, device and window in words.
// Thread guarantee: one thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/live/live_tick.h"

namespace palpate {

struct Notice {
  std::string text;
  bool problem = false;  // an error or a warning, not information
};
using Notices = std::vector<Notice>;  // oldest first

struct FaultEvent {
  double loop_time_s = 0.0;  // of the first
  std::string text;
  std::uint64_t count = 1;  // occurrences, each within a second of the one before
  double last_s = 0.0;      // loop time of the last
};

// The worst fault of one tick, for a mark on the curves.
enum class TickFaultLevel : std::uint8_t {
  none,
  late,   // deadlines were missed before the tick
  alarm,  // a fault of the loop or the device
};

// Newest last. A fault that follows one of the same kind within a second increments the count of that one. The action
// of the limiter while the force ramps up is not a fault.
class FaultLog {
 public:
  static constexpr std::size_t kMost = 200;
  // The loop has stalled if the last tick is older than this.
  static constexpr double kStall_s = 0.05;

  // Call it for every snapshot in order. Returns the worst fault of the snapshot.
  TickFaultLevel update(const LoopSnapshot& snapshot);
  // Call it once a frame. `dropped`: total number of snapshots lost so far. `age_s`: time since the last tick; a stall
  // is logged once, at its beginning.
  void update_window(std::uint64_t dropped, double age_s, double now_s);

  const std::vector<FaultEvent>& events() const noexcept { return events_; }

  // The share of missed deadlines, averaged exponentially over 10,000 deadlines (10 s).
  double missed_of_late() const noexcept { return missed_of_late_; }

  // The alarms since the last acknowledgement, those of the device first: the faults that are latched in `newest`,
  // and a stall.
  std::vector<std::string> alarms(const LoopSnapshot& newest) const;
  // Clears the alarm of a stall. LoopControls::acknowledged clears the latched faults.
  void acknowledge() noexcept { stall_unseen_ = false; }

 private:
  void note(const std::string& text, std::uint64_t count, double at_s);

  std::vector<FaultEvent> events_;
  std::uint32_t device_faults_ = 0;
  std::uint64_t missed_ = 0;
  double missed_of_late_ = 0.0;
  std::uint64_t dropped_ = 0;
  bool stalled_ = false, stall_unseen_ = false;
};

}  // namespace palpate
