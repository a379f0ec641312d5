#include "models/check/recording_measures.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "engine/base/statistics.h"

namespace palpate {
namespace {

// Shares of the greatest depth. A force that grows with depth to the power 1.5 (Hertz) changes by 3 % in a hold and by
// 7.5 % in the smallest stroke, on either side of the Weber fraction of force, 6.33 %. A small stroke turns before half
// of the depth, so that it stays in the material.
constexpr double kHoldShare = 0.02;
constexpr double kSmallestStroke = 0.05;
constexpr double kLargestSmallStroke = 0.4;
// A speed is the displacement over this time, so that encoder steps do not look like motion.
constexpr double kSpeedWindow_s = 0.02;
// A stroke is a motion inwards by this share of the greatest depth after one outwards by as much: independent of the
// sampling rate, and neither noise nor creep.
constexpr double kStrokeShare = 0.15;
constexpr std::size_t kShortestFlat = 3;
constexpr double kHighForces = 0.5;  // of the greatest
constexpr double kMostSteps = 0.9;
constexpr std::size_t kMostSamples = 10000;  // of a recording in the noise floor; of a longer one every n-th is used

void measure_sampling(const std::vector<RecordingRow>& rows, RecordingMeasures& measures) {
  std::vector<double> steps_s;
  steps_s.reserve(rows.size());
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const double step_s = rows[i].time_s - rows[i - 1].time_s;
    steps_s.push_back(step_s);
    if (step_s <= measures.largest_step_s) continue;
    measures.largest_step_s = step_s;
    measures.largest_step_at_s = rows[i - 1].time_s;
  }
  measures.median_step_s = median_of(std::move(steps_s));
  measures.duration_s = rows.back().time_s - rows.front().time_s;
}

// Runs of rows with one force. Those at the greatest force are flat tops, and the others, above half of it, show how
// far the tool moves within one step of a quantised or held force.
void measure_flat_tops(const std::vector<RecordingRow>& rows, RecordingMeasures& measures) {
  std::vector<double> step_travels_m;
  for (std::size_t i = 0; i < rows.size();) {
    const std::size_t begin = i;
    const double force_N = rows[i].force_N;
    double low_m = rows[i].position_m, high_m = rows[i].position_m;
    for (; i < rows.size() && rows[i].force_N == force_N; ++i) {
      low_m = std::min(low_m, rows[i].position_m);
      high_m = std::max(high_m, rows[i].position_m);
    }
    if (force_N < measures.highest_force_N) {
      if (force_N > kHighForces * measures.highest_force_N) step_travels_m.push_back(high_m - low_m);
    } else if (i - begin >= kShortestFlat) {
      measures.flat_rows += i - begin;
      measures.flat_travel_m = std::max(measures.flat_travel_m, high_m - low_m);
    }
  }
  if (step_travels_m.empty()) return;
  const auto count = static_cast<double>(step_travels_m.size() - 1);
  measures.step_travel_m = nth_smallest(step_travels_m, static_cast<std::size_t>(kMostSteps * count));
}

// Divides a motion into strokes in and out. A stroke ends when the depth has come back from its extreme by more than
// `least_m`.
struct Strokes {
  double least_m;
  bool inwards;
  double begin_m = 0.0, extreme_m = 0.0;

