// How the training recordings lie to each other, and where their common surface is.
//
// Registration is relative: the recording with the longest way stays, every other one is
// moved over the whole overlap of positions until one material explains both best
// (common_fit.h, profile_search.h). What all of them share is the rig's: the
// recording in the middle stays as it is, of two the later one. A recording whose place
// cannot be told stays as recorded. The model's own surface is where the onsets of force
// say, in these positions, either side of 0; without free air it is at 0.
// Where recorded forces reach further out (adhesion, a press that never lets go), it is
// there, so that the model has them. Force zeros are taken off where every recording shows
// free air, otherwise nowhere: one rule for all. So it is with a lag of the force
// (force_lag.h): it is the rig's where half of the recordings tell it, and agree.
// Thread guarantee: slow side.
#pragma once

#include <cmath>
#include <vector>

#include "engine/base/fit_control.h"
#include "engine/base/result.h"
#include "models/training/motion_source.h"

namespace palpate {

struct RegisteredSurface {
  double offset_m = 0.0;          // against the rig's own positions
  double standard_error_m = 0.0;  // infinite where it is not told
  double force_zero_N = 0.0;
  bool told() const { return std::isfinite(standard_error_m); }
};

struct RegisteredSurfaces {
  std::vector<RegisteredSurface> recordings;  // in the order of `source.names()`
  double surface_position_m = 0.0;            // of all, moved by their offsets
  double lag_s = 0.0;                         // of the force, one for the rig; 0: none, or not told
};

// `source` must not be corrected yet. Errors: those of the source; interrupted.
Result<RegisteredSurfaces> register_surfaces(MotionSource& source, const FitControl& control = {},
                                             double fraction = 0.0);

}  // namespace palpate
