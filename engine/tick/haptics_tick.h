// One tick of haptic rendering: takes a tool sample, returns every model's force and a snapshot. It has no clock,
// thread or device: replay and live loop call the same code, so the same samples give the same bits. Motion is
// estimated once, features once per distinct list, forces for every model; out of contact every force is 0.
//
// A stream that begins in contact does not show what was pressed before. The force assumes that the material was at
// rest at this depth, or that the stream continues a training recording (features.h). Two extreme histories are
// simulated beside it until the tool leaves the material: a sudden press from air, and a sudden retreat from a rest at
// the greatest depth of the training. The larger difference of their forces is added to the predicted error. After
// `start_after` the memory of the material is known, and nothing is added.
// Thread guarantee: construction allocates (slow side); `step` is wait-free,
// allocates nothing, locks nothing, does no I/O and never throws; one thread at a time.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <functional>
#include <type_traits>
#include <vector>

#include "engine/recording/recording.h"
#include "engine/tick/features.h"
#include "engine/tick/force_model.h"
#include "engine/tick/motion_estimator.h"

namespace palpate {

inline constexpr std::size_t kMaxModels = 16;

// The values are bits of the live loop's faults (engine/live/device.h).
enum class TickFault : std::uint8_t {
  none = 0,
  bad_sample = 1,        // a value of the sample is not finite: the state is kept
  time_not_later = 2,    // the sample is not later than the last one: the state is kept
  force_not_finite = 4,  // a model returned a non-finite force: replaced by 0
};

// The results of a tick, for the graphics thread and for replay.
struct TickSnapshot {
  std::uint64_t tick = 0;  // number of steps so far
  double time_s = 0.0;
  double position_m = 0.0;        // of the sample
  double depth_m = 0.0;           // max(0, position_m)
  double velocity_m_per_s = 0.0;  // estimated
  bool in_contact = false;        // beyond the surface of at least one model
  TickFault fault = TickFault::none;
  std::uint32_t model_count = 0;
  std::array<double, kMaxModels> force_N{};
  // Of the last HapticsTick::assess: a sample out of contact and the first one in contact are always assessed.
  // Bit i: model i. 95 % bounds on the errors of the forces; NaN if a model has none, 0 while `in_contact` is false.
  std::uint32_t out_of_domain_mask = 0;
  std::array<double, kMaxModels> predicted_error_N{};
};
static_assert(std::is_trivially_copyable_v<TickSnapshot>);

// The motion of the tool in the last minute, thinned to 4 ms. Models that are added during a press start with the
// memory of the material for this motion, not with a material at rest under the tool (HapticsTick::recall).
// Thread guarantee: slow side (allocates); one thread.
class MotionHistory {
 public:
  // Takes the snapshot of every tick in order. `restarted`: it begins a new stream; the earlier motion is deleted.
  void add(const TickSnapshot& snapshot, bool restarted);
  // Oldest first; the velocities are the estimated ones.
  const std::deque<ToolSample>& past() const noexcept { return past_; }

 private:
  std::deque<ToolSample> past_;
};

// The extreme states of a filter while the memory of the material is unknown.
struct ExtremeStates {
  bool unknown = false;
  std::array<FeatureState, 2> states;

  // To be called with the first sample of a stream in contact.
  void begin(const FeaturePlan& plan, const ToolSample& sample) noexcept;
};

class HapticsTick {
 public:
  // `models`: up to kMaxModels.
  HapticsTick(const SensorSpec& sensor, ForceModels models);

  // Resets the motion estimate and the filters; the next sample starts a new stream.
  void reset() noexcept;
  // Slow side: the same, and the next stream continues this recording, after a pause if its time is later: it begins
  // with the memory of the material at the end of these rows. `recording`: of the same rig, positions as recorded.
  void start_after(const Recording& recording);
  // How the stream of model `index` began: kBeganAtRest, kBeganAsTold, or an index of the ends of the model.
  int began(std::size_t index) const noexcept { return filters_[filter_of_[index]].state().began; }

