// Rows that share a time.
#include <algorithm>
#include <cmath>

#include "engine/base/statistics.h"
#include "engine/import/table_parts.h"

namespace palpate {
namespace {

// Fewer times do not show that they are regular. The first and the last one may have fewer rows.
constexpr std::size_t kLeastTimes = 6;
// Fewer rows for each time are single repetitions.
constexpr double kLeastRows = 1.5;
// The deviation from the mean that the jitter of a logger explains, at least one row; rows and steps may exceed it in
// one of twenty.
constexpr double kJitter = 0.15;
constexpr double kRegularShare = 0.95;
// A longer step is a pause, after which the rows are not evenly spaced.
constexpr double kPauseSteps = 1.5;

// Rows with one time.
struct Group {
  double time_s = 0.0, rows = 0.0;
};

bool is_regular(const std::vector<double>& values, double middle, double tolerance) {
  const auto near = std::ranges::count_if(values, [&](double value) { return std::abs(value - middle) <= tolerance; });
  return static_cast<double>(near) >= kRegularShare * static_cast<double>(values.size());
}

}  // namespace

RepeatedTimes find_repeated_times(const std::vector<RecordingRow>& rows) {
  RepeatedTimes found;
  std::vector<Group> groups;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (i == 0 || rows[i].time_s != rows[i - 1].time_s) {
      groups.push_back({rows[i].time_s, 1.0});
      continue;
    }
    groups.back().rows += 1.0;
    ++found.rows;
    found.copies =
        found.copies && rows[i].position_m == rows[i - 1].position_m && rows[i].force_N == rows[i - 1].force_N;
  }
  if (found.rows == 0 || groups.size() < kLeastTimes) return found;
  std::vector<double> steps_s, counts;
  double inner_rows = 0.0;
  for (std::size_t i = 1; i + 1 < groups.size(); ++i) {
    counts.push_back(groups[i].rows);
    steps_s.push_back(groups[i + 1].time_s - groups[i].time_s);
    inner_rows += groups[i].rows;
  }
  found.step_s = nth_smallest(steps_s, steps_s.size() / 2);
  found.mean_rate_Hz = inner_rows / (groups.back().time_s - groups[1].time_s);
  // The rows between two changes of the time are known to one row.
  const double whole_Hz = std::round(found.mean_rate_Hz);
  if (std::abs(whole_Hz - found.mean_rate_Hz) * inner_rows <= 2.0 * found.mean_rate_Hz) found.mean_rate_Hz = whole_Hz;
  const double mean_rows = inner_rows / static_cast<double>(counts.size());
  const bool even = mean_rows >= kLeastRows && is_regular(counts, mean_rows, std::max(1.0, kJitter * mean_rows)) &&
                    is_regular(steps_s, found.step_s, kJitter * found.step_s) &&
                    *std::ranges::max_element(steps_s) <= kPauseSteps * found.step_s;
  if (even) found.rate_Hz = found.mean_rate_Hz;
  return found;
}

}  // namespace palpate
