#include "models/recordings/prepared_recording.h"

#include <limits>
#include <utility>

#include "engine/recording/recording.h"
#include "engine/tick/sensor_identification.h"
#include "models/recordings/force_lag.h"

namespace palpate {

namespace {

// The offsets of rows in time order.
RecordingOffsets estimate_offsets(const std::vector<SurfaceRow>& rows, double force_noise_N) {
  RecordingOffsets offsets{{}, estimate_surface(rows, force_noise_N)};
  SurfaceEstimate& surface = offsets.surface;
  if (!surface.air.found) return offsets;
  offsets.lag = find_force_lag(rows, force_noise_N);
  const OffsetEstimate& lag = offsets.lag;
  if (lag.not_zero && !lag.identified) {
    surface.standard_error_m = std::numeric_limits<double>::infinity();
    surface.offset_m = 0.0;
  }
  // A lag of the force biases the surface and the force zero.
  if (lag.at != 0.0) surface = estimate_surface(without_lag(rows, lag.at), force_noise_N, lag.standard_error);
  return offsets;
}

}  // namespace

PreparedRecordingPointer prepare_recording(Recording recording) {
  const auto prepared = std::make_shared<PreparedRecording>();
  prepared->recording = std::move(recording);
  const Recording& given = prepared->recording;
  prepared->content_hash = content_hash(given);
  prepared->sensor = identify_sensor(given.rows.data(), given.rows.size(), given.columns);
  prepared->force_noise_N = identify_force_noise_N(given.rows.data(), given.rows.size());
  MotionEstimator estimator(prepared->sensor);
  GrowingStride rows(kOnsetRows, kCoarsestOnset_s);
  const bool keeps_motion = given.rows.size() <= kOnsetRows;
  if (keeps_motion) prepared->motion.reserve(given.rows.size());
  for (const RecordingRow& row : given.rows) {
    const ToolSample sample = tool_sample(row);
    const MotionEstimate motion = estimator.update(sample);
    if (keeps_motion) prepared->motion.push_back(motion);
    rows.add({sample, motion, row.force_N});
  }
  prepared->offsets = estimate_offsets(rows.rows(), prepared->force_noise_N);
  return prepared;
}

}  // namespace palpate
