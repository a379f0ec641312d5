#include "models/training/surface_rows.h"

#include "engine/tick/sensor_identification.h"

namespace palpate {

std::vector<SurfaceRow> thinned_rows(const Recording& recording, std::size_t most) {
  std::vector<SurfaceRow> rows;
  MotionEstimator estimator(identify_sensor(recording.rows.data(), recording.rows.size(), recording.columns));
  const std::size_t stride = recording.rows.size() / most + 1;
  for (std::size_t i = 0; i < recording.rows.size(); ++i) {
    const ToolSample sample = tool_sample(recording.rows[i]);
    const MotionEstimate motion = estimator.update(sample);
    if (i % stride == 0) rows.push_back({sample, motion, recording.rows[i].force_N});
  }
  return rows;
}

}  // namespace palpate
