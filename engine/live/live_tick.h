// One tick of the live loop: device in, models, force out, snapshot. No clock
// and no thread: the loop calls it every millisecond, a test calls it as it
// likes. The models' forces are those of HapticsTick, so live and replay give
// the same bits for the same samples.
//
//   take a new set of models -> read the device -> HapticsTick for each sample
//   -> mix (the active model) -> scale -> passivity -> limit -> write the device -> snapshot
//
// Thread guarantee: built on the slow side; `run` and `release` belong to the
// haptics thread, are wait-free, allocate nothing, lock nothing and never throw.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <type_traits>

#include "engine/live/device.h"
#include "engine/live/faults.h"
#include "engine/live/force_limiter.h"
#include "engine/live/force_mixer.h"
#include "engine/live/force_scale.h"
#include "engine/live/model_slot.h"
#include "engine/live/passivity_controller.h"
#include "engine/live/spsc_ring.h"
#include "engine/live/stability_limit.h"
#include "engine/tick/haptics_tick.h"
#include "engine/tick/jnd.h"

namespace palpate {

// A force to compare the models with that is computed along with them: the true
// force of a virtual material.
class ReferenceForce {
 public:
  virtual ~ReferenceForce() = default;
  // Haptics thread. Wait-free, never throws. `restart`: forget what was before.
  virtual double step(const TickSnapshot& snapshot, bool restart) noexcept = 0;
};

// A force that comes from no model, in the models' place: what a study presents.
class ForceSource {
 public:
  virtual ~ForceSource() = default;
  // Haptics thread, once a tick. Wait-free, never throws. `rendered_N`: what the
  // device got in the tick before. Returns what it should get now, finite or not:
  // the limiter comes behind it.
  virtual double next_force_N(double rendered_N) noexcept = 0;
};

// Everything that is exchanged at once when the models change.
struct LiveModels {
  // Slow side: sizes all workspaces and measures every model's stiffness. `id`, above
  // 0, tells this set from others in snapshots and controls. `reference` may be
  // null; sets that follow each other may share one, for only the newest steps it.
  LiveModels(std::uint32_t id, const SensorSpec& sensor, std::vector<std::shared_ptr<const ForceModel>> models,
             std::shared_ptr<ReferenceForce> reference = nullptr);

  std::uint32_t id;
  HapticsTick tick;
  std::shared_ptr<ReferenceForce> reference;
  // Of every model: of cycles of 0.1 mm at 25 Hz, the largest over depths to 10 mm and forces to 10 N.
  ForceMixer::Forces stiffness_N_per_m{}, damping_Ns_per_m{};
  std::uint32_t selected = 0;  // until the controls speak of this set
  // The model whose force goes into RecordedSample, none by default: the reference
  // where there is neither a sensor nor a ReferenceForce.
  std::uint32_t written_model = kMaxModels;
};

// What has to be held for the device to push.
enum class DeadMan : std::uint8_t {
  off,   // nothing
  key,   // a key or a button, see LoopControls::held_s
  grip,  // the switch on the device's handle
};

// How long a key counts as held after it was last seen held: a window that
// hangs holds nothing.
inline constexpr double kDeadManHold_s = 0.2;

// What the user wants of the loop.
struct LoopControls {
  std::uint32_t models_id = 0;  // the set that `selected` speaks of
  std::uint32_t selected = 0;   // the active model
  std::uint32_t recording = 0;  // above 0: every sample goes into the ring under this number
  DeadMan dead_man = DeadMan::off;
  // When the dead-man key was last seen held, on the loop's steady clock: set it
  // anew in every frame.
  double held_s = -std::numeric_limits<double>::infinity();
  ForceScale scale{};  // of the models' force
  // Raised by one each time the user has seen the latched faults: they are cleared.
  std::uint32_t acknowledged = 0;
};

inline constexpr double kNoForce = std::numeric_limits<double>::quiet_NaN();

// What a live tick has to say. `tick.force_N[i]` are the models' forces,
// `rendered_N` is what the device got.
struct LoopSnapshot {
  TickSnapshot tick;
  double loop_time_s = 0.0;  // steady clock; goes on where `tick.time_s` starts over
  double commanded_N = 0.0;  // what the models ask for
  double passive_N = 0.0;    // what the passivity controller left of it, before the limiter
  double rendered_N = 0.0;
  double measured_N = kNoForce;   // of the device's force sensor; NaN: none
  double reference_N = kNoForce;  // of the set's ReferenceForce; NaN: none
  std::uint64_t missed_deadlines = 0;
  std::uint32_t models_id = 0;  // whose forces these are
  std::uint32_t selected = 0;
  std::uint32_t samples = 0;         // taken from the device in this tick; 0: state as before
  std::uint32_t faults = 0;          // of this tick, loop_fault
  std::uint32_t faults_latched = 0;  // of all ticks since the last were acknowledged
  DeviceHealth device;               // at this tick
  std::uint32_t device_faults_latched = 0;
  std::uint32_t limiter_flags = 0;  // force_limit
  float heat_share = 0.0F;          // of the motor's thermal budget
  float stiffness_share = 1.0F;     // of the stiffness that is wanted: more would not be stable, see StabilityLimit
  float late_ms = 0.0F;             // of the force behind the motion
  bool dead_man_released = false;   // nobody holds the dead-man switch: no force
  bool fading = false;              // the hand is on its way from one model to another
  bool restarted = false;           // a new stream began in this tick
  float lateness_us = 0.0F;
  float tick_us = 0.0F;  // of the tick before this one
  std::array<float, kMaxModels> evaluation_ns{};
};
static_assert(std::is_trivially_copyable_v<LoopSnapshot>);

// One sample as the device gave it, for a recorder: a tick may take several, of
// which a snapshot has only the last.
struct RecordedSample {
  ToolSample tool;
  double measured_N = kNoForce;
  double reference_N = kNoForce;  // of the set's ReferenceForce at this sample
  double model_N = kNoForce;      // of the set's `written_model` at this sample
  std::uint32_t recording = 0;    // as in LoopControls
  bool restart = false;           // a new stream begins here
  bool usable = true;             // false: not finite, or not later than the one before
};
static_assert(std::is_trivially_copyable_v<RecordedSample>);

// At 1 kHz half a minute, at 20 kHz more than a second of a recorder that stands still.
inline constexpr std::size_t kRecordedRing = 32768;
using RecordedRing = SpscRing<RecordedSample, kRecordedRing>;

struct LiveTickSettings {
  JndLine jnd;
  RecordedRing* recorded = nullptr;  // outlives the tick; null: nobody records
  ForceSource* source = nullptr;     // outlives the tick; null: the models
  bool passivity = true;             // false: for tests of what its controller is needed for
};

class LiveTick {
 public:
  // `device` outlives this. No models yet: forces are 0 until a set is taken.
  LiveTick(Device& device, ModelSlot<LiveModels>& slot, const LiveTickSettings& settings = {});
  LiveTick(const LiveTick&) = delete;
  LiveTick& operator=(const LiveTick&) = delete;
  ~LiveTick();

