// The surface offset and force zero of every training recording, jointly.
//
// Each recording's own onset of force (surface_estimate.h) says where its
// surface is; how the recordings lie to each other is told much better by the
// trend that they share:
//   minimise over x >= 0 and offsets d_r:
//     sum_r sum_i s_i^2 (f_i - zero_r - max(0, T(p_i - d_r; x)))^2,  sum_r d_r fixed
// For given offsets the trend is linear in x, for given x the offsets are far
// apart from each other: Gauss-Newton steps on both, the offsets eliminated.
// Consistency says nothing of a shift common to all; the onsets decide it, weighted
// by their errors. Of the shifts within their errors or 0.25 mm, the one that
// leaves most recordings as they are: it changes no force of the model, only where
// its zero lies. One recording: its own onset, likewise, if the tool was out of contact. Where no offset of a set can
// be told from 0 all are 0.
// Standard errors: delete-one-fold jackknife over pieces of the recordings, and a
// share of what the trend cannot follow.
// Source: variable projection, Golub & Pereyra (1973); trend: fit_trend.h.
// Thread guarantee: slow side.
#pragma once

#include <vector>

#include "engine/base/fit_control.h"
#include "engine/base/result.h"
#include "engine/tick/features.h"
#include "models/training/motion_source.h"

namespace palpate {

struct RegisteredSurface {
  double offset_m = 0.0;
  double standard_error_m = 0.0;  // infinite where the surface cannot be told
  double force_zero_N = 0.0;
};

// One for each recording, in the order of `source.names()`. `features`: the
// scene's; they say what the trend is made of. `source` must not be corrected
// yet. Errors: those of the source; interrupted.
Result<std::vector<RegisteredSurface>> register_surfaces(MotionSource& source, const std::vector<FeatureSpec>& features,
                                                         const FitControl& control = {}, double fraction = 0.0);

// The same as corrections of the source.
std::vector<RowCorrection> corrections_of(const std::vector<RegisteredSurface>& surfaces);

}  // namespace palpate
