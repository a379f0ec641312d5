#include "engine/recording/press_direction.h"

#include <algorithm>
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
  double mean_N() const { return sum_N / static_cast<double>(count); }
};

// The mean of the outermost slice with samples, and the spread of the means of one end.
struct EndForce {
  double outermost_N = 0.0;
  double spread_N = 0.0;
};

EndForce end_force(const std::array<Slice, kSlices>& slices, bool low) {
  EndForce end;
  double lowest = HUGE_VAL;
  double highest = -HUGE_VAL;
  for (std::size_t i = kEndSlices; i-- > 0;) {
    const Slice& slice = slices[low ? i : kSlices - 1 - i];
    if (slice.count == 0) continue;
    end.outermost_N = slice.mean_N();
    lowest = std::min(lowest, slice.mean_N());
    highest = std::max(highest, slice.mean_N());
  }
  end.spread_N = highest - lowest;
  return end;
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
    const auto slice = static_cast<std::size_t>((row.position_m - lowest_m) * per_metre);
    slices[std::min(slice, kSlices - 1)].sum_N += row.force_N;
    ++slices[std::min(slice, kSlices - 1)].count;
  }
  const EndForce low = end_force(slices, true);
  const EndForce high = end_force(slices, false);
  const double low_N = std::abs(low.outermost_N);
  const double high_N = std::abs(high.outermost_N);
  const bool clear = std::min(low_N, high_N) < kShallowShare * std::max(low_N, high_N);
  const bool by_spread = std::max(low.spread_N, high.spread_N) > kClearRatio * std::min(low.spread_N, high.spread_N);
  if (!clear && !by_spread) return direction;
  direction.known = true;
  direction.position_flipped = clear ? high_N < low_N : high.spread_N < low.spread_N;
  direction.shallow_force_N = (direction.position_flipped ? high : low).outermost_N;
  direction.deep_force_N = (direction.position_flipped ? low : high).outermost_N;
  const EndForce& shallow = direction.position_flipped ? high : low;
  direction.certain =
      std::max(shallow.spread_N, std::abs(shallow.outermost_N)) < kAirShare * std::abs(direction.deep_force_N);
  direction.force_flipped = direction.deep_force_N < direction.shallow_force_N;
  return direction;
}

}  // namespace palpate
