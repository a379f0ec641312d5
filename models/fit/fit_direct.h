// Direct interpolation: every site is a centre, smoothed as much as the data
// ask for (choose_smoothing.h), with the side condition of eq. 3.
//
// Cholesky factorises the projected system (projected_kernel.h). The paper's
// truncated SVD is the eigendecomposition of the same matrix, which is
// symmetric, cut where generalised cross-validation says:
//   N sum_{k > K} z_k^2 / (N - L - K)^2;
// it takes some thirty times longer and agrees within the noise.
// Source: Hoever & Harders (2009), section 3, eqs. 2-8.
#pragma once

#include <optional>

#include "engine/base/fit_control.h"
#include "engine/base/result.h"
#include "models/fit/methods.h"
#include "models/solve/fit_report.h"
#include "models/training/sites.h"

namespace palpate {

struct DirectOptions {
  KernelKind kernel = KernelKind::cubic;
  DirectSolver solver = DirectSolver::cholesky;
  // Smoothing; without one the sites' own, and where they have none it is chosen. 0 interpolates, up to the least
  // smoothing at which the matrix can be factorised.
  std::optional<double> smoothing = std::nullopt;
  // Choose by leaving out strokes (when the sites know them) or by generalised
  // cross-validation.
  bool by_group = true;
};

// More sites than this would take more than 4 GiB and minutes.
inline constexpr Eigen::Index kMostDirectSites = 20000;

// Errors: those of validate_sites; too many sites; no factorisation;
// interrupted. Deterministic on one machine. Off the tick; O(N^3), N^2 doubles.
Result<FittedRbf> fit_direct(const Sites& sites, const DirectOptions& options, const FitControl& control = {});

}  // namespace palpate
