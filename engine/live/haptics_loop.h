// The haptics thread: a LiveTick every millisecond, by absolute deadlines. One that has passed is counted as missed and
// skipped. The loop shares with other threads only a TripleBuffer each way, an SpscRing of snapshots, one of samples,
// the ModelSlot and counters.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <thread>

#include "engine/base/result.h"
#include "engine/live/handover.h"
#include "engine/live/live_tick.h"
#include "engine/live/pacer.h"

namespace palpate {

struct LoopSettings : LiveTickSettings {
  // Time before a deadline at which the thread wakes up, rehearses the tick twice and spins: without it, the first
  // evaluations after a pause have cold caches, and a sleep ends late. 0: the thread sleeps until the deadline.
  std::int64_t rehearse_ns = 0;
  bool realtime = true;  // request real-time scheduling
};

struct LoopStatistics {
  std::uint64_t ticks = 0;
  std::uint64_t missed_deadlines = 0;   // skipped deadlines
  std::uint64_t dropped_snapshots = 0;  // because the ring was full
  TimePercentiles lateness;             // after each tick's deadline
  TimePercentiles tick;                 // duration of a tick, publishing included
  double age_s = 0.0;                   // since the last tick ended; large in a stall
};

inline constexpr std::size_t kSnapshotRing = 4096;  // four seconds

class HapticsLoop {
 public:
  // Slow side. `device` must be open, outlive this and not be used elsewhere.
  HapticsLoop(Device& device, const LoopSettings& settings = {});
  ~HapticsLoop() { stop(); }

  // Slow side, blocks until the scheduling is set. Once. A first set of models should be published before, for the
  // warm-up. Errors: the thread cannot be started.
  Status start();
  // Slow side, blocking: reduces the force to 0, then ends the thread. May be called again.
  void stop();
  // Slow side, after `start`: the scheduling that the system granted.
  const RtStatus& scheduling() const noexcept { return scheduling_; }

  // One slow-side thread, lock-free: models for the next ticks, see ModelSlot.
  void publish_models(std::unique_ptr<LiveModels> models) { slot_.publish(std::move(models)); }
  // The same thread: deletes a set that the loop no longer uses. To be called from time to time: until then the loop
  // takes no other set.
  void collect_models() { slot_.collect(); }

  // One slow-side thread, wait-free.
  void set_controls(const LoopControls& controls) noexcept { controls_.write(controls); }

  // One reader thread, wait-free. The newest snapshot.
  const LoopSnapshot& newest() noexcept { return newest_.newest(); }
  // One reader thread, wait-free, O(most). Every snapshot, oldest first.
  std::size_t read_snapshots(LoopSnapshot* snapshots, std::size_t most) noexcept { return ring_->pop(snapshots, most); }

  // One reader thread, the recorder's. Every sample that was read while the controls requested a recording.
  RecordedRing& recorded() noexcept { return live_.recorded(); }

  // Any thread, wait-free.
  LoopStatistics statistics() const noexcept;

  // The loop on the calling thread, until `request_stop`; `start` calls it on a new thread. For tests, with their own
  // clock.
  void run(Pacer& pacer) noexcept;
  // Any thread, also from the pacer's `wait_until`. Wait-free.
  void request_stop() noexcept { stop_.store(true, std::memory_order_relaxed); }

 private:
  void wait_for(Pacer& pacer, std::int64_t deadline_ns) noexcept;
  void tick(Pacer& pacer, const Wake& wake, std::int64_t woke_ns) noexcept;
  void let_go(Pacer& pacer, Deadlines& deadlines) noexcept;

  Device& device_;
  LoopSettings settings_;
  ModelSlot<LiveModels> slot_;
  LiveTick live_;
  SteadyPacer pacer_;
  RtStatus scheduling_;
  std::thread thread_;

  TripleBuffer<LoopControls> controls_;
  TripleBuffer<LoopSnapshot> newest_;
  std::unique_ptr<SpscRing<LoopSnapshot, kSnapshotRing>> ring_;  // 2 MB: too much for a stack
  TimeHistogram lateness_;
  TimeHistogram duration_;
  std::atomic<std::uint64_t> missed_{0};
  std::atomic<std::int64_t> last_tick_ns_{0};  // 0: no tick yet
  std::atomic<bool> stop_{false};
};

// Keeps the last second of ticks up to kTicksAfter after the beginning of a fault. One slow-side thread.
class FaultRecorder {
 public:
  static constexpr std::size_t kTicks = 1000, kTicksAfter = 100;

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
