#include "models/samples/prepared_recording.h"

#include <utility>

#include "engine/recording/recording.h"
#include "engine/tick/sensor_identification.h"

namespace palpate {

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
  prepared->surface = estimate_surface(rows.rows(), prepared->force_noise_N);
  return prepared;
}

}  // namespace palpate
