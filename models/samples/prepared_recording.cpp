#include "models/samples/samples.h"

#include <Eigen/Core>
#include <algorithm>
#include <utility>

#include "engine/base/statistics.h"
#include "engine/tick/motion_estimator.h"
#include "models/linear/lapack.h"

namespace palpate {
namespace {

constexpr std::size_t kSlices = 100;    // of the range of positions
constexpr std::size_t kLeastRows = 10;  // of the stretch

// The mean of the forces within three standard deviations of their median, estimated by the median of the deviations:
// the median of a quantised force is one of its steps, and rows in the material would bias the mean of all.
void set_zero(FreeAir& air, std::vector<double> forces_N, double flat_N) {
  const auto third = static_cast<std::ptrdiff_t>(forces_N.size() / 3);
  air.drift_N =
      median_of({forces_N.end() - third, forces_N.end()}) - median_of({forces_N.begin(), forces_N.begin() + third});
  const double middle_N = median_of(forces_N);
  std::vector<double> deviations_N;
  for (const double force_N : forces_N) deviations_N.push_back(std::abs(force_N - middle_N));
  // The standard deviation of normal errors is 1.4826 times the median of their sizes.
  const double limit_N = std::max(flat_N, 3.0 * 1.4826 * median_of(std::move(deviations_N)));
  std::erase_if(forces_N, [&](double force_N) { return std::abs(force_N - middle_N) > limit_N; });
  const auto count = static_cast<double>(forces_N.size());
  double mean_N = 0.0, squares = 0.0;
  for (const double force_N : forces_N) mean_N += (force_N - middle_N) / count;
  for (const double force_N : forces_N) squares += (force_N - middle_N) * (force_N - middle_N);
  air.zero_N = middle_N + mean_N;
  air.zero_error_N = std::sqrt(squares) / count;
}

// Differences of velocities over 20 ms where no acceleration is measured.
std::vector<double> accelerations_m_per_s2(const std::vector<Sample>& rows) {
  const bool measured =
      std::ranges::any_of(rows, [](const Sample& row) { return row.tool.acceleration_m_per_s2 != 0.0; });
  std::vector<double> result(rows.size(), 0.0);
  std::size_t from = 0, to = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (measured) {
      result[i] = rows[i].tool.acceleration_m_per_s2;
      continue;
    }
    while (to + 1 < rows.size() && rows[to].tool.time_s < rows[i].tool.time_s + 0.01) ++to;
    while (rows[from].tool.time_s < rows[i].tool.time_s - 0.01) ++from;
    const double step_s = rows[to].tool.time_s - rows[from].tool.time_s;
    if (step_s > 0.0) result[i] = (rows[to].motion.velocity_m_per_s - rows[from].motion.velocity_m_per_s) / step_s;
  }
  return result;
}

// The mass that the force sensor carries, by a regression of the force on the acceleration in the outermost tenth of
// the positions; 0 if the slope is not significant.
double tool_mass_kg(const std::vector<Sample>& rows, const std::vector<double>& acceleration_m_per_s2) {
  const auto [low_m, high_m] = position_range_m(rows);
  double count = 0.0, a = 0.0, f = 0.0, aa = 0.0, af = 0.0, ff = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].motion.position_m - low_m >= 0.1 * (high_m - low_m)) continue;
    const double x = acceleration_m_per_s2[i], y = rows[i].force_N;
    count += 1.0, a += x, f += y;
    aa += x * x, af += x * y, ff += y * y;
  }
  if (count < 3.0 * kLeastRows) return 0.0;
  const double xx = aa - a * a / count, xy = af - a * f / count, yy = ff - f * f / count;
  if (!(xx > 0.0)) return 0.0;
  const double mass_kg = xy / xx;
  const double error_kg = std::sqrt(std::max(0.0, yy - mass_kg * xy) / xx / count);
  const bool follows = xy * mass_kg > 0.5 * yy;
  return follows && mass_kg > std::max(1e-3, 5.0 * error_kg) ? mass_kg : 0.0;
}

