// How late the force channel of a recording is against its position channel.
//
// A material's memory lets the force run ahead of the depth, never behind, so a common
// fit (common_fit.h) whose springs, dashpots and branches cannot be negative explains a
// late force worse than one that was moved back; an early one looks like viscosity, until
// force begins before the tool is there. Lags of -50 to 50 ms are searched, and where no
// lag explains it as well, there is none (profile_search.h).
// Thread guarantee: slow side, pure.
#pragma once

#include "models/surface/profile_search.h"
#include "models/surface/surface_rows.h"

namespace palpate {

// A lag that is told worse (two standard errors) is not corrected; lags that agree to this are
// one. Rows ten times as far apart tell none.
inline constexpr double kToldLag_s = 0.002;

// `rows` of a recording in time order. Positive: the force is late, s. Not told where
// rows are too rare for it, or there are fewer than three strokes.
Located find_force_lag(const std::vector<SurfaceRow>& rows, double force_noise_N);

// The rows with the force moved back by `lag_s`; those without any are left out.
std::vector<SurfaceRow> without_lag(const std::vector<SurfaceRow>& rows, double lag_s);

}  // namespace palpate