  // Takes the pending set and runs its tick on made-up strokes, then forgets
  // them: caches and branch predictors are warm before the device counts.
  void warm_up() noexcept;

  // What the next `run` will need is in the caches; nothing changes.
  void rehearse() noexcept {
    if (models_ != nullptr) models_->tick.rehearse();
  }

  // `now_s`: steady clock. The snapshot lives until the next call.
  const LoopSnapshot& run(double now_s, const LoopControls& controls) noexcept;

  // As `run`, towards no force; true once the device was given 0.
  bool release(double now_s) noexcept;

  // The last sample's tick, for tests of live against replay.
  const HapticsTick* models() const noexcept { return models_ != nullptr ? &models_->tick : nullptr; }

 private:
  void update_models() noexcept;
  void process_samples(double now_s) noexcept;
  void read_health(double now_s) noexcept;
  void process_sample(const DeviceSample& sample) noexcept;
  void step_models(const DeviceSample& sample) noexcept;
  void publish_sample(const DeviceSample& sample) noexcept;
  double mix(const LoopControls& controls, double step_s) noexcept;
  void acknowledge(const LoopControls& controls) noexcept;
  bool dead_man_released(const LoopControls& controls) const noexcept;
  Impedance impedance() const noexcept;
  double scale(double force_N, const ForceScale& wanted, double step_s) noexcept;
  double passive(double commanded_N, double step_s) noexcept;
  void render(double commanded_N, double passive_N, double step_s, bool dead_man_released) noexcept;

  Device& device_;
  ModelSlot<LiveModels>& slot_;
  ForceMixer mixer_;
  StabilityLimit stability_;
  bool bounded_;  // by it: a person holds the device, not a simulated hand
  ScaledForce scaled_;
  PassivityController passivity_;
  bool passivity_on_;
  ForceLimiter limiter_;
  ForceSource* source_;
  LiveModels* models_ = nullptr;
  LiveModels* outgoing_ = nullptr;  // still felt; retired when it is not
  ForceMixer outgoing_mixer_;
  LoopSnapshot snapshot_;
  RecordedRing* recorded_;
  std::uint32_t recording_ = 0;
  std::uint32_t acknowledged_ = 0;
  double ns_per_cycle_;
  double now_s_ = 0.0;
  double sampled_s_ = -std::numeric_limits<double>::infinity();  // the tick that took the last sample
  bool started_ = false;
};

}  // namespace palpate
