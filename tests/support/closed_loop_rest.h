// Shared by the tests of the closed loop: the fitted models, presses, and the
// residual motion when the hand holds still.
#pragma once

#include <memory>
#include <vector>

#include "tests/support/closed_loop.h"
#include "tests/support/fitting.h"

namespace palpate::test {

using ForcePtr = std::shared_ptr<const ForceModel>;

inline constexpr double kOneTick_s = 1e-3;
inline constexpr double kEncoders_m[] = {30e-6, 5e-6};

// One of each method, fitted once per process.
const std::vector<ModelPtr>& silicone_models();
const std::vector<ModelPtr>& stiff_models();

inline const Grip& mass_alone() { return grips().back(); }
inline bool held(const Grip& grip) { return grip.stiffness_N_per_m > 0.0; }

// A force and the approximate depth that it causes.
struct Press {
  double force_N = 0.0;
  double depth_m = 0.0;
};
// Residual motion when the hand holds still, peak to peak.
struct Rest {
  double position_m = 0.0;
  double position_steps = 0.0;  // in encoder steps
  double force_jnd = 0.0;
  double largest_N = 0.0;  // over the whole run

  void keep_worse(const Rest& other) {
    position_m = std::max(position_m, other.position_m);
    position_steps = std::max(position_steps, other.position_steps);
    force_jnd = std::max(force_jnd, other.force_jnd);
    largest_N = std::max(largest_N, other.largest_N);
  }
};

// Presses within 0.3 s, receives a pulse of 1 N for 20 ms at 0.6 s, and holds still.
// Measures the last 0.25 s of `seconds`.
Rest hold(const ForcePtr& model, const LoopSettings& settings, const Press& press, double seconds);

// The worst result over both encoders and all values of Ticking, with one tick of delay.
Rest worst_hold(const ForcePtr& model, const Grip& grip, const Press& press, double seconds = 1.5,
                bool passivity = true);

}  // namespace palpate::test
