// Estimates the lag of the force channel of a recording against its position channel. The memory of a material makes
// the force lead the depth, never lag. A regression with non-negative weights,
//   F(t) ~ c + E(p) + sum_t b_t + eta(p) v,   p, v: position and velocity at t - lag, c: force zero,
// therefore has a larger residual where the force is late. A force that is early looks like viscosity, unless it begins
// before contact. E and the spring of each Maxwell branch b_t are rising splines over the positions, all 0 in air.
// Residuals are divided by the noise plus 3 % of the force, with a Huber loss beyond 3. Lags of -50 to 50 ms are
// searched; a lag that does not improve the fit significantly is 0 (profile_search.h). Thread guarantee: slow side,
// pure.
#pragma once

#include "models/samples/profile_search.h"
#include "models/samples/sample.h"

namespace palpate {

// The required accuracy of a lag, s: a lag with two standard errors above it is not identified; lags that differ by at
// most this agree. Rows that are more than ten times this apart identify no lag.
inline constexpr double kLagAccuracy_s = 0.002;

// `rows`: of a recording, in time order; uses the first 4000 that are at least 5 ms apart. `at` > 0 s: the force is
// late. Not identified with fewer than 100 rows or three strokes, or with rows too far apart.
OffsetEstimate find_force_lag(const std::vector<Sample>& rows, double force_noise_N);

}  // namespace palpate
