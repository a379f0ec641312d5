// How long a model takes, measured on samples that it meets in use.
//   tick         motion estimate, features and force of this one model: what a caller waits for
//   evaluation   the force alone, from features that are there already
// Thread guarantee: slow side; one thread per call.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "engine/tick/force_model.h"
#include "engine/tick/tool_sample.h"

namespace palpate {

struct Timing {
  double median_ns = 0.0;
  double p99_ns = 0.0;
};

struct ModelTiming {
  Timing tick;
  Timing evaluation;
  bool measured = false;  // false: there was nothing to evaluate
};

// So many samples in contact tell it; out of contact no model is evaluated.
inline constexpr std::size_t kTimedSamples = 16384;

// Takes `model` through all of `samples`, 64 steps at a time; median and 99th percentile
// of the blocks' means. Evaluations wait for the last one's force, as in a tick.
ModelTiming time_model(const std::shared_ptr<const ForceModel>& model, const SensorSpec& sensor,
                       const std::vector<ToolSample>& samples);

}  // namespace palpate
