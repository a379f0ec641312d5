#include "engine/tick/force_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/tick/haptics_tick.h"

namespace palpate {
namespace {

// The range of a model that has none.
constexpr double kUsualDepth_m = 10e-3;
// The cycles: so small that they resolve the curve of a thin specimen, and the usual vibration of a hand otherwise.
constexpr double kCycleShare = 0.01, kLargestCycle_m = 0.1e-3;
constexpr double kFastPeriod_s = 0.5;

}  // namespace

ProbingStrokes::ProbingStrokes(const ForceModel& model) noexcept
    : surface_m_(model.surface_m()), depth_m_(std::isfinite(model.deepest_m()) ? model.deepest_m() : kUsualDepth_m) {
  cycle_m_ = std::min(kCycleShare * depth_m_, kLargestCycle_m);
}

ToolSample ProbingStrokes::at(std::size_t index) const noexcept {
  const double time_s = kStep_s * static_cast<double>(index + 1);
  constexpr double kTurn = 2.0 * std::numbers::pi;
  if (index >= kPlaces * kPlaceSamples) {
    const double fast_s = kStep_s * static_cast<double>(index - kPlaces * kPlaceSamples);
    return {time_s, surface_m_ + 0.5 * depth_m_ * (1.0 + std::cos(kTurn * fast_s / kFastPeriod_s))};
  }
  const auto depth_of = [&](std::size_t place) {  // 0: the surface
    return place == 0 ? 0.0 : cycle_m_ + (depth_m_ - 2.0 * cycle_m_) * static_cast<double>(place) / kPlaces;
  };
  const std::size_t place = index / kPlaceSamples, i = index % kPlaceSamples;
  const double from_m = depth_of(place), to_m = depth_of(place + 1);
  if (i < kRestSamples) {
    const double share = std::min(1.0, 2.0 * static_cast<double>(i + 1) / kRestSamples);
    return {time_s, surface_m_ + from_m + share * (to_m - from_m)};
  }
  const double phase = kTurn * static_cast<double>(i - kRestSamples) / kCycleSamples;
  return {time_s, surface_m_ + to_m + cycle_m_ * std::sin(phase)};
}

ProbedForces probed_forces(const std::shared_ptr<const ForceModel>& model) {
  const ProbingStrokes strokes(*model);
  ProbedForces probed{model->surface_m(), model->deepest_m(), std::vector<double>(ProbingStrokes::kSamples)};
  HapticsTick tick({}, {model});
  for (std::size_t i = 0; i < probed.forces_N.size(); ++i) probed.forces_N[i] = tick.step(strokes.at(i)).force_N[0];
  return probed;
}

}  // namespace palpate
