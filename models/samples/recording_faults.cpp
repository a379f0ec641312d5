#include "models/samples/samples.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "engine/base/statistics.h"
#include "engine/tick/motion_estimator.h"

namespace palpate {
namespace {

using Rows = std::vector<RecordingRow>;
using Column = double RecordingRow::*;

// Fewer are single events, unless one of them is larger than this share of the range: a lost sample, a saturated word.
constexpr std::size_t kLeastDropouts = 3;
constexpr double kLargeShare = 0.25;
constexpr std::size_t kLeastUpdates = 50;

// Consecutive rows with one value.
struct Run {
  std::size_t begin = 0, end = 0;
  double value = 0.0;
};

std::vector<Run> runs_of(const Rows& rows, Column column) {
  std::vector<Run> runs;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (runs.empty() || rows[i].*column != runs.back().value) runs.push_back({i, i, rows[i].*column});
    runs.back().end = i + 1;
  }
  return runs;
}

// The distance of a run to the nearer of its neighbours' values if it exceeds, or is below, both; else 0.
double excursion(const std::vector<Run>& runs, std::size_t at) {
  const double before = runs[at].value - runs[at - 1].value, after = runs[at].value - runs[at + 1].value;
  return before * after > 0.0 ? std::min(std::abs(before), std::abs(after)) : 0.0;
}

double change_beside(const std::vector<Run>& runs, std::size_t at) {
  const auto change = [&](std::size_t a, std::size_t b) { return std::abs(runs[a].value - runs[b].value); };
  return std::max(change(at - 1, at + 1), std::min(change(at - 2, at - 1), change(at + 1, at + 2)));
}

// The scatter of a column around a row: the upper quartile of the distances of rows from the mean of their neighbours.
// A sensor may be noisier at a high force than in air.
double scatter_beside(const Rows& rows, Column column, std::size_t at) {
  constexpr std::size_t kReach = 32;
  std::vector<double> distances;
  for (std::size_t i = std::max(at, kReach + 1) - kReach; i + 1 < std::min(rows.size(), at + kReach); ++i)
    distances.push_back(std::abs(rows[i].*column - 0.5 * (rows[i - 1].*column + rows[i + 1].*column)));
  const std::size_t quartile = 3 * (distances.size() - 1) / 4;
  return nth_smallest(std::move(distances), quartile);
}

std::vector<Run> dropouts(const Rows& rows, Column column, double noise, bool is_position) {
  const std::vector<Run> runs = runs_of(rows, column);
  if (runs.size() < 5) return {};
  std::vector<double> excursions;
  for (std::size_t i = 1; i + 1 < runs.size(); ++i) excursions.push_back(excursion(runs, i));
  std::vector<double> of_rows = excursions;  // a row that repeats its value has none
  of_rows.resize(rows.size(), 0.0);
  // Six times the noise is exceeded by one row in 1e9 of white noise.
  const double least = 6.0 * std::max(noise, quantile_of(std::move(of_rows), 90));
  const auto [low, high] = std::ranges::minmax(rows, {}, column);
  const double large = kLargeShare * (high.*column - low.*column);
  bool certain = false;
  std::vector<std::pair<Run, bool>> candidates;  // and whether it is physically impossible
  std::map<double, std::size_t> values;
  for (std::size_t i = 2; i + 2 < runs.size(); ++i) {
    const Run& run = runs[i];
    const double size = excursions[i - 1];
    // The tip of a triangle wave exceeds the change beside it once.
    if (run.end - run.begin > 3 || !(size > least) || !(size > 3.0 * change_beside(runs, i))) continue;
    // Of white noise the quartile is 1.4 standard deviations.
    if (!(size > 8.0 * scatter_beside(rows, column, run.begin))) continue;
    const double half_s = 0.5 * (rows[run.end].time_s - rows[run.begin - 1].time_s);
    // A hand reaches some 50 m/s^2, a testing machine less.
    const bool impossible = is_position ? 2.0 * size > 100.0 * half_s * half_s : half_s < 0.01;
    certain = certain || (impossible && size > large);
    candidates.emplace_back(run, impossible);
    ++values[run.value];
  }
  std::vector<Run> found;
  std::size_t count = 0;
  for (const auto& [run, impossible] : candidates) {
    if (!impossible && values[run.value] < kLeastDropouts) continue;
    found.push_back(run);
    count += run.end - run.begin;
  }
  const bool few = static_cast<double>(count) <= 0.1 * static_cast<double>(rows.size());
  return (found.size() >= kLeastDropouts || certain) && few ? found : std::vector<Run>{};
}

// Marks the rows of the runs; returns their number.
std::size_t mark(const std::vector<Run>& runs, std::vector<bool>& out) {
  std::size_t count = 0;
  for (const Run& run : runs) {
    for (std::size_t i = run.begin; i < run.end; ++i) out[i] = true;
    count += run.end - run.begin;
  }
  return count;
}

// The intervals between the large changes of a channel, and the motion meanwhile.
struct Updates {
  std::vector<double> rows;  // of the runs between two large changes
  double inside_m = 0.0;     // sum of the motions within these runs
  double across_m = 0.0;     // sum of the motions from their last row to the next one
};

Updates updates_of(const Rows& rows, const std::vector<Run>& runs) {
  std::vector<double> changes;
  for (std::size_t i = 1; i < runs.size(); ++i) changes.push_back(std::abs(runs[i].value - runs[i - 1].value));
  const double large = 1.5 * quantile_of(changes, 0);  // steps of the channel
  Updates updates;
  for (std::size_t i = 1; i + 1 < runs.size(); ++i) {
    const Run& run = runs[i];
    if (!(changes[i - 1] > large) || !(changes[i] > large)) continue;
    updates.rows.push_back(static_cast<double>(run.end - run.begin));
    updates.inside_m += std::abs(rows[run.end - 1].position_m - rows[run.begin].position_m);
    updates.across_m += std::abs(rows[run.end].position_m - rows[run.end - 1].position_m);
  }
  return updates;
}

// The number of rows from one update of a channel to the next; 0 if every row may be an update.
double update_rows(const Rows& rows, Column column, const std::vector<Run>& runs) {
  if (runs.size() < kLeastUpdates) return 0.0;
  const Updates updates = updates_of(rows, runs);
  if (updates.rows.size() < kLeastUpdates / 2) return 0.0;
  std::vector<double> lengths;
  // The first and the last run are incomplete.
  for (std::size_t i = 1; i + 1 < runs.size(); ++i) lengths.push_back(static_cast<double>(runs[i].end - runs[i].begin));
  const double middle = quantile_of(updates.rows, 50);
  const double shortest = quantile_of(lengths, 5);  // shorter ones are jitter
  if (!(shortest >= 2.0) || shortest + 1.0 < 0.75 * middle) return 0.0;
  // A tool that moves in steps explains the steps of a force.
  if (column == &RecordingRow::force_N && updates.inside_m < 0.25 * updates.across_m) return 0.0;
  double sum = 0.0, count = 0.0;
  for (const double length : updates.rows) {
    if (length > 1.5 * middle) continue;  // two equal readings
    sum += length;
    count += 1.0;
  }
  return sum / count;
}

void keep_updates(Rows& rows, const std::vector<Run>& runs, double interval) {
  Rows kept;
  for (const Run& run : runs)
    for (double at = 0.0; at + 0.5 * interval < std::max(static_cast<double>(run.end - run.begin), interval);
         at += interval)
      kept.push_back(rows[std::min(run.begin + static_cast<std::size_t>(std::lround(at)), run.end - 1)]);
  rows = std::move(kept);
}

}  // namespace

