#include "models/training/motion_source.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "engine/tick/sensor_identification.h"

namespace palpate {
namespace {

// An unloading path below this share of the loading path counts as none.
constexpr double kLeastUnloading = 0.1;

// The material pulls if at least kLeastPulls samples and a share of kPullShare have a force below -JND(0), and the
// lowest force is certain (certain_force_N).
constexpr double kLeastPulls = 10.0;
constexpr double kPullShare = 1e-3;
// A share of the greatest depth: a third of the first piece of the trend's elastic response.
constexpr double kShallow = 0.01;

}  // namespace

Status MotionSource::load(const FitControl& control) {
  if (!recordings_.empty()) return {};
  // By descending length, then by the hash of the content, then by name.
  std::ranges::stable_sort(inputs_, {}, [](const PreparedRecordingPointer& one) {
    const Recording& recording = one->recording;
    return std::tuple(-static_cast<std::ptrdiff_t>(recording.rows.size()), one->content_hash, recording.name);
  });
  rows_ = 0;
  for (const PreparedRecordingPointer& prepared : inputs_) rows_ += prepared->recording.rows.size();
  const std::size_t stride = std::max<std::size_t>(1, (rows_ + most_rows_ - 1) / most_rows_);
  std::vector<OneRecording> loaded;
  for (const PreparedRecordingPointer& prepared : inputs_) {
    const std::vector<RecordingRow>& recorded = prepared->recording.rows;
    OneRecording& one =
        loaded.emplace_back(OneRecording{prepared->recording.name, prepared.get(), prepared->content_hash, {}});
    one.rows.reserve(recorded.size() / stride + 1);
    MotionEstimator estimator(prepared->sensor);
    for (std::size_t i = 0; i < recorded.size(); ++i) {
      if (i % kRowsPerQuestion == 0 && !control.may_continue()) return interrupted();
      MotionRow row;
      row.sample = tool_sample(recorded[i]);
      row.motion = prepared->motion.empty() ? estimator.update(row.sample) : prepared->motion[i];
      row.force_N = recorded[i].force_N;
      if (i % stride == 0) one.rows.push_back(row);
    }
    const SensorSpec sensor{prepared->sensor.encoder_step_m, prepared->sensor.position_noise_m};
    sensor_ = std::max(sensor_, sensor, [](const SensorSpec& a, const SensorSpec& b) {
      return std::tie(a.encoder_step_m, a.position_noise_m) < std::tie(b.encoder_step_m, b.position_noise_m);
    });
    force_noise_N_ = std::max(force_noise_N_, prepared->force_noise_N);
  }
  recordings_ = std::move(loaded);
  return {};
}

Status MotionSource::for_each(const std::function<void(const MotionRow&)>& visit, const FitControl& control) {
  if (Status status = load(control); !status) return status;
  std::size_t seen = 0;
  int stroke = 0;
  std::optional<FoldAssignment> assignment = assignment_;
  for (std::size_t r = 0; r < recordings_.size(); ++r) {
    const RecordingSurface own = surfaces_.empty() ? RecordingSurface{} : surfaces_[r];
    const double offset_m = surface_m_ + own.offset_m;
    bool first = true;
    bool was_in_contact = false;
    std::size_t at = 0;
    for (MotionRow row : recordings_[r].rows) {
      if (seen > 0 && seen % kRowsPerQuestion == 0 && !control.may_continue()) return interrupted();
      ++seen;
      if (own.lag_s != 0.0) {
        const auto force_N = force_at(recordings_[r].rows, row.sample.time_s + own.lag_s, at);
        if (!force_N) continue;
        row.force_N = *force_N;
      }
      row.sample.position_m -= offset_m;
      row.motion.position_m -= offset_m;
      row.force_N -= own.force_zero_N;
      const bool in_contact = row.sample.position_m > 0.0;
      if (in_contact && !was_in_contact) ++stroke;
      was_in_contact = in_contact;
      row.recording = static_cast<int>(r);
      row.first = std::exchange(first, false);
      row.stroke = stroke;
      if (assignment) row.fold = assignment->next(row.recording, stroke, in_contact);
      visit(row);
    }
  }
  return {};
}

FoldAssignment TrainingExtent::folds(std::size_t recordings) const {
  const bool has_unloading = unloading_path_m > kLeastUnloading * loading_path_m;
  return {recordings, contact_samples, has_unloading};
}

Result<TrainingExtent> measure_extent(MotionSource& source, const JndLine& jnd, const FitControl& control) {
  TrainingExtent extent;
  double squares = 0.0;
  MotionRow last;
  double lowest_N = 0.0;
  double pulls = 0.0;
  double start_s = 0.0;
  double duration_s = 0.0;
  double steps = 0.0;
  const Status status = source.for_each(
      [&](const MotionRow& row) {
        if (row.first) start_s = row.sample.time_s;
        if (row.first) last = row;
        const double travel_m = row.motion.position_m - last.motion.position_m;
        duration_s += row.sample.time_s - last.sample.time_s;
        steps += row.first ? 0.0 : 1.0;
        last = row;
        extent.longest_recording_s = std::max(extent.longest_recording_s, row.sample.time_s - start_s);
        if (!(row.sample.position_m > 0.0)) return;
        extent.depth_m = std::max({extent.depth_m, row.motion.position_m, 1e-9});
        extent.force_N = std::max(extent.force_N, row.force_N);
        if (row.force_N < -jnd.at(0.0)) ++pulls;
        lowest_N = std::min(lowest_N, row.force_N);
        squares += row.motion.velocity_m_per_s * row.motion.velocity_m_per_s;
        ++extent.contact_samples;
        extent.strokes = static_cast<std::size_t>(row.stroke);
        (travel_m > 0.0 ? extent.loading_path_m : extent.unloading_path_m) += std::abs(travel_m);
      },
      control);
  if (!status) return status.error();
  const auto count = static_cast<double>(extent.contact_samples);
  const bool pulling = pulls >= std::max(kLeastPulls, kPullShare * count);
  if (pulling && lowest_N < -certain_force_N(source.force_noise_N())) extent.lowest_force_N = lowest_N;
  extent.sample_s = duration_s / std::max(1.0, steps);
  // A tool that never moved still needs a scale: 1 um/s.
  extent.rms_velocity_m_per_s = std::max(1e-6, count > 0.0 ? std::sqrt(squares / count) : 0.0);
  return extent;
}

Result<double> find_preload_surface(MotionSource& source, const TrainingExtent& extent, const JndLine& jnd,
                                    const FitControl& control) {
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;  // sums, of depth x and force y
  const Status status = source.for_each(
      [&](const MotionRow& row) {
        const double depth_m = row.motion.position_m;
        if (!(depth_m > 0.0) || depth_m > kShallow * extent.depth_m) return;
        n += 1.0, x += depth_m, y += row.force_N;
        xx += depth_m * depth_m, xy += depth_m * row.force_N, yy += row.force_N * row.force_N;
      },
      control);
  if (!status) return status.error();
  const double spread = n * xx - x * x;
  if (n < 3.0 || !(spread > 0.0)) return 0.0;
  const double slope = (n * xy - x * y) / spread;
  const double force_N = (y - slope * x) / n;
  const double variance = std::max(0.0, yy - force_N * y - slope * xy) / (n - 2.0);
  const double noticeable_N = std::max(jnd.at(0.0), 2.0 * std::sqrt(variance * xx / spread));
  const bool identified = force_N > noticeable_N && slope > 2.0 * std::sqrt(variance * n / spread);
  const double out_m = force_N / slope;
  return identified && out_m < extent.depth_m ? -out_m : 0.0;
}

}  // namespace palpate
