#include "engine/base/cycle_clock.h"

#include <algorithm>

namespace palpate {
namespace {

double measure() {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  const std::uint64_t first = cycle_count();
  while (Clock::now() - start < std::chrono::milliseconds(2)) {
  }
  const std::uint64_t last = cycle_count();
  const std::chrono::duration<double, std::nano> elapsed = Clock::now() - start;
  return elapsed.count() / static_cast<double>(std::max<std::uint64_t>(1, last - first));
}

}  // namespace

double ns_per_cycle() {
  static const double measured = measure();
  return measured;
}

}  // namespace palpate
