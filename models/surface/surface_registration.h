// Estimates the offsets of the training recordings to each other, and their common surface.
//
// The reference is the recording with the largest range of positions, among those with an identified surface if there
// are any. The offset of every other recording to it is the difference of their surfaces if both are identified
// (models/recordings/surface_estimate.h), otherwise the shift between their forces (models/recordings/force_curve.h).
// An offset that all have in common belongs to the rig and is kept: the median of the offsets counts as 0, because the
// next recording is as likely on one side of it as on the other. Offsets within 0.25 mm or two standard errors of
// those in the middle count as equal to it. A recording whose offset is not identified stays as recorded.
//
// The surface of the model is the weighted mean of the onsets of force in these positions, on either side of 0. It is 0
// without free air, or if it is within 0.25 mm or two standard errors of 0. If measured forces reach further out
// (adhesion, a press that never leaves the material), the surface is there, so that the model includes them. Force
// zeros are subtracted from all recordings if every one has free air, otherwise from none. A lag of the force
// (force_lag.h) is used if at least half of the recordings identify one and these agree.
// Thread guarantee: slow side.
#pragma once

#include <vector>

#include "engine/base/fit_control.h"
#include "engine/base/result.h"
#include "engine/tick/jnd.h"
#include "models/model/fitted_model.h"
#include "models/training/motion_source.h"

namespace palpate {

struct RegisteredSurfaces {
  std::vector<RecordingSurface> recordings;  // in the order of `source.recordings()`; all have the same lag
  double surface_position_m = 0.0;           // in positions corrected by the offsets
  double unmoved_surface_position_m = 0.0;   // the same without the offsets
};

// `source` must have no corrections. Errors: those of the source; interrupted.
Result<RegisteredSurfaces> register_surfaces(MotionSource& source, const JndLine& jnd, const FitControl& control = {});

}  // namespace palpate
