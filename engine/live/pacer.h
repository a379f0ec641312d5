// Absolute deadlines, and waiting for them.
#pragma once

#include <cstdint>

namespace palpate {

// The result of waiting for a deadline.
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
  std::int64_t next_ns_;
  std::int64_t period_ns_;
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

// A pacer of the steady clock.
class SteadyPacer final : public Pacer {
 public:
  std::int64_t now_ns() noexcept override { return steady_now_ns(); }
  void wait_until(std::int64_t deadline_ns) noexcept override;
  void spin_until(std::int64_t deadline_ns) noexcept override;
};

}  // namespace palpate
