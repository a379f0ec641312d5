// Direct interpolation: every site is a centre, with the side condition of eq. 3.
//
// The projected system (projected_kernel.h) is solved by a Cholesky factorisation, with the smoothing of the sites. The
// paper inverts the saddle matrix of eq. 4 by truncated singular values, which takes a hundred times as long and has
// the same purpose (models/fit/open_choices.h). Source: Hoever & Harders (2009), section 3, eqs. 2-8.
#pragma once

#include "models/correction/methods.h"
#include "models/correction/solve_weights.h"

namespace palpate {

// The limit of the number of sites; more would take over 4 GiB and minutes.
inline constexpr Eigen::Index kMostDirectSites = 20000;

// With smoothing 0 the function interpolates as closely as the smallest smoothing allows at which the matrix can be
// factorised. Errors: too many sites; no factorisation; interrupted, checked before each step. Deterministic on one
// machine. Slow side; O(N^3), N^2 doubles.
Result<SolvedWeights> fit_direct(const Sites& sites, const FitControl& control = {});

}  // namespace palpate
