#include "models/check/check_recording.h"

#include <Eigen/Core>
#include <Eigen/QR>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "engine/base/statistics.h"
#include "engine/tick/motion_estimator.h"
#include "models/linear/lapack.h"

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

bool is_force_noise_known(const PreparedRecording& prepared) {
  constexpr std::size_t kWindowRows = 50;  // and a fifth of the windows, as identify_force_noise_N
  constexpr double kLargestCorrelation = -0.45;
  const std::vector<Sample>& rows = prepared.rows;
  std::vector<std::pair<double, double>> windows;  // sums of squares and of products of neighbours, N^2
  for (std::size_t end = kWindowRows; end <= std::min(rows.size(), kSensorIdentificationRows); end += kWindowRows) {
    double before_N = 0.0;
    auto& [squares_N2, products_N2] = windows.emplace_back();
    for (std::size_t i = end - kWindowRows + 2; i < end; ++i) {
      const double second_N = rows[i].force_N - 2.0 * rows[i - 1].force_N + rows[i - 2].force_N;
      squares_N2 += second_N * second_N;
      products_N2 += second_N * std::exchange(before_N, second_N);
    }
  }
  std::ranges::sort(windows);
  windows.resize((windows.size() + 4) / 5);
  double excess_N2 = 0.0;  // of the products over those of the largest correlation
  for (const auto& [squares_N2, products_N2] : windows) excess_N2 += products_N2 - kLargestCorrelation * squares_N2;
  return !windows.empty() && excess_N2 <= 0.0;
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
    if (!is_force_noise_known(*prepared)) return {.known = false};
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

// The lag of the force channel of a recording behind its position channel. The memory of a material makes the force
// lead the depth, never lag. A regression with non-negative weights,
//   F(t) ~ c + E(p) + sum_t b_t + eta(p) v,   p, v: position and velocity at t - lag, c: force zero,
// therefore has a larger residual where the force is late. A force that is early looks like viscosity, unless it begins
// before contact. E and the spring of each Maxwell branch b_t are rising splines over the positions, all 0 in air.
// Residuals are divided by the noise plus 3 % of the force, with a Huber loss beyond 3.

namespace {

// The steps of the search for a longer lag, on every fourth row: a fifth of a quick stroke.
constexpr double kFarStep_s = 0.04;
constexpr std::size_t kFarStride = 4;
constexpr std::size_t kWindows = 5;
// A longer lag is searched for where it lowers the cost to this share.
constexpr double kFarGain = 0.5;
constexpr double kCoarse_s = 0.005;  // between lags, and at least between rows
constexpr double kFine_s = 0.2e-3;
// The required accuracy: a lag with two standard errors above it is not identified; lags that differ by at most this
// agree. Rows that are more than ten times this apart identify no lag.
constexpr double kAccuracy_s = 0.002;
constexpr int kElastic = 24;
constexpr int kBranch = 6;
constexpr int kViscous = 6;
constexpr std::array kTimes_s{0.03, 0.3, 3.0};
constexpr int kFirstBranch = 2 + kElastic;  // after the constants
constexpr int kFirstViscous = kFirstBranch + kBranch * static_cast<int>(kTimes_s.size());
constexpr int kColumns = kFirstViscous + kViscous;
constexpr double kForceShare = 0.03;
constexpr double kHuberLimit = 3.0;
constexpr int kPasses = 3;
constexpr double kIdleScale = 0.1;

// Integral of a hat: rises from 0 to 1 within one knot to either side.
double rise(double u) {
  u = std::clamp(u, -1.0, 1.0);
  return u < 0.0 ? 0.5 * (u + 1.0) * (u + 1.0) : 1.0 - 0.5 * (1.0 - u) * (1.0 - u);
}

double hat(double u) { return std::max(0.0, 1.0 - std::abs(u)); }

// Position and velocity at any time, by cubic Hermite interpolation between the rows.
class MotionAt {
 public:
  explicit MotionAt(const std::vector<Sample>& rows) : rows_(rows) {}

  MotionEstimate operator()(double time_s) {
    while (at_ + 2 < rows_.size() && rows_[at_ + 1].tool.time_s <= time_s) ++at_;
    const Sample& a = rows_[at_];
    const Sample& b = rows_[at_ + 1];
    const double step_s = b.tool.time_s - a.tool.time_s;
    const double u = std::clamp((time_s - a.tool.time_s) / step_s, 0.0, 1.0);
    const double step_m = b.motion.position_m - a.motion.position_m;
    const double c = step_s * a.motion.velocity_m_per_s - step_m;
    const double d = -step_s * b.motion.velocity_m_per_s + step_m;
    return {a.motion.position_m + u * step_m + u * (1.0 - u) * (c * (1.0 - u) + d * u),
            a.motion.velocity_m_per_s + u * (b.motion.velocity_m_per_s - a.motion.velocity_m_per_s)};
  }

 private:
  const std::vector<Sample>& rows_;
  std::size_t at_ = 0;
};

// The regression of the recording with one lag.
class LagRegression {
 public:
  // `motion`: rows that contain `rows` and those before. `noise_N`: standard deviation of the forces.
  LagRegression(const std::vector<Sample>& motion, const std::vector<Sample>& rows, double noise_N)
      : motion_(motion), rows_(rows), noise_N_(noise_N), block_(blocks_by_path(rows)) {
    std::tie(low_m_, high_m_) = position_range_m(rows);
    const auto force_N = [&](Eigen::Index i) { return rows[static_cast<std::size_t>(i)].force_N; };
    force_N_ = Eigen::VectorXd::NullaryExpr(static_cast<Eigen::Index>(rows.size()), force_N);
    scale_ = 1.0 / (no_force_N(noise_N) + kForceShare * force_N_.array().abs());
  }

  // The cost J of the fit at this lag, by blocks of equal path length.
  BlockCosts costs(double lag_s) const {
    const Design design = design_at(lag_s);
    Eigen::VectorXd scale = scale_;
    Eigen::VectorXd predicted_N;
    for (int pass = 0; pass < kPasses; ++pass) {
      const Eigen::MatrixXd scaled = (scale.asDiagonal() * design).transpose();  // one column a row
      Eigen::MatrixXd gram(kColumns, kColumns);
      gram_of_transpose(scaled, gram);
      gram.triangularView<Eigen::StrictlyUpper>() = gram.transpose();
      predicted_N = design * solve_non_negative(gram, scaled * scale.cwiseProduct(force_N_));
      for (Eigen::Index i = 0; i < scale.size(); ++i) {
        // An idle row counts a hundredth: without any the next fit would be free there.
        const double idle = is_idle(i, predicted_N(i)) ? kIdleScale : 1.0;
        const double size = std::max(std::abs(error(i, predicted_N(i))), 1e-12);
        scale(i) = scale_(i) * idle * std::sqrt(std::min(1.0, kHuberLimit / size));
      }
    }
    BlockCosts costs(kBlocks, 0.0);
    for (Eigen::Index i = 0; i < force_N_.size(); ++i)
      costs[block_[static_cast<std::size_t>(i)]] += huber(error(i, predicted_N(i)), kHuberLimit);
    return costs;
  }

 private:
  using Design = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  Design design_at(double lag_s) const {
    Design design(force_N_.size(), kColumns);
    MotionAt motion_at(motion_);
    std::array<double, kBranch> drive{};
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const MotionEstimate motion = motion_at(rows_[r].tool.time_s - lag_s);
      const double x = (motion.position_m - low_m_) / (high_m_ - low_m_);
      double* row = design.row(static_cast<Eigen::Index>(r)).data();
      row[0] = 1.0;
      row[1] = -1.0;
      for (int k = 0; k < kElastic; ++k) row[2 + k] = rise(x * kElastic - (k + 0.5));
      for (int k = 0; k < kViscous; ++k)
        row[kFirstViscous + k] = motion.velocity_m_per_s * hat(std::clamp(x, 0.0, 1.0) * (kViscous - 1) - k);
      std::array<double, kBranch> rising{};
      for (int k = 0; k < kBranch; ++k) rising[static_cast<std::size_t>(k)] = rise(x * kBranch - (k + 0.5));
      const double step_s = r > 0 ? rows_[r].tool.time_s - rows_[r - 1].tool.time_s : 0.0;
      for (std::size_t t = 0; t < kTimes_s.size(); ++t) {
        const double keep = std::exp(-step_s / kTimes_s[t]);
        const double gain = r > 0 ? kTimes_s[t] * (1.0 - keep) / step_s : 0.0;
        double* state = row + kFirstBranch + kBranch * static_cast<int>(t);
        const double* before = state - kColumns;
        for (std::size_t k = 0; k < kBranch; ++k)
          state[k] = r > 0 ? keep * before[k] + gain * (rising[k] - drive[k]) : 0.0;
      }
      drive = rising;
    }
    return design;
  }

  // Contact is one-sided: where no force is measured the fit may be below 0.
  bool is_idle(Eigen::Index i, double predicted_N) const {
    return predicted_N < 0.0 && std::abs(force_N_(i)) <= no_force_N(noise_N_);
  }

  double error(Eigen::Index i, double predicted_N) const {
    return is_idle(i, predicted_N) ? 0.0 : (force_N_(i) - predicted_N) * scale_(i);
  }

  const std::vector<Sample>&motion_, &rows_;
  double noise_N_;
  std::vector<std::size_t> block_;
  double low_m_ = 0.0, high_m_ = 0.0;
  Eigen::VectorXd force_N_;
  Eigen::VectorXd scale_;  // 1 / N
};

// Strokes at different speeds distinguish a lag from memory; one press does not.
constexpr int kLeastStrokes = 3;

// Counts how often the tool passes the middle of its range inwards.
int strokes_of(const std::vector<Sample>& rows, double middle_m) {
  int strokes = 0;
  for (std::size_t i = 1; i < rows.size(); ++i)
    if (rows[i - 1].motion.position_m <= middle_m && rows[i].motion.position_m > middle_m) ++strokes;
  return strokes;
}

// The lag beyond the near range with the lowest cost, in coarse steps; 0 if none is clearly better than all near ones.
double far_lag_s(const std::vector<Sample>& motion, const std::vector<Sample>& rows, double noise_N) {
  std::vector<Sample> some;
  for (std::size_t i = 0; i < rows.size(); i += kFarStride) some.push_back(rows[i]);
  const LagRegression regression(motion, some, noise_N);
  const auto cost = [&](double lag_s) {
    const BlockCosts costs = regression.costs(lag_s);
    return std::accumulate(costs.begin(), costs.end(), 0.0);
  };
  double near = HUGE_VAL;
  for (const double lag_s : {-kFarStep_s, 0.0, kFarStep_s}) near = std::min(near, cost(lag_s));
  double best = kFarGain * near, best_s = 0.0;
  for (int step = 2; step * kFarStep_s < kMostLag_s + 0.5 * kFarStep_s; ++step) {
    for (const double lag_s : {step * kFarStep_s, -step * kFarStep_s}) {
      const double here = cost(lag_s);
      if (here < best) best = here, best_s = lag_s;
    }
  }
  return best_s;
}

}  // namespace

