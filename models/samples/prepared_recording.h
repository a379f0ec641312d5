// A recording with all estimates from it alone, above all its surface and force zero. palpate check reports them, and a
// fit uses them.
//
// Free air is a range at the outer end of the positions where the force during loading does not depend on the position
// ; without it, neither force zero nor surface is identified. Force zero: the mean force there, without
// outliers. Surface: the onset of force in touches of a surface at rest that begin in free air: the first, and those
// after 5 s of air, because a surface that still recovers meets the tool late, by up to a millimetre. During loading,
//   J(d0) = sum_i (f_i - zero - x_i^n (a (1 - k x_i) + b k x_i))^2,
//           x_i = max(0, p_i - d0),  a, b >= 0,  n = 1 or 1.5,  k = n / ((n + 1) 3 mm)
// is minimised over d0: a force law that is convex or concave and rises up to 3 mm.
// Thread guarantee: an immutable value and pure functions, slow side.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "engine/recording/recording.h"
#include "engine/tick/motion_estimator.h"
#include "models/samples/profile_search.h"
#include "models/samples/sample.h"

namespace palpate {

inline constexpr double kRestBeforeTouch_s = 5.0;

struct FreeAir {
  bool found = false;
  double inner_end_m = 0.0;  // free air is certain for positions below
  double zero_N = 0.0;
  double zero_error_N = kUnknownError;  // standard error
  double drift_N = 0.0;       // of the zero: median of the last third of the rows in air minus that of the first
  double tool_mass_kg = 0.0;  // mass carried by the force sensor; 0 if not identified
};

struct SurfaceEstimate {
  FreeAir air;  // if not found, all below is unknown
  // To be subtracted from position_m so that 0 is the surface. `raw_offset_m`: the onset, before the test against 0.
  double offset_m = 0.0;
  double raw_offset_m = 0.0;
  double standard_error_m = kUnknownError;  // infinite if the surface is not identified
  double force_zero_N = 0.0;                // to be subtracted from force_N; 0 if not significant
  // The surface at the last touch at rest minus that at the first; the error is infinite with fewer than two.
  double offset_drift_m = 0.0;
  double offset_drift_error_m = kUnknownError;

  bool identified() const { return std::isfinite(standard_error_m); }
};

// The maximum number of rows from which a surface is estimated, and their largest interval: an approach with fewer rows
// does not identify the onset. A longer recording at 1 kHz contributes its first seven minutes.
inline constexpr std::size_t kOnsetRows = 400000;
inline constexpr double kCoarsestOnset_s = 1.5e-3;

struct PreparedRecording {
  Recording recording;
  std::uint64_t content_hash = 0;  // engine/recording/recording.h
  SensorSpec sensor;
  double force_noise_N = 0.0;  // standard deviation
  std::vector<Sample> rows;    // with their motion; at most kOnsetRows
  SurfaceEstimate surface;
};

using PreparedRecordingPointer = std::shared_ptr<const PreparedRecording>;

// `recording`: at least one row.
PreparedRecordingPointer prepare_recording(Recording recording);

}  // namespace palpate
