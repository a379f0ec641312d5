// Trials of hard cases: a press along a path, for motions that the simulated hand of the rig does not make, and a hand
// in closed loop with the live tick.
// Thread guarantee: pure functions, slow side.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "engine/recording/recording.h"
#include "scenes/hard/closed_loop.h"
#include "scenes/hard/hard_case.h"
#include "scenes/material/material.h"

namespace palpate {

// The position of the tool, m, as a function of time, s.
using Path = std::function<double(double time_s)>;

inline constexpr double kInAir_m = -2e-3;

// Strokes of several depths and speeds from the air, with pauses between and on the way. `variant` changes their order
// and speed, not their range.
inline constexpr double kTrainingDepth_m = 6e-3;
Path training_path(int variant);
Path scaled(const Path& path, double factor, double offset_m);

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

// The fits to one recording, with automatically selected features.
std::shared_ptr<HardTraining> train_on(Recording recording);
// Replays a press through the tick and compares it with the true force. Energy counts if the press begins in the air.
HardFigures measure_press(const Press& press, const std::shared_ptr<const FittedModel>& model);

// Runs a hand in closed loop with this model. The true force is that of `block` along the path that the tool takes.
struct HandTrial {
  ClosedLoopSettings settings;
  double exchange_s = 0.0;  // above 0: exchanges the model with `other` that often
  double depth_m = 0.0;     // the aim of the press
  double force_N = 0.0;     // approximately there
  std::shared_ptr<const FittedModel> other{};
};
// Presses within 0.3 s, receives a pulse of 1 N at 0.6 s, holds still until 1.5 s, and returns to the air; a free mass
// is pushed with the force and let go at 1.5 s. Energy: given out while the hand holds still, or over the whole run if
// that is more.
HardFigures measure_hand(const HandTrial& trial, Block& block, const std::shared_ptr<const FittedModel>& model);

}  // namespace palpate