// The outermost slices of the positions whose force is flat during loading.
FreeAir find_air(const std::vector<Sample>& rows, double noise_N) {
  FreeAir air;
  const auto [low_m, high_m] = position_range_m(rows);
  if (!(high_m > low_m)) return air;
  const auto [weakest, strongest] = std::ranges::minmax(rows, {}, &Sample::force_N);
  const double range_N = strongest.force_N - weakest.force_N;
  // The medians of the slices stay within this, because sensors drift and encoders are coarse.
  const double flat_N = std::max({3.0 * noise_N, 0.003 * range_N, 2e-3});
  std::vector<std::vector<double>> slices_N(kSlices);
  for (const Sample& row : rows) {
    if (!(row.motion.velocity_m_per_s >= 0.0)) continue;
    const double share = (row.motion.position_m - low_m) / (high_m - low_m);
    slices_N[std::min(kSlices - 1, static_cast<std::size_t>(share * kSlices))].push_back(row.force_N);
  }
  double lowest_N = HUGE_VAL, highest_N = -HUGE_VAL;
  std::size_t end = 0;
  for (; end < kSlices; ++end) {
    if (slices_N[end].empty()) continue;
    // The median of a few rows is noisy itself.
    const double margin_N = 4.0 * noise_N / std::sqrt(static_cast<double>(slices_N[end].size()));
    const double middle_N = median_of(std::move(slices_N[end]));
    lowest_N = std::min(lowest_N, middle_N + margin_N);
    highest_N = std::max(highest_N, middle_N - margin_N);
    if (highest_N - lowest_N > flat_N) break;
  }
  const double span_m = static_cast<double>(end) / kSlices * (high_m - low_m);
  const double stiffness_N_per_m = range_N / std::max(high_m - low_m - span_m, 1e-9);
  // Materials begin ten times softer than they end.
  const bool evident = end >= 2 && end < kSlices && stiffness_N_per_m * span_m > 20.0 * flat_N;
  if (!evident) return air;
  // If the force begins softly, the inner half may be in the material already.
  air.inner_end_m = low_m + 0.5 * span_m;
  std::vector<double> forces_N;
  for (const Sample& row : rows)
    if (row.motion.position_m < air.inner_end_m && row.motion.velocity_m_per_s >= 0.0) forces_N.push_back(row.force_N);
  air.found = forces_N.size() >= kLeastRows;
  if (air.found) set_zero(air, std::move(forces_N), flat_N);
  return air;
}

constexpr double kTouchOut_m = 1e-3;  // a touch begins so far outside of its first force
constexpr double kCoarseStep_m = 0.05e-3;
constexpr Eigen::Index kTerms = 2;
// The exponent of the force law: a flat or rough contact, or a sphere on a soft solid (Hertz, 1881).
constexpr double kLinear = 1.0, kBall = 1.5;
// A difference of chi^2 above this, two standard errors, selects an exponent. Below it, half the difference of the two
// onsets adds to the standard error.
constexpr double kClearDrop = kSignificantErrors * kSignificantErrors;
// Force begins with this many consecutive rows above the threshold.
constexpr std::size_t kForceRun = 3;

// One touch: the rows [begin, end) of its loading.
struct Touch {
  std::size_t begin = 0, end = 0;
  double first_force_m = 0.0;  // position where the force leaves the noise: too deep if the onset is soft

  std::size_t stride() const { return (end - begin) / 300 + 1; }
};

struct Onset {
  double at_m = 0.0;
  double standard_error_m = 0.0;  // infinite if J has no minimum
  double misfit_m = 0.0;          // additional error if the force follows neither law
};

// The squared error of a touch, N^2, with the best coefficients a and b. A slow touch is thinned to some 300 rows.
double touch_cost(const std::vector<Sample>& rows, const Touch& touch, double zero_N, double exponent,
                  double offset_m) {
  Eigen::Matrix<double, kTerms, kTerms> gram = Eigen::Matrix<double, kTerms, kTerms>::Zero();
  Eigen::Matrix<double, kTerms, 1> right_side = Eigen::Matrix<double, kTerms, 1>::Zero();
  double squares = 0.0;
  const double bend = exponent / ((exponent + 1.0) * 3.0);  // the slope is 0 at 3 mm
  for (std::size_t i = touch.begin; i < touch.end; i += touch.stride()) {
    const double force_N = rows[i].force_N - zero_N;
    squares += force_N * force_N;
    const double x = (rows[i].motion.position_m - offset_m) / 1e-3;  // mm: columns of similar size
    if (!(x > 0.0)) continue;
    const double power = exponent == kLinear ? x : x * std::sqrt(x);
    const Eigen::Matrix<double, kTerms, 1> term(power * (1.0 - bend * x), power * bend * x);
    gram += term * term.transpose();
    right_side += term * force_N;
  }
  const Eigen::VectorXd best = solve_non_negative(gram, right_side);
  return squares - 2.0 * right_side.dot(best) + best.dot(gram * best);
}

