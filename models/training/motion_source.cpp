#include "models/training/motion_source.h"

#include <algorithm>
#include <tuple>

#include "engine/tick/sensor_identification.h"

namespace palpate {

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
      row.run_up = !prepared->left_out.empty() && prepared->left_out[i];
      if (i % stride == 0) one.rows.push_back(row);
    }
    const SensorSpec& sensor = prepared->sensor;
    std::tie(encoder_step_m_, position_noise_m_) = std::max(std::pair{encoder_step_m_, position_noise_m_},
                                                            std::pair{sensor.encoder_step_m, sensor.position_noise_m});
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
    const RowCorrection correction = corrections_.empty() ? RowCorrection{} : corrections_[r];
    bool first = true;
    bool was_in_contact = false;
    std::size_t at = 0;
    for (MotionRow row : recordings_[r].rows) {
      if (seen > 0 && seen % kRowsPerQuestion == 0 && !control.may_continue()) return interrupted();
      ++seen;
      if (correction.lag_s != 0.0) {
        const auto force_N = force_at(recordings_[r].rows, row.sample.time_s + correction.lag_s, at);
        if (!force_N) continue;
        row.force_N = *force_N;
      }
      row.sample.position_m -= correction.offset_m;
      row.motion.position_m -= correction.offset_m;
      row.force_N -= correction.force_zero_N;
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

}  // namespace palpate
