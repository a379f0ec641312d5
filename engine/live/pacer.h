// The time of the haptics thread: real-time scheduling, absolute deadlines, waiting for them, and the durations of
// ticks.
#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <string>

namespace palpate {

struct RtStatus {
  bool realtime = false;   // SCHED_FIFO obtained
  std::string scheduling;  // for reports: "SCHED_FIFO 80", "normal"
  std::string fix;         // advice; empty if nothing was refused
};

// The advice for refused requests, empty without one. The errors are errno values, 0 if granted.
std::string realtime_advice(int priority_error, int memory_error, bool is_root);

// Sets the timer slack of the calling thread to 1 ns (default: 50 us), so that sleeps end on time. Needs no privilege.
void set_timer_slack_1ns() noexcept;

// For the calling thread before its first tick: sets timer slack 1 ns and SCHED_FIFO with `priority`, 1 to 99 (the
// default is above most threads and below the kernel's own 99), locks memory (of the whole process, pages on first use)
// and touches 256 KiB of stack. Blocking, allocates.
RtStatus make_this_thread_realtime(int priority = 80, bool lock_memory = true);

struct Wake {
  std::int64_t lateness_ns = 0;  // after the deadline, >= 0
  std::uint64_t missed = 0;      // number of later deadlines that have passed, which are skipped
};

// Absolute deadlines, one period apart. Value type, no clock; wait-free.
class Deadlines {
 public:
  Deadlines(std::int64_t start_ns, std::int64_t period_ns) noexcept
      : next_ns_(start_ns + period_ns), period_ns_(period_ns) {}

  std::int64_t next_ns() const noexcept { return next_ns_; }

  // To be called when the loop continues at `now_ns` after waiting for `next_ns()`. The next deadline is then the first
  // one after `now_ns`, on the same grid.
  Wake wake(std::int64_t now_ns) noexcept {
    Wake wake;
    if (now_ns > next_ns_) wake.lateness_ns = now_ns - next_ns_;
    wake.missed = static_cast<std::uint64_t>(wake.lateness_ns / period_ns_);
    next_ns_ += (static_cast<std::int64_t>(wake.missed) + 1) * period_ns_;
    return wake;
  }

 private:
  std::int64_t next_ns_, period_ns_;
};

// A clock and a way to wait on it. Haptics thread; never throws, never allocates.
class Pacer {
 public:
  virtual ~Pacer() = default;
  virtual std::int64_t now_ns() noexcept = 0;
  // Returns at `deadline_ns` or later; at once when it has passed.
  virtual void wait_until(std::int64_t deadline_ns) noexcept = 0;
  // The same by spinning, for short times.
  virtual void spin_until(std::int64_t deadline_ns) noexcept { wait_until(deadline_ns); }
};

// The clock of all times of the program, CLOCK_MONOTONIC. Any thread, wait-free.
std::int64_t steady_now_ns() noexcept;
inline double steady_now_s() noexcept { return 1e-9 * static_cast<double>(steady_now_ns()); }

class SteadyPacer final : public Pacer {
 public:
  std::int64_t now_ns() noexcept override { return steady_now_ns(); }
  void wait_until(std::int64_t deadline_ns) noexcept override;
  void spin_until(std::int64_t deadline_ns) noexcept override;
};

struct TimePercentiles {
  std::uint64_t count = 0;
  double p50_us = 0.0, p99_us = 0.0, p99_9_us = 0.0, max_us = 0.0;
};

class TimeHistogram {
 public:
  // One writer thread. Wait-free. Negative times count as zero.
  void add(std::int64_t time_ns) noexcept {
    const auto value = static_cast<std::uint64_t>(time_ns > 0 ? time_ns : 0);
    std::atomic<std::uint64_t>& counter = counts_[bin_of(value)];
    counter.store(counter.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    if (value > longest_ns_.load(std::memory_order_relaxed)) longest_ns_.store(value, std::memory_order_relaxed);
  }

  // Any thread, wait-free, also while the writer adds; the last few times may then be missing. O(bins).
  TimePercentiles percentiles() const noexcept;

 private:
  static constexpr std::size_t kShift = 5;
  static constexpr std::uint64_t kPerDoubling = 1U << kShift;
  static constexpr std::size_t kBins = (64 - kShift + 1) << kShift;

  // One bin each below 32 ns; above, the leading bit and the five that follow determine the bin.
  static std::size_t bin_of(std::uint64_t value) noexcept {
    if (value < kPerDoubling) return static_cast<std::size_t>(value);
    const auto doubling = static_cast<std::size_t>(std::bit_width(value)) - kShift - 1;
    return (doubling << kShift) + static_cast<std::size_t>(value >> doubling);
  }
  // The largest value that falls into `bin`.
  static std::uint64_t top_of(std::size_t bin) noexcept {
    if (bin < 2 * kPerDoubling) return bin;
    const std::size_t doubling = (bin >> kShift) - 1;
    return ((bin - (doubling << kShift) + 1) << doubling) - 1;
  }

  std::array<std::atomic<std::uint64_t>, kBins> counts_{};
  std::atomic<std::uint64_t> longest_ns_{0};
};

}  // namespace palpate