// A retreat slower than 2 mm/s is jitter of an approach.
bool approaches(const Sample& row) { return row.motion.velocity_m_per_s > -2e-3; }

struct FormOnset {
  double at_m = 0.0;
  double cost = 0.0;       // N^2
  double curvature = 0.0;  // N^2/m^2
  double degrees_of_freedom = 1.0;
};

// The common onset of at least one touch with this exponent.
FormOnset onset_of_form(const std::vector<Sample>& rows, const std::vector<Touch>& touches, double zero_N,
                        double exponent) {
  // J(d0), N^2.
  const auto cost_at = [&](double offset_m) {
    double cost = 0.0;
    for (const Touch& touch : touches) cost += touch_cost(rows, touch, zero_N, exponent, offset_m);
    return cost;
  };
  double count = -1.0;  // one degree of freedom less for the onset
  for (const Touch& touch : touches)
    count += static_cast<double>((touch.end - touch.begin - 1) / touch.stride() + 1) - static_cast<double>(kTerms);
  const double first_force_m = touches.front().first_force_m;
  FormOnset onset{first_force_m, kUnknownError, 0.0, std::max(1.0, count)};
  const auto scan = [&](double from_m, double to_m, double step_m) {
    for (double at_m = from_m; at_m < to_m + 0.5 * step_m; at_m += step_m) {
      const double value = cost_at(at_m);
      if (value >= onset.cost) continue;
      onset.cost = value;
      onset.at_m = at_m;
    }
  };
  // The first force comes late where the onset is soft.
  scan(first_force_m - kTouchOut_m, first_force_m + 0.3e-3, kCoarseStep_m);
  for (double step_m = kCoarseStep_m; step_m > kFinest_m;) {
    const double around_m = onset.at_m;
    step_m *= 0.25;
    scan(around_m - 4.0 * step_m, around_m + 4.0 * step_m, step_m);
  }
  onset.curvature = (cost_at(onset.at_m - kLeastOffset_m) + cost_at(onset.at_m + kLeastOffset_m) - 2.0 * onset.cost) /
                    (kLeastOffset_m * kLeastOffset_m);
  return onset;
}

// The touches of a surface at rest that begin in free air, which is certain for positions below `air_end_m`.
// `threshold_N`: force above the noise that counts as contact.
std::vector<Touch> touches_at_rest(const std::vector<Sample>& rows, double zero_N, double threshold_N,
                                   double air_end_m) {
  std::vector<Touch> touches;
  bool in_air = false;
  bool rested = true;  // the first touch counts as one at rest
  double left_s = 0.0;
  std::size_t run = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double time_s = rows[i].tool.time_s;
    in_air = in_air || rows[i].motion.position_m < air_end_m;
    if (!(rows[i].force_N - zero_N > threshold_N)) {
      run = 0;
      const bool out = touches.empty() || rows[i].motion.position_m < touches.front().first_force_m;
      if (out && time_s - left_s >= kRestBeforeTouch_s) rested = true;
      continue;
    }
    left_s = time_s;
    if (++run != kForceRun || !rested) continue;
    rested = false;
    const std::size_t first = i + 1 - kForceRun;
    const double first_m = rows[first].motion.position_m;
    const auto position_m = [&](std::size_t row) { return rows[row].motion.position_m; };
    Touch touch{first, first, first_m};
    while (touch.begin > 0 && position_m(touch.begin - 1) > first_m - kTouchOut_m && approaches(rows[touch.begin - 1]))
      --touch.begin;
    while (touch.end < rows.size() && position_m(touch.end) < first_m + 2e-3 && approaches(rows[touch.end]))
      ++touch.end;
    // An approach of half a millimetre without force begins in free air.
    const bool from_air = in_air || first_m - position_m(touch.begin) >= 0.5 * kTouchOut_m;
    if (from_air && touch.end >= first + kForceRun + 1) touches.push_back(touch);
    in_air = false;
  }
  return touches;
}

