// Presses along a given path, for motions that the rig's simulated hand does not make.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/recording/recording.h"

namespace palpate::test {

// A minimum-jerk move to `target_m` in `duration_s`.
struct Stretch {
  double target_m = 0.0;
  double duration_s = 0.0;
};

struct ScriptedPress {
  Recording recording;         // 1 kHz, position and force
  std::vector<double> true_N;  // the material's own force, row by row
};

// Starts at -2 mm in the air. `encoder_step_m` 0: exact positions; otherwise
// positions are whole steps. Force noise: 5 mN.
ScriptedPress scripted_press(const std::string& material, const std::vector<Stretch>& script, double encoder_step_m,
                             std::uint64_t seed);

// A press to `depth_m`, a hold of `hold_s`, and a return to -2 mm, with the peak speed `speed_m_per_s`.
std::vector<Stretch> press_and_hold(double depth_m, double speed_m_per_s, double hold_s);

}  // namespace palpate::test
