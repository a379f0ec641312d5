// How long one evaluation of a model takes, measured on feature vectors that it
// meets in use.
// Thread guarantee: slow side; one thread per object.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/tick/features.h"
#include "engine/tick/force_model.h"

namespace palpate {

struct ModelTiming {
  double median_ns = 0.0;
  double p99_ns = 0.0;
  bool measured = false;  // false: there was nothing to evaluate
};

// Keeps runs of kBlock consecutive feature vectors, spread evenly over a stream of
// any length, in bounded memory: when full, it drops every other run and from
// then on keeps half as many.
class FeatureSample {
 public:
  static constexpr std::size_t kBlock = 64;
  static constexpr std::size_t kMaximumBlocks = 256;

  void add(const FeatureVector& features);
  std::size_t size() const { return kept_.size(); }
  const double* operator[](std::size_t index) const { return kept_[index].data(); }

 private:
  std::vector<std::array<double, kMaxFeatures>> kept_;
  std::uint64_t seen_ = 0;
  std::uint64_t stride_ = 1;  // keep one run in so many
};

// Evaluates `model` at all of `sample`, kBlock calls at a time, each waiting for
// the last one's force as in a tick; median and 99th percentile of the blocks'
// means.
ModelTiming time_model(const ForceModel& model, const FeatureSample& sample);

}  // namespace palpate
