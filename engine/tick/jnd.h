// The just noticeable difference (JND) of a force: the error a hand can notice
// at all.
//   JND(F) = offset + weber_fraction |F|
// Source: Hoever & Harders (2009), section 4.1, the conservative line below
// all measured points: 0.065 N + 6.33 %.
// Thread guarantee: pure functions, any thread, wait-free.
#pragma once

#include <cmath>

namespace palpate {

struct JndLine {
  double offset_N = 0.065;
  double weber_fraction = 0.0633;

  double at(double force_N) const noexcept { return offset_N + weber_fraction * std::abs(force_N); }

  // |model - measured| as a multiple of the JND of the measured force; a value
  // of 1 or less cannot be felt.
  double error_over_jnd(double model_N, double measured_N) const noexcept {
    return std::abs(model_N - measured_N) / at(measured_N);
  }
};

}  // namespace palpate
