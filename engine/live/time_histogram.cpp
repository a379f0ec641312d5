#include "engine/live/time_histogram.h"

#include <algorithm>
#include <cmath>

namespace palpate {

TimePercentiles TimeHistogram::percentiles() const noexcept {
  constexpr double kUsPerNs = 1e-3;
  TimePercentiles result;
  std::array<std::uint64_t, kBins> cumulative;
  for (std::size_t i = 0; i < kBins; ++i) {
    cumulative[i] = result.count += counts_[i].load(std::memory_order_relaxed);
  }
  if (result.count == 0) return result;
  const std::uint64_t longest_ns = longest_ns_.load(std::memory_order_relaxed);
  // Nearest rank, from below.
  const auto at = [&](double share) {
    const auto rank = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(result.count)));
    const auto bin = static_cast<std::size_t>(std::ranges::lower_bound(cumulative, rank) - cumulative.begin());
    return kUsPerNs * static_cast<double>(std::min(top_of(bin), longest_ns));
  };
  result.p50_us = at(0.5);
  result.p99_us = at(0.99);
  result.p99_9_us = at(0.999);
  result.max_us = kUsPerNs * static_cast<double>(longest_ns);
  return result;
}

}  // namespace palpate
