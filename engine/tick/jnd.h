// One JND is the difference that people notice in three of four trials: JND(F) = offset + weber_fraction |F|. Pure.
// The default is the line of Hoever & Harders (2009), section 4.1, below their measured points: 0.065 N + 6.33 %.
// Pages say it in the words of kJndDefinition (scenes/evaluation/model_errors.h).
#pragma once

#include <cmath>

namespace palpate {

struct JndLine {
  double offset_N = 0.065, weber_fraction = 0.0633;

  double at(double force_N) const noexcept { return offset_N + weber_fraction * std::abs(force_N); }

  // |model - measured| / JND(measured).
  double error_over_jnd(double model_N, double measured_N) const noexcept {
    return std::abs(model_N - measured_N) / at(measured_N);
  }
};

}  // namespace palpate
