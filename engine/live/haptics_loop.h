// The haptics thread: a LiveTick every millisecond, by absolute deadlines.
//
// Deadline k is start + k x 1 ms, however long a tick took. Deadlines that have
// passed when the loop gets to them are counted as missed and skipped, never
// made up in a burst. Nothing is shared with other threads but a TripleBuffer
// each way, an SpscRing of snapshots and one of samples, the ModelSlot and counters.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

#include "engine/live/live_tick.h"
#include "engine/live/pacer.h"
#include "engine/live/rt_thread.h"
#include "engine/live/spsc_ring.h"
#include "engine/live/time_histogram.h"
#include "engine/live/triple_buffer.h"

namespace palpate {

struct LoopSettings {
  std::int64_t period_ns = 1'000'000;
  // How long before a deadline the thread wakes up, to rehearse the tick, again in the last
  // quarter of it, and to spin: the first evaluations after a pause pay for what the caches
  // have lost, and a sleep ends late. 0: it sleeps until the deadline.
  std::int64_t rehearse_ns = 0;
  bool realtime = true;  // ask for it
  JndLine jnd;
  ForceSource* source = nullptr;  // outlives the loop; null: the models
};

struct LoopStatistics {
  std::uint64_t ticks = 0;
  std::uint64_t missed_deadlines = 0;   // skipped
  std::uint64_t dropped_snapshots = 0;  // the ring was full
  TimePercentiles lateness;             // of each tick's deadline
  TimePercentiles tick;                 // duration of a tick, publishing included
  double age_s = 0.0;                   // since the last tick ended; a stall shows here
};

// Snapshots the ring holds: four seconds.
inline constexpr std::size_t kSnapshotRing = 4096;

class HapticsLoop {
 public:
  // Slow side. `device` outlives this and is open; nobody else uses it.
  HapticsLoop(Device& device, const LoopSettings& settings = {});
  HapticsLoop(const HapticsLoop&) = delete;
  HapticsLoop& operator=(const HapticsLoop&) = delete;
  // Stops.
  ~HapticsLoop();

  // Slow side, blocking until the thread is about to tick. Once. Publish a first
  // set of models before, so that the warm-up warms it. Errors: no thread.
  Status start();
  // Slow side, blocking: lets the force go to zero, then ends the thread. May be
  // called again.
  void stop();
  // Slow side, after `start`: what the thread was granted.
  const RtStatus& scheduling() const noexcept { return scheduling_; }

  // One slow-side thread, lock-free: models for the next ticks, see ModelSlot.
  void publish_models(std::unique_ptr<LiveModels> models) { slot_.publish(std::move(models)); }
  // The same thread: deletes the sets that the loop has done with. Call it now
  // and then.
  std::size_t collect_models() { return slot_.collect(); }

  // One slow-side thread, wait-free.
  void set_controls(const LoopControls& controls) noexcept { controls_.write(controls); }

  // One reader thread, wait-free. The newest snapshot.
  const LoopSnapshot& newest() noexcept { return newest_.newest(); }
  // One reader thread, wait-free, O(most). Every snapshot, oldest first.
  std::size_t read_snapshots(LoopSnapshot* snapshots, std::size_t most) noexcept { return ring_->pop(snapshots, most); }

  // One reader thread, the recorder's, wait-free, O(most). Every sample that was
  // taken while the controls asked for a recording, oldest first.
  std::size_t read_samples(RecordedSample* samples, std::size_t most) noexcept { return recorded_->pop(samples, most); }
  // Any thread, wait-free. Samples that found no room since the beginning.
  std::uint64_t dropped_samples() const noexcept { return recorded_->dropped(); }

  // Any thread, wait-free; the figures of `statistics` that cost nothing.
  std::uint64_t dropped_snapshots() const noexcept { return ring_->dropped(); }
  double age_s() const noexcept;

  // Any thread, wait-free.
  LoopStatistics statistics() const noexcept;

  // The loop itself on the calling thread, until `request_stop`; `start` runs it on
  // its own. For tests, with a clock of their own.
  void run(Pacer& pacer) noexcept;
  // Any thread, the pacer's `wait_until` included. Wait-free.
  void request_stop() noexcept { stop_.store(true, std::memory_order_relaxed); }

 private:
  void wait_for(Pacer& pacer, std::int64_t deadline_ns) noexcept;
  void tick(Pacer& pacer, const Wake& wake, std::int64_t woke_ns) noexcept;
  void let_go(Pacer& pacer, Deadlines& deadlines) noexcept;

  Device& device_;
  std::unique_ptr<RecordedRing> recorded_;
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
  std::uint64_t missed_ = 0;
  float last_tick_us_ = 0.0F;
  std::atomic<std::uint64_t> published_missed_{0};
  std::atomic<std::uint64_t> ticks_{0};
  std::atomic<std::int64_t> last_tick_ns_{0};
  std::atomic<bool> stop_{false};
};

}  // namespace palpate
