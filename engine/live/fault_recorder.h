// The last second of ticks before a fault, kept for inspection: what the tool
// did, what the models asked for, what the device got.
//
// Two rings, both allocated at the start. The haptics thread fills one; a while
// after a fault, so that the way to no force is in it, it hands that ring over
// and goes on with the other. While the slow side has not taken it, later faults
// are counted and not kept.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "engine/base/result.h"

namespace palpate {

// One tick as the fault file shows it.
struct FaultTick {
  double loop_time_s = 0.0;
  double sample_time_s = 0.0;
  double position_m = 0.0;
  double velocity_m_per_s = 0.0;
  double commanded_N = 0.0;  // of the models
  double rendered_N = 0.0;   // of the limiter
  double sample_age_s = 0.0;
  double round_trip_s = 0.0;        // NaN: not measured
  std::uint32_t faults = 0;         // loop_fault
  std::uint32_t device_faults = 0;  // device_fault
  std::uint32_t limiter_flags = 0;  // force_limit
  std::uint32_t samples = 0;        // taken in this tick
};
static_assert(std::is_trivially_copyable_v<FaultTick>);

class FaultRecorder {
 public:
  static constexpr std::size_t kTicks = 1000;
  static constexpr std::size_t kTicksAfter = 100;  // of these, after the fault

  // Slow side.
  FaultRecorder() : rings_{std::vector<FaultTick>(kTicks), std::vector<FaultTick>(kTicks)} {}

  // Haptics thread, wait-free. `fault`: one that takes the force away; it counts
  // when it was not there in the tick before.
  void add(const FaultTick& tick, bool fault) noexcept;
  // Haptics thread, wait-free, at its end: a fault that just happened is handed
  // over without the ticks that would have followed.
  void finish() noexcept;

  // One slow-side thread: the ticks of the oldest fault that was not taken yet,
  // oldest first, the fault's first tick kTicksAfter before the end (less when
  // the loop ended).
  std::optional<std::vector<FaultTick>> read();

  // Any thread. Faults whose ticks were lost.
  std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

 private:
  void publish() noexcept;

  std::vector<FaultTick> rings_[2];
  std::size_t ends_[2] = {0, 0};    // where the next tick goes
  std::size_t counts_[2] = {0, 0};  // ticks in it
  std::size_t active_ = 0;
  std::size_t left_ = 0;  // ticks until the hand-over; 0: no fault
  bool in_fault_ = false;
  std::atomic<int> handed_{-1};  // the ring that the slow side owns
  std::atomic<std::uint64_t> dropped_{0};
};

// The file of one fault: a header that names the columns, one line a tick.
// Errors: as AtomicFile, never writes over.
Status write_fault_file(const std::string& path, const std::vector<FaultTick>& ticks);

}  // namespace palpate
