// A recording with all estimates from it alone. palpate check reports them, and a fit uses them.
// Thread guarantee: an immutable value; prepare_recording is pure, slow side.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "engine/recording/recording.h"
#include "engine/tick/motion_estimator.h"
#include "models/samples/sample.h"
#include "models/samples/surface_estimate.h"

namespace palpate {

// The maximum number of rows from which a surface is estimated, and their largest interval: an approach with fewer rows
// does not identify the onset. A longer recording at 1 kHz contributes its first seven minutes.
inline constexpr std::size_t kOnsetRows = 400000;
inline constexpr double kCoarsestOnset_s = 1.5e-3;

struct PreparedRecording {
  Recording recording;
  std::uint64_t content_hash = 0;  // engine/recording/recording.h
  SensorSpec sensor;
  double force_noise_N = 0.0;          // standard deviation
  std::vector<MotionEstimate> motion;  // of every row; empty for more than kOnsetRows rows
  SurfaceEstimate surface;
};

using PreparedRecordingPointer = std::shared_ptr<const PreparedRecording>;

// `recording`: at least one row.
PreparedRecordingPointer prepare_recording(Recording recording);

}  // namespace palpate
