// Presses of a tool into a virtual material along a given path, for motions that the simulated hand of the rig does
// not make.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "engine/recording/recording.h"
#include "scenes/material/block.h"

namespace palpate {

// The position of the tool, m, as a function of time, s.
using Path = std::function<double(double time_s)>;

// A minimum-jerk move to `target_m` in `duration_s`.
struct Stretch {
  double target_m = 0.0;
  double duration_s = 0.0;
};

inline constexpr double kInAir_m = -2e-3;

// The path of these moves one after the other, from kInAir_m; then at rest.
Path along(std::vector<Stretch> stretches);
// A press to `depth_m`, a hold of `hold_s`, and a return to kInAir_m, with the peak speed `speed_m_per_s`.
std::vector<Stretch> press_and_hold(double depth_m, double speed_m_per_s, double hold_s);

// Evenly spaced times from 0.
std::vector<double> even_times(double seconds, double rate_Hz);

struct PressSensors {
  double encoder_step_m = 0.0;  // 0: exact positions
  double force_noise_N = 0.005;
  std::uint64_t seed = 1;  // of the noise
};

struct Press {
  Recording recording;         // position and force
  std::vector<double> true_N;  // the material's own force, row by row
};

// Resets `block` and moves the tool along `path`. `times_s`: ascending.
Press press_into(Block& block, const Path& path, const std::vector<double>& times_s, const PressSensors& sensors = {});

}  // namespace palpate
