// How long a model takes, measured on samples that it meets in use.
//
//   tick         motion estimate, features and force of this one model: what a caller waits for
//   evaluation   the force alone, from features that are there already
// Thread guarantee: slow side; one thread per object.
#pragma once

#include <cstddef>
#include <cstdint>
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

// Keeps runs of kBlock consecutive samples, spread evenly over a stream of any length, in
// bounded memory: when full, it drops every other run and from then on keeps half as many.
class TimingSample {
 public:
  static constexpr std::size_t kBlock = 64;
  static constexpr std::size_t kMaximumBlocks = 256;

  // Samples in contact, in time order: out of contact no model is evaluated.
  void add(const ToolSample& sample);
  const std::vector<ToolSample>& samples() const { return kept_; }

 private:
  std::vector<ToolSample> kept_;
  std::uint64_t seen_ = 0;
  std::uint64_t stride_ = 1;  // keep one run in so many
};

// Takes `model` through all of `sample`, kBlock steps at a time; median and 99th percentile
// of the blocks' means. Evaluations wait for the last one's force, as in a tick.
ModelTiming time_model(const std::shared_ptr<const ForceModel>& model, const SensorSpec& sensor,
                       const TimingSample& sample);

}  // namespace palpate
