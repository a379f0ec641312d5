// Computation time of models, measured on samples in contact.
//   tick         motion estimate, features and force of this one model
//   evaluation   the force alone, from features that are computed before
// There are kTimingRounds rounds, and each round times every model once, so that a slow phase of the machine
// affects all models. The true median lies between the least and the greatest of n rounds with probability
// 1 - 2^(1 - n): 97 % for six.
// Thread guarantee: slow side; one thread per call.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "engine/tick/force_model.h"
#include "engine/tick/tool_sample.h"

namespace palpate {

inline constexpr int kTimingRounds = 6;

// A round takes the mean time of a step in each block of 64 steps, and of these means median and 99th percentile.
struct Timing {
  double median_ns = 0.0;  // median of the rounds' medians
  double low_ns = 0.0;     // the least of these medians
  double high_ns = 0.0;    // the greatest of these medians
  double p99_ns = 0.0;     // median of the rounds' 99th percentiles
};

struct ModelTiming {
  Timing tick;
  Timing evaluation;
  bool measured = false;  // false: there were no samples
};

// Largest number of samples of one recording that are timed. All are in contact; in air no model is evaluated.
inline constexpr std::size_t kTimedSamples = 4096;

// Samples of one recording, with its sensor.
struct TimedSamples {
  SensorSpec sensor;
  std::vector<ToolSample> samples;
};

// Returns one result per model, over these samples; without any stretch, over its own ProbingStrokes. Each evaluation
// depends on the last force, so that the processor cannot overlap them.
std::vector<ModelTiming> time_models(const std::vector<std::shared_ptr<const ForceModel>>& models,
                                     const std::vector<TimedSamples>& stretches);

}  // namespace palpate
