// One tick of the live loop, without clock and thread: the loop calls it every millisecond, tests call it directly.
//   take a new set of models -> read the device -> HapticsTick for each sample
//   -> mix (the active model) -> scale -> passivity -> limit -> write the device -> snapshot
// Thread guarantee: constructed on the slow side. `warm_up` (before the first `run`), `run` and `rehearse` belong to
// the haptics thread; they are wait-free, allocate nothing, lock nothing and never throw.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <type_traits>

#include "engine/live/device.h"
#include "engine/live/force_guard.h"
#include "engine/live/handover.h"
#include "engine/tick/haptics_tick.h"
#include "engine/tick/jnd.h"

namespace palpate {

// A reference for the models' forces that is computed in the same ticks: the true force of a virtual material.
class ReferenceForce {
 public:
  virtual ~ReferenceForce() = default;
  // Haptics thread. Wait-free, never throws. `restart`: resets the memory first.
  virtual double step(const TickSnapshot& snapshot, bool restart) noexcept = 0;
};

// A force that replaces those of the models, e.g. the stimulus of a study.
class ForceSource {
 public:
  virtual ~ForceSource() = default;
  // Haptics thread, once a tick. Wait-free, never throws. `rendered_N`: the device's force in the last tick. Returns
  // the next force, finite or not: the limiter comes after it.
  virtual double next_force_N(double rendered_N) noexcept = 0;
};

// Slow side. The impedance of a model for a cycle of 0.1 mm (or 1 % of its greatest depth, if that is less) at 25 Hz:
// the largest over all its depths, stiffness and damping each.
Impedance impedance_of(const std::shared_ptr<const ForceModel>& model);

// The data that are exchanged at once when the models change.
struct LiveModels {
  // Slow side: sizes all workspaces and measures every model's impedance. `id` > 0 identifies this set in snapshots and
  // controls. `reference` may be null; consecutive sets may share one, because only the newest set calls it.
  LiveModels(std::uint32_t id, const SensorSpec& sensor, const ForceModels& models,
             std::shared_ptr<ReferenceForce> reference = nullptr);

