// Direct interpolation: every site is a centre, smoothed as much as the data
// ask for (decide_strength.h, else choose_smoothing.h), with the side condition of eq. 3.
//
// Cholesky factorises the projected system (projected_kernel.h); sites as_2009 get the paper's truncated SVD
// (truncated_svd.h), which takes some thirty times longer.
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
  // Smoothing; without one the sites' own, and where they have none it is chosen. 0 interpolates, up to the least
  // smoothing at which the matrix can be factorised.
  std::optional<double> smoothing = std::nullopt;
};

// More sites than this would take more than 4 GiB and minutes.
inline constexpr Eigen::Index kMostDirectSites = 20000;

// Errors: those of validate_sites; too many sites; no factorisation;
// interrupted. Deterministic on one machine. Off the tick; O(N^3), N^2 doubles.
Result<FittedRbf> fit_direct(const Sites& sites, const DirectOptions& options, const FitControl& control = {});

}  // namespace palpate