RecordingFaults remove_faults(Recording& recording, const RecordingFaults& before) {
  RecordingFaults faults = before;
  Rows& rows = recording.rows;
  faults.rows += rows.size();
  if (rows.size() < kRecordingMinimumRows) return faults;
  const SensorSpec sensor = identify_sensor(rows.data(), rows.size(), recording.columns);
  const double position_noise_m = std::max(sensor.encoder_step_m, sensor.position_noise_m);
  std::vector<bool> out(rows.size(), false);
  faults.position_dropouts += mark(dropouts(rows, &RecordingRow::position_m, position_noise_m, true), out);
  faults.force_dropouts +=
      mark(dropouts(rows, &RecordingRow::force_N, identify_force_noise_N(rows.data(), rows.size()), false), out);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (!out[i]) rows[kept++] = rows[i];
  rows.resize(kept);
  // Of two slow channels the slower one determines the rows.
  double interval = 0.0;
  std::vector<Run> updates;
  for (const Column column : {&RecordingRow::position_m, &RecordingRow::force_N}) {
    std::vector<Run> runs = runs_of(rows, column);
    const double found = update_rows(rows, column, runs);
    if (!(found > interval)) continue;
    interval = found;
    faults.held_force = column == &RecordingRow::force_N;
    updates = std::move(runs);
  }
  if (interval == 0.0 || static_cast<double>(rows.size()) < interval * kRecordingMinimumRows) return faults;
  const double step_s = (rows.back().time_s - rows.front().time_s) / static_cast<double>(rows.size() - 1);
  faults.update_step_s = interval * step_s;
  keep_updates(rows, updates, interval);
  faults.updates += rows.size();
  return faults;
}

Result<Recording> read_usable_recording(const std::string& path) {
  auto recording = read_recording(path);
  if (recording) remove_faults(*recording);
  return recording;
}

}  // namespace palpate
