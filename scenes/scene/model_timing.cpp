#include "scenes/scene/model_timing.h"

#include <algorithm>
#include <chrono>

namespace palpate {
namespace {

using Clock = std::chrono::steady_clock;

// Mean time of `count` calls from `first` on, each with the last force in its
// first feature: times zero, so nothing changes but the order of things.
double block_ns(const ForceModel& model, const FeatureSample& sample, std::size_t first, std::size_t count,
                double& force_N) {
  const std::size_t features = model.features().size();
  const auto start = Clock::now();
  for (std::size_t i = first; i < first + count; ++i) {
    std::array<double, kMaxFeatures> x{};
    std::copy_n(sample[i], features, x.begin());
    x[0] += 0.0 * force_N;
    force_N = model.evaluate(x.data()).force_N;
  }
  const std::chrono::duration<double, std::nano> elapsed = Clock::now() - start;
  return elapsed.count() / static_cast<double>(count);
}

// Nearest rank.
double percentile(const std::vector<double>& sorted, std::size_t percent) {
  return sorted[(sorted.size() * percent + 99) / 100 - 1];
}

}  // namespace

void FeatureSample::add(const FeatureVector& features) {
  const bool keep = (seen_ / kBlock) % stride_ == 0;
  ++seen_;
  if (!keep) return;
  if (kept_.size() == kBlock * kMaximumBlocks) {
    for (std::size_t i = 0; i < kept_.size() / 2; ++i) kept_[i] = kept_[i / kBlock * 2 * kBlock + i % kBlock];
    kept_.resize(kept_.size() / 2);
    stride_ *= 2;
    // kMaximumBlocks is even, so this vector begins a run that is kept.
  }
  kept_.push_back(features.values);
}

ModelTiming time_model(const ForceModel& model, const FeatureSample& sample) {
  if (sample.size() == 0) return {};
  double force_N = 0.0;
  const std::size_t block = std::min(sample.size(), FeatureSample::kBlock);
  block_ns(model, sample, 0, block, force_N);  // warms caches and the clock
  std::vector<double> means;
  for (std::size_t first = 0; first + block <= sample.size(); first += block) {
    means.push_back(block_ns(model, sample, first, block, force_N));
  }
  // Somebody has to want the forces, or the calls might be left out.
  volatile double wanted = force_N;
  static_cast<void>(wanted);
  std::sort(means.begin(), means.end());
  return {percentile(means, 50), percentile(means, 99), true};
}

}  // namespace palpate
