// One tick of haptic rendering as a plain function: a tool sample in, every
// model's force and a snapshot out. No clock, no thread, no device: replay and
// the live loop call the same code, so the same samples give the same bits.
//
// The order is: motion estimate (once), features (once per distinct feature
// list among the models), forces (every model). Out of contact every force is 0.
//
// Thread guarantee: construction and `set_models` allocate and belong to the
// slow side, before ticking starts; `step` is wait-free, allocates nothing,
// locks nothing, does no I/O and never throws; one thread at a time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <vector>

#include "engine/tick/features.h"
#include "engine/tick/force_model.h"
#include "engine/tick/motion_estimator.h"

namespace palpate {

inline constexpr std::size_t kMaxModels = 16;

enum class TickFault : std::uint8_t {
  none,
  bad_sample,        // a value of the sample was not finite: the tick keeps its last state
  time_not_later,    // the sample is not later than the last one: likewise
  force_not_finite,  // a model gave a non-finite force: 0 instead
};

// Everything a tick has to say, for the graphics thread and for replay.
struct TickSnapshot {
  std::uint64_t tick = 0;
  double time_s = 0.0;
  double position_m = 0.0;
  double depth_m = 0.0;
  double velocity_m_per_s = 0.0;
  bool in_contact = false;
  TickFault fault = TickFault::none;
  std::uint32_t model_count = 0;
  std::uint32_t out_of_domain_mask = 0;  // bit i: model i
  std::array<double, kMaxModels> force_N{};
  // 95 % bounds on the errors of the forces; NaN where a model has none, and 0 out of
  // contact.
  std::array<double, kMaxModels> predicted_error_N{};
};
static_assert(std::is_trivially_copyable_v<TickSnapshot>);

// Where the tool was, for the memory of models that were not there.
struct PastMotion {
  double time_s = 0.0;
  double position_m = 0.0;
  double velocity_m_per_s = 0.0;
};

class HapticsTick {
 public:
  // `models`: up to kMaxModels, kept alive by the caller's shared pointers.
  HapticsTick(const SensorSpec& sensor, std::vector<std::shared_ptr<const ForceModel>> models);

  // Forgets motion and filters; the next sample starts a new stream.
  void reset() noexcept;

  const TickSnapshot& step(const ToolSample& sample) noexcept;

  // Goes through a step with the last sample once more and forgets it: code and data that
  // the next one needs are in the caches then. In contact or not, for the next sample may
  // be. Wait-free; the next `step` gives what it would have given.
  void rehearse() noexcept;

  // Slow side, before `continue_from`: the filters meet the tool there; times increase.
  void recall(const PastMotion& motion) noexcept;

  // Goes on where `before` is: same motion estimate and, for every feature that both
  // have, same memory, so that a change of models in mid-press loses none of the
  // material's; its snapshot is that of these models. A feature that is new has the
  // memory of what was recalled, up to a few seconds ago, or is at rest at the last
  // sample. Same sensor. Wait-free.
  void continue_from(const HapticsTick& before) noexcept;

  // Slow side: from now on `step` also times each evaluation, in units of
  // engine/base/cycle_clock.h; some 10 ns each.
  void time_evaluations(bool timed) noexcept { timed_ = timed; }
  // What the last evaluation of model `index` took; 0 before the first one. Out of
  // contact nothing is evaluated and the figure stays.
  std::uint64_t evaluation_cycles(std::size_t index) const noexcept { return cycles_[index]; }

  // What `step` gave last.
  const TickSnapshot& snapshot() const noexcept { return snapshot_; }

  MotionEstimate motion() const noexcept { return motion_.estimate(); }

  std::size_t model_count() const noexcept { return models_.size(); }
  const ForceModel& model(std::size_t index) const noexcept { return *models_[index]; }
  // The features that model `index` was last given.
  const FeatureVector& features_of(std::size_t index) const noexcept { return filters_[filter_of_[index]].vector(); }
  std::size_t filter_count() const noexcept { return filters_.size(); }

 private:
  void evaluate_models() noexcept;

  MotionEstimator motion_;
  std::vector<std::shared_ptr<const ForceModel>> models_;
  std::vector<FeatureFilter> filters_;
  std::vector<std::size_t> filter_of_;  // per model
  std::array<std::uint64_t, kMaxModels> cycles_{};
  ToolSample sample_;         // the last one
  double rehearsed_N_ = 0.0;  // so that no rehearsal is optimised away
  TickSnapshot snapshot_;
  bool started_ = false;
  bool timed_ = false;
};

}  // namespace palpate