// The common onset of at least one touch; the coefficients a and b of each touch are its own.
Onset find_onset(const std::vector<Sample>& rows, const std::vector<Touch>& touches, double zero_N,
                 double force_noise_N) {
  const FormOnset linear = onset_of_form(rows, touches, zero_N, kLinear);
  const FormOnset ball = onset_of_form(rows, touches, zero_N, kBall);
  const double variance =
      std::max(std::min(linear.cost, ball.cost) / linear.degrees_of_freedom, force_noise_N * force_noise_N);
  const double drop = (ball.cost - linear.cost) / std::max(variance, 1e-18);
  const FormOnset& chosen = drop > kClearDrop ? linear : ball;
  Onset onset{chosen.at_m, kUnknownError};
  if (chosen.curvature > 0.0) {
    // J rises by noise^2 within one standard error.
    onset.standard_error_m = std::max(2.0 * kFinest_m, std::sqrt(2.0 * variance / chosen.curvature));
    const bool clear = drop > kClearDrop || drop < -kClearDrop;
    if (!clear) onset.standard_error_m = std::hypot(onset.standard_error_m, 0.5 * (linear.at_m - ball.at_m));
    // Neither law fits, so that the onset between free air and the first force is uncertain.
    if (std::sqrt(variance) > kSignificantErrors * force_noise_N)
      onset.misfit_m = std::abs(onset.at_m - touches.front().first_force_m);
  }
  return onset;
}

void estimate_drift(SurfaceEstimate& estimate, const std::vector<Sample>& rows, const std::vector<Touch>& touches,
                    double zero_N, double force_noise_N) {
  if (touches.size() < 2) return;
  const Onset first = find_onset(rows, {touches.front()}, zero_N, force_noise_N);
  const Onset last = find_onset(rows, {touches.back()}, zero_N, force_noise_N);
  estimate.offset_drift_error_m =
      std::hypot(std::hypot(first.standard_error_m, last.standard_error_m), std::hypot(first.misfit_m, last.misfit_m));
  const double drift_m = last.at_m - first.at_m;
  if (std::abs(drift_m) > kSignificantErrors * estimate.offset_drift_error_m) estimate.offset_drift_m = drift_m;
}

// `recorded`: rows of a recording, in time order.
SurfaceEstimate estimate_surface(const std::vector<Sample>& recorded, double force_noise_N) {
  SurfaceEstimate estimate;
  if (recorded.size() < kLeastRows) return estimate;
  FreeAir& air = estimate.air = find_air(recorded, force_noise_N);
  // The inertia of the tool may hide the free air.
  std::vector<Sample> still;
  const std::vector<double> acceleration_m_per_s2 = accelerations_m_per_s2(recorded);
  if (const double mass_kg = tool_mass_kg(recorded, acceleration_m_per_s2); mass_kg > 0.0) {
    still = recorded;
    for (std::size_t i = 0; i < still.size(); ++i) still[i].force_N -= mass_kg * acceleration_m_per_s2[i];
    FreeAir without = find_air(still, force_noise_N);
    without.tool_mass_kg = mass_kg;
    if (without.found && (!air.found || without.inner_end_m >= air.inner_end_m)) air = without;
  }
  if (!air.found) return estimate;
  const std::vector<Sample>& rows = air.tool_mass_kg > 0.0 ? still : recorded;
  // A force zero that drifts by more than its size is not identified.
  const double least_N = std::max({1e-3, kSignificantErrors * air.zero_error_N, std::abs(air.drift_N)});
  if (std::abs(air.zero_N) >= least_N) estimate.force_zero_N = air.zero_N;
  const double threshold_N = std::max(0.02, 5.0 * force_noise_N);
  const auto touches = touches_at_rest(rows, air.zero_N, threshold_N, air.inner_end_m);
  if (touches.empty()) return estimate;
  Onset onset = find_onset(rows, touches, air.zero_N, force_noise_N);
  onset.standard_error_m = std::hypot(onset.standard_error_m, onset.misfit_m);
  if (kSignificantErrors * onset.standard_error_m > kWidestSurface_m) return estimate;
  estimate.raw_offset_m = onset.at_m;
  estimate.standard_error_m = onset.standard_error_m;
  const bool significant = std::abs(onset.at_m) > std::max(kLeastOffset_m, kSignificantErrors * onset.standard_error_m);
  if (significant) estimate.offset_m = onset.at_m;
  estimate_drift(estimate, rows, touches, air.zero_N, force_noise_N);
  return estimate;
}