  // The length of the stroke that ends with this depth.
  std::optional<double> end_at(double depth_m) {
    extreme_m = inwards ? std::max(extreme_m, depth_m) : std::min(extreme_m, depth_m);
    if (!(std::abs(extreme_m - depth_m) > least_m)) return std::nullopt;
    inwards = !inwards;
    const double length_m = std::abs(extreme_m - std::exchange(begin_m, extreme_m));
    extreme_m = depth_m;
    return length_m;
  }
};

// The mean force of the `count` rows before row `end`.
double mean_force_N(const std::vector<RecordingRow>& rows, std::size_t end, std::size_t count) {
  double sum_N = 0.0;
  for (std::size_t i = end - count; i < end; ++i) sum_N += rows[i].force_N;
  return sum_N / static_cast<double>(count);
}

void measure_motion(const std::vector<RecordingRow>& rows, RecordingMeasures& measures) {
  const double surface_m = measures.outermost_contact_m;
  const double deepest_m = std::max(0.0, measures.highest_position_m - surface_m);
  Strokes strokes{kStrokeShare * deepest_m, false};
  Strokes small_strokes{kSmallestStroke * deepest_m, true};  // in contact
  double hold_m = HUGE_VAL;
  std::size_t hold_first = 0, longest_first = 0, longest_last = 0;  // rows
  std::size_t before = 0;                                           // the first row of the window of the speed
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const RecordingRow& row = rows[i];
    while (before + 1 < i && row.time_s - rows[before].time_s > kSpeedWindow_s) ++before;
    const double depth_m = row.position_m - surface_m;
    if (strokes.end_at(std::max(0.0, depth_m)) && strokes.inwards) ++measures.strokes;
    if (!(depth_m > 0.0)) {
      hold_m = HUGE_VAL;
      continue;
    }
    ++measures.contact_rows;
    const double step_s = i > 0 ? row.time_s - rows[i - 1].time_s : 0.0;
    const double window_s = row.time_s - rows[before].time_s;
    const double speed_m_per_s = window_s > 0.0 ? (row.position_m - rows[before].position_m) / window_s : 0.0;
    (speed_m_per_s > 0.0 ? measures.inward_travel_m : measures.outward_travel_m) += std::abs(speed_m_per_s) * step_s;
    const auto quarter = static_cast<std::size_t>(depth_m / deepest_m * static_cast<double>(kDepthQuarters));
    const auto band = static_cast<std::size_t>(
        std::upper_bound(kSpeedEdges_per_s.begin(), kSpeedEdges_per_s.end(), std::abs(speed_m_per_s) / deepest_m) -
        kSpeedEdges_per_s.begin());
    measures.seconds[std::min(quarter, kDepthQuarters - 1)][band] += std::min(step_s, 10.0 * measures.median_step_s);
    const double length_m = small_strokes.end_at(depth_m).value_or(0.0);
    if (length_m > kSmallestStroke * deepest_m && length_m < kLargestSmallStroke * deepest_m) ++measures.small_strokes;
    if (std::abs(row.position_m - hold_m) > kHoldShare * deepest_m) {
      hold_m = row.position_m;
      hold_first = i;
    }
    if (row.time_s - rows[hold_first].time_s > measures.longest_hold_s) {
      measures.longest_hold_s = row.time_s - rows[hold_first].time_s;
      longest_first = hold_first;
      longest_last = i;
    }
  }
  const std::size_t held = longest_last - longest_first;
  const std::size_t averaged = held / 10 + 1;
  measures.hold_end_N = mean_force_N(rows, longest_last + 1, averaged);
  measures.hold_change_N = measures.hold_end_N - mean_force_N(rows, longest_first + held / 2 + averaged, averaged);
}

}  // namespace

RecordingMeasures measure_recording(const Recording& recording, double surface_m) {
  RecordingMeasures measures;
  const auto& rows = recording.rows;
  measure_sampling(rows, measures);
  const auto [outermost, deepest] = std::ranges::minmax(rows, {}, &RecordingRow::position_m);
  measures.lowest_position_m = outermost.position_m;
  measures.highest_position_m = deepest.position_m;
  const auto [weakest, strongest] = std::ranges::minmax(rows, {}, &RecordingRow::force_N);
  measures.lowest_force_N = weakest.force_N;
  measures.highest_force_N = strongest.force_N;
  measure_flat_tops(rows, measures);
  measures.outermost_contact_m = std::max(surface_m, measures.lowest_position_m);
  measure_motion(rows, measures);
  return measures;
}

double white_force_noise_N(const PreparedRecording& prepared) {
  constexpr double kQuietShare = 0.87;
  return prepared.force_noise_N / kQuietShare;
}

namespace {

constexpr std::size_t kLeastRows = 10;  // of a median

// The free air of a recording whose force zero drifts: that of the forces from which those of the outermost tenth of
// each time that the tool is out are subtracted, as medians of an eighth of their rows, interpolated over time.
FreeAir air_of_levelled(const Recording& recording) {
  constexpr std::size_t kParts = 8;
  Recording level = recording;
  const auto& rows = recording.rows;
  const auto [low, high] = std::ranges::minmax(rows, {}, &RecordingRow::position_m);
  const double middle_m = 0.5 * (low.position_m + high.position_m);
  std::vector<std::pair<double, double>> points;  // s, N
  for (std::size_t begin = 0, end; begin < rows.size(); begin = end + 1) {
    double outermost_m = middle_m;
    for (end = begin; end < rows.size() && rows[end].position_m < middle_m; ++end)
      outermost_m = std::min(outermost_m, rows[end].position_m);
    std::vector<RecordingRow> out;
    for (std::size_t i = begin; i < end; ++i)
      if (rows[i].position_m < outermost_m + 0.1 * (middle_m - outermost_m)) out.push_back(rows[i]);
    const std::size_t parts = std::min(kParts, out.size() / kLeastRows);
    for (std::size_t k = 0; k < parts; ++k) {
      std::vector<double> forces_N;
      const std::size_t first = k * out.size() / parts, last = (k + 1) * out.size() / parts;
      for (std::size_t i = first; i < last; ++i) forces_N.push_back(out[i].force_N);
      points.emplace_back(out[(first + last) / 2].time_s, median_of(std::move(forces_N)));
    }
  }
  if (points.size() < 3) return {};
  std::size_t after = 1;
  for (RecordingRow& row : level.rows) {
    while (after + 1 < points.size() && points[after].first < row.time_s) ++after;
    const auto& [from_s, from_N] = points[after - 1];
    const auto& [to_s, to_N] = points[after];
    const double share = std::clamp((row.time_s - from_s) / std::max(to_s - from_s, 1e-9), 0.0, 1.0);
    row.force_N -= from_N + share * (to_N - from_N);
  }
  return prepare_recording(std::move(level))->surface.air;
}

}  // namespace

