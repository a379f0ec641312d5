// A histogram of durations in constant memory, with 32 bins for each factor of two, so that percentiles are accurate to
// 3.2 %. The maximum is exact.
#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace palpate {

struct TimePercentiles {
  std::uint64_t count = 0;
  double p50_us = 0.0;
  double p99_us = 0.0;
  double p99_9_us = 0.0;
  double max_us = 0.0;
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
