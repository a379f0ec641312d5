// Where one recording's surface is, from that recording alone: the position at
// which force begins, and what the force sensor reads in free air.
//
// Force zero: the median force of the rows in free air, more than a margin
// outside of where force begins; 0 where the tool never leaves the surface.
// Surface: the onset of touches of a surface at rest, the first of the recording
// and those after kRestBeforeTouch_s of air. (A surface that still recovers
// from the touch before meets the tool late, by up to a millimetre.) While the
// tool goes in,
//   J(d0) = sum_i (f_i - zero - x_i^n (a (1 - k x_i) + b k x_i))^2,
//           x_i = max(0, p_i - d0),  a, b >= 0,  n = 1 or 1.5
// is minimised over d0, with a and b of every touch (variable projection): a law
// that begins as a flat contact or, n = 1.5, as that of a ball on a soft solid
// (Hertz, 1881), and may bend to either side; k keeps it rising. Where the touch
// does not tell which, the ball is taken, and half of their difference is part of
// the error; so is half of the way to an onset that was not seen. A threshold on force instead would be late by what a soft onset takes
// to reach it.
// An offset that cannot be told from 0 (two standard errors, 0.02 mm) is 0.
// Thread guarantee: slow side, pure.
#pragma once

#include <vector>

#include "engine/recording/recording.h"
#include "models/surface/surface_rows.h"

namespace palpate {

inline constexpr double kRestBeforeTouch_s = 5.0;
// Smaller offsets are not told from 0: no motion estimate from one touch is finer.
inline constexpr double kLeastOffset_m = 0.02e-3;

struct SurfaceEstimate {
  // To be subtracted from position_m so that 0 is the surface; `raw_offset_m`
  // is the minimum itself, before it was compared with its error.
  double offset_m = 0.0;
  double raw_offset_m = 0.0;
  double standard_error_m = 0.0;  // infinite where the surface cannot be told
  bool onset_seen = false;  // else the offset is where force would begin, were it seen
  // To be subtracted from force_N.
  double force_zero_N = 0.0;
  double force_zero_error_N = 0.0;  // standard error; infinite without free air
  // Last third of the rows in air minus the first third; 0 without free air.
  double force_zero_drift_N = 0.0;
  // The surface's place at the last touch at rest minus that at the first; its
  // error is infinite with fewer than two such touches.
  double offset_drift_m = 0.0;
  double offset_drift_error_m = 0.0;
  int touches = 0;              // of a surface at rest
  double free_air_share = 0.0;  // of the rows
};

// `rows`: a whole recording in time order. `force_noise_N`: its standard deviation.
SurfaceEstimate estimate_surface(const std::vector<SurfaceRow>& rows, double force_noise_N);

// The same from a recording in memory, as `palpate check` has it.
SurfaceEstimate estimate_surface(const Recording& recording);

}  // namespace palpate
