// Trials of hard cases: a press along a path, and a hand in closed loop with the live tick.
// Thread guarantee: pure functions, slow side.
#pragma once

#include <memory>

#include "scenes/hard/closed_loop.h"
#include "scenes/hard/hard_case.h"
#include "scenes/hard/press.h"

namespace palpate {

// Strokes of several depths and speeds from the air, with pauses between and on the way. `variant` changes their order
// and speed, not their range.
inline constexpr double kTrainingDepth_m = 6e-3;
Path training_path(int variant);
// offset + factor times the path.
Path scaled(const Path& path, double factor, double offset_m);

// Replays a press through the tick and compares it with the true force. Energy counts if the press begins in the air.
HardFigures measure_press(const Press& press, const std::shared_ptr<const FittedModel>& model);

// Runs a hand in closed loop with this model. The true force is that of `block` along the path that the tool takes.
struct HandTrial {
  LoopSettings settings;
  double depth_m = 0.0;     // the aim of the press
  double force_N = 0.0;     // approximately there
  double exchange_s = 0.0;  // above 0: exchanges the model with `other` that often
  std::shared_ptr<const FittedModel> other{};
};
// Presses within 0.3 s, receives a pulse of 1 N at 0.6 s, holds still until 1.5 s, and returns to the air; a free mass
// is pushed with the force and let go at 1.5 s. Energy: given out while the hand holds still, or over the whole run if
// that is more.
HardFigures measure_hand(const HandTrial& trial, Block& block, const std::shared_ptr<const FittedModel>& model);

}  // namespace palpate
