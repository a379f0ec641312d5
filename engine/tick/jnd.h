// The just noticeable difference (JND) of a force: the smallest error that a hand can perceive. Pure.
//   JND(F) = offset + weber_fraction |F|
// Source: Hoever & Harders (2009), section 4.1, the conservative line below all measured points: 0.065 N + 6.33 %.
#pragma once

#include <cmath>

namespace palpate {

struct JndLine {
  double offset_N = 0.065, weber_fraction = 0.0633;

  double at(double force_N) const noexcept { return offset_N + weber_fraction * std::abs(force_N); }

  // |model - measured| / JND(measured); an error of 1 or less cannot be perceived.
  double error_over_jnd(double model_N, double measured_N) const noexcept {
    return std::abs(model_N - measured_N) / at(measured_N);
  }
};

}  // namespace palpate
