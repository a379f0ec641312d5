// Estimates the surface and the force zero of one recording from it alone.
//
// Free air is a range at the outer end of the positions where the force during loading does not depend on the position:
// the medians of its slices stay within the noise, although a force with the mean stiffness of the recording would not.
// A force there that is proportional to the acceleration is the inertia of the mass carried by the force sensor; it is
// subtracted. Without free air, neither force zero nor surface is identified.
//
// Force zero: the mean force in free air, without outliers. Surface: the onset of force in touches of a surface at rest
// that begin in free air: the first, and those after kRestBeforeTouch_s of air, because a surface that still recovers
// meets the tool late, by up to a millimetre. During loading,
//   J(d0) = sum_i (f_i - zero - x_i^n (a (1 - k x_i) + b k x_i))^2,
//           x_i = max(0, p_i - d0),  a, b >= 0,  n = 1 or 1.5,  k = n / ((n + 1) 3 mm)
// is minimised over d0 (surface_onset.h): a force law that is convex or concave and rises up to 3 mm. Offsets within
// two standard errors or 0.02 mm of 0 are 0.
// Thread guarantee: slow side, pure.
#pragma once

#include <cmath>
#include <vector>

#include "engine/recording/recording.h"
#include "models/samples/free_air.h"

namespace palpate {

inline constexpr double kRestBeforeTouch_s = 5.0;

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

// `rows`: a whole recording in time order. `force_noise_N`: standard deviation.
SurfaceEstimate estimate_surface(const std::vector<Sample>& rows, double force_noise_N);

// The same from a recording in memory.
SurfaceEstimate estimate_surface(const Recording& recording);

}  // namespace palpate
