#include "scenes/evaluation/model_timing.h"

#include <algorithm>
#include <array>
#include <chrono>

#include "engine/tick/haptics_tick.h"

namespace palpate {
namespace {

using Clock = std::chrono::steady_clock;

// The means of `step(index)` over every block of indices below `count`.
template <typename Step>
Timing blocks_of(std::size_t count, const Step& step) {
  const std::size_t block = std::min<std::size_t>(count, 64);
  std::vector<double> means_ns;
  for (std::size_t first = 0; first + block <= count; first += block) {
    const auto start = Clock::now();
    for (std::size_t i = first; i < first + block; ++i) step(i);
    const std::chrono::duration<double, std::nano> elapsed = Clock::now() - start;
    means_ns.push_back(elapsed.count() / static_cast<double>(block));
  }
  std::sort(means_ns.begin(), means_ns.end());
  // Nearest rank.
  const auto percentile = [&](std::size_t percent) { return means_ns[(means_ns.size() * percent + 99) / 100 - 1]; };
  return {percentile(50), percentile(99)};
}

}  // namespace

ModelTiming time_model(const std::shared_ptr<const ForceModel>& model, const SensorSpec& sensor,
                       const std::vector<ToolSample>& samples) {
  if (samples.empty()) return {};
  // Once for the features, which also warms caches and the clock.
  std::vector<std::array<double, kMaxFeatures>> features;
  HapticsTick first(sensor, {model});
  for (const ToolSample& one : samples) {
    first.step(one);
    features.push_back(first.features_of(0).values);
  }
  ModelTiming timing;
  double force_N = 0.0;
  HapticsTick tick(sensor, {model});
  timing.tick = blocks_of(samples.size(), [&](std::size_t i) { force_N = tick.step(samples[i]).force_N[0]; });
  timing.evaluation = blocks_of(features.size(), [&](std::size_t i) {
    std::array<double, kMaxFeatures> x = features[i];
    x[0] += 0.0 * force_N;  // nothing changes but the order of things
    force_N = model->evaluate(x.data()).force_N;
  });
  // Somebody has to want the forces, or the calls might be left out.
  volatile double wanted = force_N;
  static_cast<void>(wanted);
  timing.measured = true;
  return timing;
}

}  // namespace palpate