ZeroDrift find_zero_drift(const PreparedRecording& prepared) {
  constexpr std::size_t kGroups = 24;
  FreeAir air = air_of_levelled(prepared.recording);
  if (const FreeAir& own = prepared.surface.air; own.found && (!air.found || own.inner_end_m > air.inner_end_m))
    air = own;
  std::vector<RecordingRow> rows;
  for (const RecordingRow& row : prepared.recording.rows)
    if (air.found && row.position_m < air.inner_end_m) rows.push_back(row);
  const std::size_t count = std::min(kGroups, rows.size() / kLeastRows);
  if (count < 3) return {};
  ZeroDrift drift;
  std::vector<double> times_s, medians_N, scatter_N;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t begin = k * rows.size() / count, end = (k + 1) * rows.size() / count;
    std::vector<double> forces_N, deviations_N;
    for (std::size_t i = begin; i < end; ++i) forces_N.push_back(rows[i].force_N);
    const double middle_N = median_of(forces_N);
    for (const double force_N : forces_N) deviations_N.push_back(std::abs(force_N - middle_N));
    times_s.push_back(rows[(begin + end) / 2].time_s);
    medians_N.push_back(middle_N);
    // The standard deviation of normal errors is 1.4826 times the median of their sizes, and the standard error of a
    // median 1.2533 times that of a mean.
    scatter_N.push_back(1.2533 * 1.4826 * median_of(deviations_N) / std::sqrt(static_cast<double>(end - begin)));
  }
  drift.standard_error_N = median_of(scatter_N);
  const auto [lowest_N, highest_N] = std::ranges::minmax(medians_N);
  drift.range_N = highest_N - lowest_N;
  const double duration_s = std::max(times_s.back() - times_s.front(), 1e-9);
  // The least squares of a line, and of a line with a step before group `at`.
  double line_only = HUGE_VAL, best = HUGE_VAL;
  for (std::size_t at = 0; at < count; ++at) {
    Eigen::MatrixXd design = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(count), at > 0 ? 3 : 2);
    Eigen::VectorXd force_N(static_cast<Eigen::Index>(count));
    for (std::size_t k = 0; k < count; ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      design(row, 0) = 1.0;
      design(row, 1) = (times_s[k] - times_s.front()) / duration_s;
      if (at > 0 && k >= at) design(row, 2) = 1.0;
      force_N(row) = medians_N[k];
    }
    const Eigen::VectorXd fitted = design.colPivHouseholderQr().solve(force_N);
    const double error = (design * fitted - force_N).squaredNorm();
    if (at == 0) {
      line_only = error;
      drift.line_N = fitted(1);
    } else if (error < best && error < 0.25 * line_only) {
      best = error;
      drift.line_N = fitted(1);
      drift.step_N = fitted(2);
      drift.step_at_s = times_s[at];
    }
  }
  return drift;
}

NoiseFloor noise_floor(const std::vector<const PreparedRecording*>& recordings, const JndLine& jnd) {
  std::vector<double> noise_over_jnd;
  double squares_N2 = 0.0;
  for (const PreparedRecording* prepared : recordings) {
    const std::vector<RecordingRow>& rows = prepared->recording.rows;
    const SurfaceEstimate& surface = prepared->surface;
    const double noise_N = white_force_noise_N(*prepared);
    for (std::size_t i = 0; i < rows.size(); i += rows.size() / kMostSamples + 1) {
      if (!(rows[i].position_m > surface.offset_m)) continue;
      noise_over_jnd.push_back(noise_N / jnd.at(rows[i].force_N - surface.force_zero_N));
      squares_N2 += noise_N * noise_N;
    }
  }
  NoiseFloor floor;
  if (!(squares_N2 > 0.0)) return floor;
  const auto count = static_cast<double>(noise_over_jnd.size());
  floor.force_noise_N = std::sqrt(squares_N2 / count);
  const auto share = [&](double jnds) {
    double inside = 0.0;
    for (const double noise : noise_over_jnd) inside += std::erf(jnds / (std::sqrt(2.0) * std::max(noise, 1e-9)));
    return inside / count;
  };
  floor.within_jnd = share(1.0);
  // Bisection. Its upper end suffices: 99 % of a normal distribution are within 2.576 standard deviations.
  double low = 0.0;
  double high = 2.6 * *std::max_element(noise_over_jnd.begin(), noise_over_jnd.end());
  while (high - low > 1e-3 * high) {
    const double middle = 0.5 * (low + high);
    (share(middle) < 0.99 ? low : high) = middle;
  }
  floor.p99_error_over_jnd = high;
  return floor;
}

}  // namespace palpate
