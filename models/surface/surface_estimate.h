// What one recording tells by itself of its surface and its force zero.
//
// Evidence first. Free air is a stretch of positions, at the outer end of the tool's way,
// over which the force does not follow the position while the tool goes in: the medians of
// its slices stay within the noise, where the recording's mean stiffness would have
// changed the force by twenty times as much. What follows the acceleration there is the
// inertia of what the force sensor carries (taken off for what follows). Without free air
// the tool may never have left the material, and neither zero nor surface can be told.
//
// Force zero: the median force of that stretch. Surface: the onset of touches of a surface
// at rest that begin in free air, the first of the recording and those after
// kRestBeforeTouch_s of air. (A surface that still recovers from the touch before meets
// the tool late, by up to a millimetre.) While the tool goes in,
//   J(d0) = sum_i (f_i - zero - x_i^n (a (1 - k x_i) + b k x_i))^2,
//           x_i = max(0, p_i - d0),  a, b >= 0,  n = 1 or 1.5
// is minimised over d0 (surface_onset.h). An offset that cannot be told from 0 (two
// standard errors, 0.02 mm) is 0.
// Thread guarantee: slow side, pure.
#pragma once

#include <cmath>
#include <vector>

#include "engine/recording/recording.h"
#include "models/surface/surface_rows.h"

namespace palpate {

inline constexpr double kRestBeforeTouch_s = 5.0;

struct SurfaceEstimate {
  bool free_air = false;   // seen; without it all below is unknown
  double air_end_m = 0.0;  // certainly air further out
  // To be subtracted from position_m so that 0 is the surface; `raw_offset_m`
  // is the minimum itself, before it was compared with its error.
  double offset_m = 0.0;
  double raw_offset_m = 0.0;
  double standard_error_m = 0.0;  // infinite where the surface cannot be told
  double law_error_m = 0.0;       // the part of it that two like touches do not share
  // To be subtracted from force_N.
  double force_zero_N = 0.0;
  double force_zero_error_N = 0.0;  // standard error; infinite without free air
  // Last third of the rows in air minus the first third; 0 without free air.
  double force_zero_drift_N = 0.0;
  double tool_mass_kg = 0.0;  // that the force sensor feels
  // The surface's place at the last touch at rest minus that at the first; its
  // error is infinite with fewer than two such touches.
  double offset_drift_m = 0.0;
  double offset_drift_error_m = 0.0;

  bool told() const { return std::isfinite(standard_error_m); }
};

// `rows`: a whole recording in time order. `force_noise_N`: its standard deviation.
// `lag_error_s`: how well the time of the force is known; a quick touch blurs the surface by
// as much of its way.
SurfaceEstimate estimate_surface(const std::vector<SurfaceRow>& rows, double force_noise_N, double lag_error_s = 0.0);

// The same from a recording in memory.
SurfaceEstimate estimate_surface(const Recording& recording);

}  // namespace palpate