OffsetEstimate find_force_lag(const std::vector<Sample>& rows, double force_noise_N) {
  std::vector<Sample> motion;
  for (const Sample& row : rows)
    if (motion.empty() || row.tool.time_s >= motion.back().tool.time_s + kCoarse_s) motion.push_back(row);
  if (motion.size() < 100) return {};
  const double step_s =
      (motion.back().tool.time_s - motion.front().tool.time_s) / static_cast<double>(motion.size() - 1);
  if (step_s > 10.0 * kAccuracy_s) return {};
  const auto [low_m, high_m] = position_range_m(motion);
  if (!(high_m > low_m) || strokes_of(motion, 0.5 * (low_m + high_m)) < kLeastStrokes) return {};
  // Of a long recording windows of equal length, so that slow and quick strokes are among them.
  std::vector<Sample> some;
  const std::size_t part = std::max(motion.size(), kSearchRows) / kWindows;
  for (std::size_t i = 0; i < motion.size(); ++i)
    if (i % part < kSearchRows / kWindows) some.push_back(motion[i]);
  const LagRegression regression(motion, some, force_noise_N);
  double low_s = -kNearLag_s, high_s = kNearLag_s;
  const double far_s = far_lag_s(motion, some, force_noise_N);
  if (std::abs(far_s) > kMostLag_s - kFarStep_s) return {far_s, true, kUnknownError, true, far_s};
  (far_s < 0.0 ? low_s : high_s) += far_s < 0.0 ? std::min(0.0, far_s) : far_s;
  OffsetEstimate lag = estimate_offset([&](double lag_s) { return regression.costs(lag_s); },
                                       {low_s, high_s, kCoarse_s, kFine_s, kAccuracy_s, kAccuracy_s});
  // A long lag that the blocks disagree on by more is still one, within a step of the far search.
  if (!lag.identified && far_s != 0.0)
    lag = {std::abs(lag.minimum_at - far_s) <= kFarStep_s ? lag.minimum_at : far_s, true, 0.5 * kFarStep_s, true,
           far_s};
  // Blocks that disagree on a short lag by more than the required accuracy still show that there is one.
  if (!lag.identified && far_s == 0.0 && lag.not_zero)
    lag = {lag.minimum_at, true, kSignificantErrors * kAccuracy_s, true, lag.minimum_at};
  // A force that is read once a row is late by anything up to the interval of the rows, evenly distributed.
  lag.standard_error = std::hypot(lag.standard_error, step_s / std::sqrt(12.0));
  if (std::abs(lag.at) < kSignificantErrors * lag.standard_error) lag.at = 0.0;
  return lag;
}

}  // namespace palpate