// Prepares a recording block by block.
class Preparation {
 public:
  // `block`: without faults.
  void add(Recording block) {
    if (block.rows.empty()) return;
    if (!estimator_) {
      made_->sensor = identify_sensor(block.rows.data(), block.rows.size(), block.columns);
      made_->force_noise_N = identify_force_noise_N(block.rows.data(), block.rows.size());
      estimator_.emplace(made_->sensor);
    }
    made_->content_hash = content_hash(block, made_->content_hash);
    std::size_t count = kept_.size();
    if (count == 0)
      made_->recording = std::move(block);
    else
      kept_.insert(kept_.end(), block.rows.begin(), block.rows.end());
    for (std::size_t i = count; i < kept_.size(); ++i) {
      const MotionEstimate motion = estimator_->update(tool_sample(kept_[i]));
      if (made_->recorded_rows++ % made_->stride != 0) continue;
      kept_[count++] = kept_[i];
      made_->motion.push_back(motion);
    }
    kept_.resize(count);
    while (kept_.size() > kMostKeptRows) {
      if (made_->stride == 1) keep_onset();
      keep_every_second(kept_);
      keep_every_second(made_->motion);
      made_->stride *= 2;
    }
  }

  PreparedRecordingPointer finish() {
    if (made_->stride == 1) keep_onset();
    made_->surface = estimate_surface(made_->rows, made_->force_noise_N);
    return std::move(made_);
  }

 private:
  static void keep_every_second(auto& values) {
    for (std::size_t i = 0; 2 * i < values.size(); ++i) values[i] = values[2 * i];
    values.resize((values.size() + 1) / 2);
  }

  // A long recording is thinned as far as the onset allows, and then cut.
  void keep_onset() {
    const std::size_t count = kept_.size();
    const double step_s = (kept_.back().time_s - kept_.front().time_s) / static_cast<double>(count);
    const auto coarsest = static_cast<std::size_t>(kCoarsestOnset_s / std::max(step_s, 1e-6));
    const std::size_t stride = std::max<std::size_t>(1, std::min((count + kOnsetRows - 1) / kOnsetRows, coarsest));
    made_->rows.reserve(std::min(count / stride + 1, kOnsetRows));
    for (std::size_t i = 0; i < count && made_->rows.size() < kOnsetRows; i += stride)
      made_->rows.push_back({tool_sample(kept_[i]), made_->motion[i], kept_[i].force_N});
  }

  std::shared_ptr<PreparedRecording> made_ = std::make_shared<PreparedRecording>();
  std::vector<RecordingRow>& kept_ = made_->recording.rows;
  std::optional<MotionEstimator> estimator_;
};

}  // namespace

PreparedRecordingPointer prepare_recording(Recording recording) {
  Preparation preparation;
  preparation.add(std::move(recording));
  return preparation.finish();
}

Result<PreparedRecordingPointer> read_prepared_recording(const std::string& path, RecordingFaults& faults) {
  constexpr std::size_t kRowsOfABlock = 1000000;  // 40 MB
  Preparation preparation;
  const Status read = read_recording_blocks(path, kRowsOfABlock, [&](Recording block) {
    faults = remove_faults(block, faults);
    preparation.add(std::move(block));
  });
  return read ? Result(preparation.finish()) : read.error();
}

std::size_t first_test_row(const Recording& recording) {
  const auto begin = recording.rows.begin();
  const auto count = static_cast<std::ptrdiff_t>(recording.rows.size());
  const auto cut = std::ranges::min_element(begin + count * 6 / 10, begin + count * 8 / 10, {},
                                            [](const RecordingRow& row) { return std::abs(row.force_N); });
  return static_cast<std::size_t>(cut - begin);
}

}  // namespace palpate
