// The range of the training data, within which a simulated hand has to stay.
// Thread guarantee: pure function, slow side (allocates).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "engine/recording/recording.h"

namespace palpate {

struct PressRange {
  double strongest_N = 0.0;      // largest force
  double deepest_m = 0.0;        // largest depth
  double fastest_m_per_s = 0.0;  // 99th percentile of the speed in contact, over at least 20 ms
};

// Speeds are differences over at least 20 ms, to suppress encoder steps. The fastest 1 % are ignored as noise.
inline PressRange press_range(const std::vector<Recording>& recordings) {
  constexpr double kSpan_s = 0.02;
  PressRange range;
  std::vector<double> speeds;
  for (const Recording& recording : recordings) {
    std::size_t first = 0;
    for (const RecordingRow& row : recording.rows) {
      range.strongest_N = std::max(range.strongest_N, row.force_N);
      range.deepest_m = std::max(range.deepest_m, row.position_m);
      const RecordingRow& before = recording.rows[first];
      if (row.time_s - before.time_s < kSpan_s) continue;
      if (row.position_m > 0.0)
        speeds.push_back(std::abs(row.position_m - before.position_m) / (row.time_s - before.time_s));
      first = static_cast<std::size_t>(&row - recording.rows.data());
    }
  }
  if (speeds.empty()) return range;
  const auto fast = speeds.begin() + static_cast<std::ptrdiff_t>(99 * (speeds.size() - 1) / 100);
  std::nth_element(speeds.begin(), fast, speeds.end());
  range.fastest_m_per_s = *fast;
  return range;
}

}  // namespace palpate
