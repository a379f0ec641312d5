#include "engine/live/pacer.h"

#include <time.h>

#include <cerrno>

namespace palpate {

constexpr std::int64_t kNsPerS = 1'000'000'000;

std::int64_t steady_now_ns() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<std::int64_t>(now.tv_sec) * kNsPerS + now.tv_nsec;
}

void SteadyPacer::wait_until(std::int64_t deadline_ns) noexcept {
  const timespec until{deadline_ns / kNsPerS, deadline_ns % kNsPerS};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

void SteadyPacer::spin_until(std::int64_t deadline_ns) noexcept {
  while (now_ns() < deadline_ns) {
  }
}

}  // namespace palpate