  const TickSnapshot& step(const ToolSample& sample) noexcept;
  // Domain and bound of model `index` at the last sample, NaN before the first; or of all models, into the snapshot.
  // Domain and bound of the last force; the tick itself needs neither. Wait-free; forces and memory do not change.
  ForceEstimate assessed(std::size_t index) const noexcept;
  const TickSnapshot& assess() noexcept;

  // Computes a step 1 ms after the last sample, evaluates the models even out of contact, and discards the result, so
  // that code and data of the next step are in the caches. Wait-free; the state does not change.
  void rehearse() noexcept;

  // Slow side, before `continue_from`: advances the filters of the features by this motion.
  void recall(const MotionHistory& history) noexcept;

  // Continues from the state of `before`: takes over the motion estimate and the memory of equal features; the snapshot
  // is evaluated and assessed with these models. A new feature has the memory of the recalled motion if that ended less
  // than 5 s ago, otherwise it is at rest at the last sample. Requires the same sensor. Wait-free.
  void continue_from(const HapticsTick& before) noexcept;

  // The result of the last `step`.
  const TickSnapshot& snapshot() const noexcept { return snapshot_; }

  MotionEstimate motion() const noexcept { return motion_.estimate(); }
  // The age of the reading from which the forces are, if those since are beyond the reach of a hand; else 0. For the
  // limiter: a force must not jump to another place of the tool, however fast the sensor says it went there.
  double motion_age_s() const noexcept { return motion_.age_s(); }

  std::size_t model_count() const noexcept { return models_.size(); }
  const ForceModel& model(std::size_t index) const noexcept { return *models_[index]; }
  // The last features of model `index`.
  const FeatureVector& features_of(std::size_t index) const noexcept { return filters_[filter_of_[index]].vector(); }

 private:
  void update_features(const MotionEstimate& motion) noexcept;
  void evaluate_models() noexcept;

  MotionEstimator motion_;
  ForceModels models_;
  std::vector<FeatureFilter> filters_;
  std::vector<ExtremeStates> extremes_;  // for each filter
  std::vector<std::size_t> filter_of_;   // for each model
  ToolSample sample_;                    // last sample
  double rehearsed_N_ = 0.0;             // result of `rehearse`, so that the compiler keeps it
  TickSnapshot snapshot_;
  bool started_ = false;
  bool told_ = false;  // the filters have the memory of `start_after`
};

// Replays a recording through the tick of the live loop, without clock and device, as fast as possible. The same rows
// and models give the same bits.
//
// For the visitor, a sample is in contact as RecordedContact says. Thread guarantee: slow side; one thread at a time.

// Called for each row after its tick: `snapshot` has the forces, `tick` the feature vectors. The references are valid
// during the call.
using ReplayVisitor =
    std::function<void(const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick& tick)>;

struct ReplaySummary {
  SensorSpec sensor;
  std::uint64_t samples = 0, contact_samples = 0;
  std::vector<int> began{};  // of each model (HapticsTick::began)
};

// The measured force above which a sample is in contact, N (certain_force_N). The noise is that of the first rows of a
// recording: the white noise or, if larger, the standard deviation before the first contact.
double least_contact_N(const RecordingRow* rows, std::size_t count, double surface_m);

// Which rows of a recording are in contact: those beyond the surface, the outermost of those surfaces of the models
// that are not at 0, and those whose measured force exceeds both the JND at 0 N and five times its noise, because an
// adhesive material also pulls outside. `surface_offset_m`: subtracted from every position.
class RecordedContact {
 public:
  RecordedContact(const Recording& recording, const ForceModels& models, double surface_offset_m = 0.0);
  bool at(const RecordingRow& row) const noexcept {
    return row.position_m - offset_m_ > surface_m_ || std::abs(row.force_N) > least_N_;
  }

 private:
  double offset_m_, surface_m_, least_N_;
};

// `models`: up to kMaxModels. `surface_offset_m` is subtracted from every position before the tick; the visitor
// receives the row as recorded. `after`: the recording that this one continues (HapticsTick::start_after); null: none.
ReplaySummary replay(const Recording& recording, const ForceModels& models, const ReplayVisitor& visitor,
                     double surface_offset_m = 0.0, const Recording* after = nullptr);

}  // namespace palpate
