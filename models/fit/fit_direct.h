// Direct interpolation: every site is a centre, with the side condition of eq. 3. The smoothing is selected by
// cross-validation (model_validation.h), otherwise by maximum likelihood (projected_kernel.h).
//
// The projected system (projected_kernel.h) is solved by a Cholesky factorisation; with Sites::as_2009, by the paper's
// truncated SVD (truncated_svd.h), which takes some thirty times longer.
// Source: Hoever & Harders (2009), section 3, eqs. 2-8.
#pragma once

#include <optional>

#include "models/fit/methods.h"

namespace palpate {

// The limit of the number of sites; more would take over 4 GiB and minutes.
inline constexpr Eigen::Index kMostDirectSites = 20000;

// `smoothing`: default as above; 0 interpolates, with the smallest smoothing at which the matrix can be factorised.
// Errors: too many sites; no factorisation; interrupted. Deterministic on one machine. Slow side; O(N^3), N^2 doubles.
Result<FittedRbf> fit_direct(const Sites& sites, KernelKind kernel = KernelKind::cubic,
                             std::optional<double> smoothing = {}, const FitControl& control = {});

}  // namespace palpate
