// Presses into a material whose force is a closed form, for hard_cases.h: a
// stiffening spring, a damper and one Maxwell branch,
//   f = max(0, 300 d + 2e4 d^2 + 2 v + z),  dz/dt = 100 dd/dt - z / 0.17 s,
// d depth in metres, v velocity. About 2.5 N at 6 mm.
// Thread guarantee: pure functions.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "engine/recording/recording.h"
#include "scenes/material/block.h"

namespace palpate {

// Position at a time, in metres and seconds.
using Path = std::function<double(double time_s)>;

struct Press {
  Recording recording;
  std::vector<double> true_N;  // row by row, without noise
};

struct PressSensors {
  double force_noise_N = 0.005;
  double encoder_step_m = 0.0;  // 0: exact
};

// `times_s` ascending. The material moves in steps of 50 us between them.
Press press_along(const Path& path, const std::vector<double>& times_s, const PressSensors& sensors = {});

// The same into a virtual material, without noise.
Press press_into(Block& block, const Path& path, const std::vector<double>& times_s);

inline constexpr double kTrainingSeconds = 5.0;
inline constexpr double kTrainingRate_Hz = 125.0;
inline constexpr double kEvaluatedSeconds = 4.0;
inline constexpr double kEvaluatedRate_Hz = 1000.0;

// A training press without faults.
Press clean_training();

// offset + factor times the path.
Path scaled(const Path& path, double factor, double offset_m);

// Evenly spaced times from 0.
std::vector<double> even_times(double seconds, double rate_Hz);

// Strokes of several depths (to 6 mm) and speeds with pauses between and on
// the way. `variant` changes their order and speed, not their range.
Path training_path(int variant);

}  // namespace palpate
