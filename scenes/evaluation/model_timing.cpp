#include "scenes/evaluation/evaluate.h"

#include <algorithm>
#include <array>
#include <chrono>

#include "engine/tick/haptics_tick.h"

namespace palpate {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::size_t kBlock = 64;

// Appends the mean time of `step(index)` over every block of indices below `count`.
template <typename Step>
void add_blocks(std::size_t count, std::vector<double>& means_ns, const Step& step) {
  const std::size_t block = std::min(count, kBlock);
  for (std::size_t first = 0; first + block <= count; first += block) {
    const auto start = Clock::now();
    for (std::size_t i = first; i < first + block; ++i) step(i);
    const std::chrono::duration<double, std::nano> elapsed = Clock::now() - start;
    means_ns.push_back(elapsed.count() / static_cast<double>(block));
  }
}

// The percentile by nearest rank. `sorted` is in ascending order.
double percentile(const std::vector<double>& sorted, std::size_t percent) {
  return sorted[(sorted.size() * percent + 99) / 100 - 1];
}

// The mean times of one model's blocks of calls, in one round over all samples.
struct Round {
  std::vector<double> tick_ns;
  std::vector<double> evaluation_ns;
};

Round time_round(const ModelPointer& model, const std::vector<TimedSamples>& stretches) {
  Round round;
  double force_N = 0.0;
  for (const TimedSamples& stretch : stretches) {
    if (stretch.samples.empty()) continue;
    // A long time before, in air: a stream that begins in contact costs more (engine/tick/haptics_tick.h).
    ToolSample before = stretch.samples.front();
    before.time_s -= 1000.0;
    before.position_m = model->surface_m() - 1.0;
    // The first pass computes the features, and warms up caches and the processor's clock.
    std::vector<std::array<double, kMaxFeatures>> features;
    HapticsTick first(stretch.sensor, {model});
    first.step(before);
    for (const ToolSample& one : stretch.samples) {
      first.step(one);
      features.push_back(first.features_of(0).values);
    }
    HapticsTick tick(stretch.sensor, {model});
    tick.step(before);
    add_blocks(features.size(), round.tick_ns,
               [&](std::size_t i) { force_N = tick.step(stretch.samples[i]).force_N[0]; });
    add_blocks(features.size(), round.evaluation_ns, [&](std::size_t i) {
      std::array<double, kMaxFeatures> x = features[i];
      x[0] += 0.0 * force_N;  // adds 0; each call depends on the last, as in the tick
      force_N = model->force(x.data());
    });
  }
  // The forces must be used, or the compiler may remove the calls.
  volatile double wanted = force_N;
  static_cast<void>(wanted);
  std::sort(round.tick_ns.begin(), round.tick_ns.end());
  std::sort(round.evaluation_ns.begin(), round.evaluation_ns.end());
  return round;
}

std::vector<TimedSamples> own_strokes(const ForceModel& model) {
  const ProbingStrokes strokes(model);
  TimedSamples all;
  for (std::size_t i = 0; i < ProbingStrokes::kSamples; ++i) all.samples.push_back(strokes.at(i));
  return {all};
}

Timing timing_of(const std::vector<Round>& rounds, std::vector<double> Round::*times) {
  std::vector<double> medians;
  std::vector<double> p99s;
  for (const Round& round : rounds) {
    medians.push_back(percentile(round.*times, 50));
    p99s.push_back(percentile(round.*times, 99));
  }
  std::sort(medians.begin(), medians.end());
  std::sort(p99s.begin(), p99s.end());
  return {percentile(medians, 50), medians.front(), medians.back(), percentile(p99s, 50)};
}

}  // namespace

std::vector<ModelTiming> time_models(const std::vector<ModelPointer>& models,
                                     const std::vector<TimedSamples>& stretches) {
  std::vector<ModelTiming> timings(models.size());
  const bool anything =
      std::any_of(stretches.begin(), stretches.end(), [](const TimedSamples& one) { return !one.samples.empty(); });
  if (!anything && !stretches.empty()) return timings;
  std::vector<std::vector<Round>> rounds(models.size());
  for (int round = 0; round < kTimingRounds; ++round) {
    for (std::size_t i = 0; i < models.size(); ++i)
      rounds[i].push_back(time_round(models[i], stretches.empty() ? own_strokes(*models[i]) : stretches));
  }
  for (std::size_t i = 0; i < models.size(); ++i)
    timings[i] = {timing_of(rounds[i], &Round::tick_ns), timing_of(rounds[i], &Round::evaluation_ns), true};
  return timings;
}

}  // namespace palpate
