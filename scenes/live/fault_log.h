// What went wrong in the loop, in words, newest last. A fault that follows one of its kind within a second
// counts there. The limiter holding back while the force ramps is no fault.
// Thread guarantee: one thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/live/live_tick.h"

namespace palpate {

struct FaultEvent {
  double loop_time_s = 0.0;  // of the first
  std::string text;          // in words
  std::uint64_t count = 1;   // of the same kind that followed within a second
  bool alarm = true;         // else: counted, but nobody needs to be told at once
  double last_s = 0.0;       // loop time of the last
};

// What was wrong with one tick, for a mark on the curves.
enum class TickTrouble : std::uint8_t {
  none,
  late,   // deadlines were missed before it
  alarm,  // anything worse
};

class FaultLog {
 public:
  static constexpr std::size_t kMost = 200;
  // An older last tick is a stall.
  static constexpr double kStall_s = 0.05;

  // Every snapshot in order; what it holds.
  TickTrouble update(const LoopSnapshot& snapshot);
  // `dropped`: snapshots lost so far, in all.
  void update_dropped(std::uint64_t dropped, double now_s);
  // `age_s`: of the last tick. A stall counts once, however long.
  void update_age(double age_s, double now_s);

  const std::vector<FaultEvent>& events() const noexcept { return events_; }

  // The share of missed deadlines over some ten seconds; older ones fade.
  double missed_of_late() const noexcept { return missed_of_late_; }

  // What has been an alarm since the last `acknowledge`, the device's first; `newest` has what the loop latched.
  std::vector<std::string> alarms(const LoopSnapshot& newest) const;
  // The user has seen the alarms; the loop is told by LoopControls::acknowledged.
  void acknowledge() noexcept { stall_unseen_ = false; }

 private:
  void update_device(std::uint32_t faults, double at_s);
  void note(std::size_t kind, std::uint64_t count, double at_s);

  std::vector<FaultEvent> events_;
  std::uint32_t device_faults_ = 0;
  std::uint64_t missed_ = 0;
  double missed_of_late_ = 0.0;
  std::uint64_t dropped_ = 0;
  bool stalled_ = false;
  bool stall_unseen_ = false;
};

}  // namespace palpate
