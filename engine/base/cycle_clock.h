// A clock for single evaluations in the tick: the processor's counter if it has a constant rate (x86-64, arm64), else
// the steady clock. `ns_per_cycle` measures its unit.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#if defined(__x86_64__)
#include <x86intrin.h>
#endif

namespace palpate {

// Any thread, wait-free, no system call.
inline std::uint64_t cycle_count() noexcept {
#if defined(__x86_64__)
  return __rdtsc();
#elif defined(__aarch64__)
  std::uint64_t count;
  asm volatile("mrs %0, cntvct_el0" : "=r"(count));
  return count;
#else
  return static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count());
#endif
}

// Slow side: measures for 2 ms at the first call and stores the result. Accurate to about 0.1 %.
inline double ns_per_cycle() {
  static const double measured = [] {
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    const std::uint64_t first = cycle_count();
    while (Clock::now() - start < std::chrono::milliseconds(2)) {
    }
    const std::uint64_t last = cycle_count();
    const std::chrono::duration<double, std::nano> elapsed = Clock::now() - start;
    return elapsed.count() / static_cast<double>(std::max<std::uint64_t>(1, last - first));
  }();
  return measured;
}

}  // namespace palpate
