// The weight of an error in a fit.
// Thread guarantee: pure functions.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/tick/jnd.h"

namespace palpate {

// The factor of a residual.
enum class Weighting {
  jnd,       // 1 / JND(f), errors relative to perception (default)
  relative,  // 1 / max(|f|, kReductionForce_N), eq. (8) of the paper
  none,      // 1
};

// Names in commands and model files, in the order of the values.
inline constexpr std::array<const char*, 3> kWeightingNames{"jnd", "relative", "none"};

// The step of the paper's reduction (models/correction/thinning.h), below which it separates no forces: 1 / |f| is
// constant there.
inline constexpr double kReductionForce_N = 0.05;

inline double row_scale(Weighting weighting, const JndLine& jnd, double force_N) noexcept {
  if (weighting == Weighting::none) return 1.0;
  return 1.0 / (weighting == Weighting::jnd ? jnd.at(force_N) : std::max(std::abs(force_N), kReductionForce_N));
}

// The factor robust_scale is the square root of the weight of a Cauchy likelihood (Holland & Welsch 1977): 1 for small
// errors, less for errors well above the JND, which would otherwise bend the fit elsewhere.
inline constexpr double kRobustError_jnd = 2.0;

inline double robust_scale(double error_over_jnd) noexcept {
  const double share = error_over_jnd / kRobustError_jnd;
  return 1.0 / std::sqrt(1.0 + share * share);
}

}  // namespace palpate
