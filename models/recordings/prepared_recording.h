// A recording with all estimates from it alone. palpate check reports them; registration and fit use them.
// Thread guarantee: an immutable value; prepare_recording is pure, slow side.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "engine/recording/recording.h"
#include "engine/tick/motion_estimator.h"
#include "models/recordings/profile_search.h"
#include "models/recordings/surface_estimate.h"
#include "models/recordings/surface_rows.h"

namespace palpate {

// The maximum number of rows from which a surface is estimated, and their largest interval: an approach with fewer rows
// does not identify the onset. A longer recording at 1 kHz contributes its first seven minutes.
inline constexpr std::size_t kOnsetRows = 400000;
inline constexpr double kCoarsestOnset_s = 1.5e-3;

// The lag of the force, in s, and the surface after this lag was removed. A lag is searched only where there is free
// air, because without an onset it cannot be distinguished from the material's memory. If the lag differs from 0 but
// is not identified, the surface is not identified either.
struct RecordingOffsets {
  OffsetEstimate lag;
  SurfaceEstimate surface;
};

struct PreparedRecording {
  Recording recording;
  std::uint64_t content_hash = 0;  // engine/recording/recording.h
  SensorSpec sensor;
  double force_noise_N = 0.0;          // standard deviation
  std::vector<MotionEstimate> motion;  // of every row; empty for more than kOnsetRows rows
  RecordingOffsets offsets;
};

using PreparedRecordingPointer = std::shared_ptr<const PreparedRecording>;

// `recording`: at least one row.
PreparedRecordingPointer prepare_recording(Recording recording);

}  // namespace palpate
