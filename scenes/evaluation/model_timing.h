// How long models take, measured on samples that they meet in use.
//   tick         motion estimate, features and force of this one model: what a caller waits for
//   evaluation   the force alone, from features that are there already
// Every model is timed in kTimingRounds rounds, one model after the other in each, so that a slow spell of the
// machine meets all of them. The median of n rounds lies between the least and the greatest of them with
// probability 1 - 2^(1 - n): 97 % for six.
// Thread guarantee: slow side; one thread per call.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "engine/tick/force_model.h"
#include "engine/tick/tool_sample.h"

namespace palpate {

inline constexpr int kTimingRounds = 6;

// Of the rounds' medians over blocks of 64 steps.
struct Timing {
  double median_ns = 0.0;
  double low_ns = 0.0;  // least and greatest
  double high_ns = 0.0;
  double p99_ns = 0.0;  // 99th percentile of the blocks, median of the rounds
};

struct ModelTiming {
  Timing tick;
  Timing evaluation;
  bool measured = false;  // false: there was nothing to evaluate
};

// Enough samples in contact, of all recordings; out of contact no model is evaluated.
inline constexpr std::size_t kTimedSamples = 4096;

// A stretch of one recording, with its sensor.
struct TimedSamples {
  SensorSpec sensor;
  std::vector<ToolSample> samples;
};

// One result a model. Evaluations wait for the last one's force, as in a tick.
std::vector<ModelTiming> time_models(const std::vector<std::shared_ptr<const ForceModel>>& models,
                                     const std::vector<TimedSamples>& stretches);

}  // namespace palpate