  std::uint32_t id;
  HapticsTick tick;
  std::shared_ptr<ReferenceForce> reference;
  // The impedance_of each model.
  ForceMixer::Forces stiffness_N_per_m{}, damping_Ns_per_m{};
  std::uint32_t selected = 0;  // until the controls refer to this set
  // The model whose force is RecordedSample::model_N, for recordings with neither a force sensor nor a ReferenceForce;
  // default: none.
  std::uint32_t written_model = kMaxModels;
};

// The switch that must be held for a force.
enum class DeadMan : std::uint8_t {
  off,   // none
  key,   // a key or a button, see LoopControls::held_s
  grip,  // the switch on the device's handle
};

// A key counts as held for this time after LoopControls::held_s, so that a window that hangs releases it.
inline constexpr double kDeadManHold_s = 0.2;

struct LoopControls {
  std::uint32_t models_id = 0;  // the set that `selected` refers to
  std::uint32_t selected = 0;   // the active model
  std::uint32_t recording = 0;  // > 0: all samples are recorded with this number
  DeadMan dead_man = DeadMan::off;
  // The last time when the dead-man key was held, steady clock; to be updated in every frame.
  double held_s = -std::numeric_limits<double>::infinity();
  ForceScale scale{};  // of the models' force
  // Incremented each time the user has acknowledged the latched faults: they are cleared.
  std::uint32_t acknowledged = 0;
};

// The results of a live tick. `tick.force_N[i]` are the models' forces, `rendered_N` is the device's.
struct LoopSnapshot {
  TickSnapshot tick;
  double loop_time_s = 0.0;  // steady clock; does not restart with `tick.time_s`
  double commanded_N = 0.0;  // force of the models, scaled; or of the ForceSource
  double passive_N = 0.0;    // after the passivity controller, before the limiter
  double rendered_N = 0.0;
  double measured_N = kNoForce;   // of the device's force sensor; NaN: none
  double reference_N = kNoForce;  // of the set's ReferenceForce; NaN: none
  std::uint64_t missed_deadlines = 0;
  std::uint32_t models_id = 0;  // the set that computed these forces
  std::uint32_t selected = 0;
  std::uint32_t samples = 0;         // read from the device in this tick; 0: state as before
  std::uint32_t faults = 0;          // of this tick, loop_fault
  std::uint32_t faults_latched = 0;  // since the last acknowledgement
  DeviceHealth device;               // at this tick
  std::uint32_t device_faults_latched = 0;
  std::uint32_t limiter_flags = 0;  // force_limit
  float heat_share = 0.0F;          // ForceLimiter::heat_share
  float stiffness_share = 1.0F;     // rendered part of the wanted one; < 1: StabilityLimit
  float delay_ms = 0.0F;            // LoopDelay
  bool dead_man_released = false;   // the dead-man switch is released: no force
  bool fading = false;              // between two models
  bool restarted = false;           // a new stream began in this tick
};
static_assert(std::is_trivially_copyable_v<LoopSnapshot>);

// One sample of the device, for a recorder: a tick may read several, of which a snapshot has only the last.
struct RecordedSample : DeviceSample {
  double reference_N = kNoForce;  // of the set's ReferenceForce at this sample
  double model_N = kNoForce;      // of the set's `written_model` at this sample
  std::uint32_t recording = 0;    // as in LoopControls
  bool usable = true;             // false: not finite, or not later than the one before
};

// Half a minute at 1 kHz, and more than a second at 20 kHz, in which the recorder may stall.
inline constexpr std::size_t kRecordedRing = 32768;
using RecordedRing = SpscRing<RecordedSample, kRecordedRing>;

struct LiveTickSettings {
  JndLine jnd;
  ForceSource* source = nullptr;  // outlives the tick; null: the models. With a source, publish no sets.
};

class LiveTick {
 public:
  // `device` outlives this. Forces are 0 until a set of models is taken.
  LiveTick(Device& device, ModelSlot<LiveModels>& slot, const LiveTickSettings& settings = {});

  // Takes the pending set, runs its tick on synthetic strokes and resets it, so that caches and branch predictors are
  // warm.
  void warm_up() noexcept;

  // Loads code and data of the next `run` into the caches; no state changes.
  void rehearse() noexcept { models_->tick.rehearse(); }

  // `now_s`: steady clock. The snapshot is valid until the next call.
  const LoopSnapshot& run(double now_s, const LoopControls& controls) noexcept;

  // One reader thread. Every sample that was read while the controls requested a recording.
  RecordedRing& recorded() noexcept { return *recorded_; }

 private:
  void update_models() noexcept;
  void process_samples(double now_s) noexcept;
  void process_sample(const DeviceSample& sample) noexcept;
  void record(const DeviceSample& sample) noexcept;
  double mix(double step_s) noexcept;
  bool dead_man_released() const noexcept;
  Impedance impedance() const noexcept;
  ForceGuard::Tool tool(bool in_contact) const noexcept;
  void render(double step_s) noexcept;

  Device& device_;
  ModelSlot<LiveModels>& slot_;
  ForceMixer mixer_;
  ForceGuard guard_;
  bool held_;  // by a person
  ForceLimiter limiter_;
  ForceSource* source_;
  std::unique_ptr<LiveModels> models_;    // before the first published set: one without models
  std::unique_ptr<LiveModels> outgoing_;  // previous set until its fade ends; then retired
  std::uint32_t outgoing_selected_ = 0;
  LoopControls controls_;  // of this tick
  LoopSnapshot snapshot_;
  std::unique_ptr<RecordedRing> recorded_;                        // 2.4 MB: too much for a stack
  double sampled_s_ = -std::numeric_limits<double>::infinity();   // time of the tick that read the last sample
  double assessed_s_ = -std::numeric_limits<double>::infinity();  // of the last HapticsTick::assess
  bool started_ = false;
};

}  // namespace palpate
