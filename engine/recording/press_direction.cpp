#include "engine/recording/press_direction.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace palpate {
namespace {

constexpr std::size_t kSlices = 16;
// Slices of the range of positions that make up an end.
constexpr std::size_t kEndSlices = 4;
// An end whose force is below this share of the force at the other end is the shallow one. Above it an offset of the
// force may hide that.
constexpr double kShallowShare = 0.35;
// Free air: the force is below this share of the force at the deep end, and flat to this share.
constexpr double kAirShare = 0.1;
// The least ratio of the changes of force at the two ends that identifies the deep end.
constexpr double kClearRatio = 2.0;

struct Slice {
  double sum_N = 0.0;
  std::size_t count = 0;
};

// The mean force of the outermost slice, and the spread of the means of one end.
struct EndForce {
  double outermost_N = 0.0;
  double spread_N = 0.0;
};

EndForce end_force(const std::array<Slice, kSlices>& slices, bool low) {
  std::vector<double> means_N;
  for (std::size_t i = 0; i < kEndSlices; ++i) {
    const Slice& slice = slices[low ? i : kSlices - 1 - i];
    if (slice.count > 0) means_N.push_back(slice.sum_N / static_cast<double>(slice.count));
  }
  const auto [least_N, largest_N] = std::ranges::minmax(means_N);
  return {means_N.front(), largest_N - least_N};
}

}  // namespace

PressDirection find_press_direction(const std::vector<RecordingRow>& rows) {
  PressDirection direction;
  const auto [lowest, highest] = std::ranges::minmax(rows, {}, &RecordingRow::position_m);
  const double lowest_m = lowest.position_m;
  const double highest_m = highest.position_m;
  if (!(highest_m > lowest_m)) return direction;
  std::array<Slice, kSlices> slices{};
  const double per_metre = static_cast<double>(kSlices) / (highest_m - lowest_m);
  for (const RecordingRow& row : rows) {
    const auto index = static_cast<std::size_t>((row.position_m - lowest_m) * per_metre);
    Slice& slice = slices[std::min(index, kSlices - 1)];
    slice.sum_N += row.force_N;
    ++slice.count;
  }
  const EndForce low = end_force(slices, true);
  const EndForce high = end_force(slices, false);
  const double low_N = std::abs(low.outermost_N);
  const double high_N = std::abs(high.outermost_N);
  const bool clear = std::min(low_N, high_N) < kShallowShare * std::max(low_N, high_N);
  const bool by_spread = std::max(low.spread_N, high.spread_N) > kClearRatio * std::min(low.spread_N, high.spread_N);
  if (!clear && !by_spread) return direction;
  const bool flipped = clear ? high_N < low_N : high.spread_N < low.spread_N;
  const EndForce& shallow = flipped ? high : low;
  const EndForce& deep = flipped ? low : high;
  const double air_N = std::max(shallow.spread_N, std::abs(shallow.outermost_N));
  return {true,
          air_N < kAirShare * std::abs(deep.outermost_N),
          flipped,
          deep.outermost_N < shallow.outermost_N,
          shallow.outermost_N,
          deep.outermost_N};
}

}  // namespace palpate
