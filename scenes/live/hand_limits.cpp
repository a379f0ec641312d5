#include "scenes/live/hand_limits.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace palpate {

bool limit_hand(const std::vector<Recording>& recordings, HandSettings& hand) {
  constexpr double kInside = 0.8;  // of the largest values, because the simulated hand overshoots
  constexpr double kSpan_s = 0.02;
  double strongest_N = 0.0, deepest_m = 0.0;
  std::vector<double> speeds_m_per_s;  // in contact
  for (const Recording& recording : recordings) {
    RecordingRow before = recording.rows.front();
    for (const RecordingRow& row : recording.rows) {
      strongest_N = std::max(strongest_N, row.force_N);
      deepest_m = std::max(deepest_m, row.position_m);
      const double span_s = row.time_s - before.time_s;
      if (span_s < kSpan_s) continue;
      if (row.position_m > 0.0) speeds_m_per_s.push_back(std::abs(row.position_m - before.position_m) / span_s);
      before = row;
    }
  }
  if (strongest_N <= 0.0) return false;
  hand.strongest_press_N = kInside * strongest_N;
  if (deepest_m > 0.0) hand.deepest_m = kInside * deepest_m;
  if (speeds_m_per_s.empty()) return true;
  const auto fast = speeds_m_per_s.begin() + static_cast<std::ptrdiff_t>(99 * (speeds_m_per_s.size() - 1) / 100);
  std::nth_element(speeds_m_per_s.begin(), fast, speeds_m_per_s.end());
  hand.fastest_m_per_s = kInside * *fast;
  return true;
}

}  // namespace palpate
