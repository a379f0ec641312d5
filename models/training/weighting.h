// How much each sample's error counts in a fit.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "engine/tick/jnd.h"

namespace palpate {

enum class Weighting {
  jnd,       // 1 / JND(f): errors count as a hand feels them (default)
  relative,  // 1 / |f|, the paper's eq. (8), floored where it would explode
  none,      // 1
};

// In commands and model files, in the order of the values.
inline constexpr std::array<const char*, 3> kWeightingNames{"jnd", "relative", "none"};
inline const char* weighting_name(Weighting weighting) { return kWeightingNames[static_cast<std::size_t>(weighting)]; }

// Below this force the paper's 1/|f| is held constant: 50 mN, the step of its
// own reduction, under which it has no distinct samples.
inline constexpr double kRelativeWeightFloor_N = 0.05;

inline double row_scale(Weighting weighting, const JndLine& jnd, double force_N) noexcept {
  switch (weighting) {
    case Weighting::jnd:
      return 1.0 / jnd.at(force_N);
    case Weighting::relative:
      return 1.0 / std::max(std::abs(force_N), kRelativeWeightFloor_N);
    case Weighting::none:
      return 1.0;
  }
  return 1.0;
}

// What an error of `error_over_jnd` leaves of the row's scale: errors that are felt
// anyhow must not bend the fit where it could be right. The weights of a Cauchy
// likelihood (Holland & Welsch 1977), which leave small errors alone.
inline constexpr double kRobustError_jnd = 2.0;

inline double robust_scale(double error_over_jnd) noexcept {
  const double share = error_over_jnd / kRobustError_jnd;
  return 1.0 / std::sqrt(1.0 + share * share);
}

}  // namespace palpate
