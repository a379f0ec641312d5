// The models of a session, and the sets of models that are published to the haptics loop.
// Every model has a slot, numbered in the order of the requests. The worker fits the models, those of the least
// expected time first, and a model joins the next set when it is ready. A new model reuses the slot of a removed one.
// Thread guarantee: one thread; only the destructor waits for the worker.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/live/device.h"
#include "engine/live/live_tick.h"
#include "engine/recording/recording.h"
#include "engine/tick/jnd.h"
#include "scenes/evaluation/evaluate.h"
#include "scenes/evaluation/model_errors.h"
#include "scenes/live/fault_log.h"
#include "scenes/scene/scene.h"
#include "scenes/worker/model_worker.h"

namespace palpate {

enum class SlotState : std::uint8_t {
  waiting,
  fitting,
  ready,
  failed,
  equal,   // it gives the same forces as another model, which is listed instead of it
  hidden,  // of a line-up that is not shown, or removed: neither evaluated nor listed
};

// Identity and state of a slot's model. Its errors are in Comparison.
struct ModelInfo {
  std::string name;                 // unique among the slots
  std::string method;               // family of its plan: "trend+greedy"
  std::vector<std::string> equals;  // plans of the same forces, this one's where cross-validation took no correction
  int centres = 0;                  // nodes for a grid; 0 until ready
  SlotState state = SlotState::waiting;
  double progress = 0.0;        // of the fit, 0..1
  std::string problem;          // when failed
  bool other_material = false;  // fitted to another material than the virtual one: it is not compared
  bool refitting = false;       // with another number of centres; the present model stays until then
  bool takes_centres = false;   // the number of centres can be changed
  bool paper = false;           // a method on the measured force, as in the paper (2009)
};

// A published set of models. Snapshots of a set may still arrive after the next set was published.
struct PublishedSet {
  std::uint32_t id = 0;
  std::map<std::size_t, std::size_t> models;  // slot to index in the set, without the models that were removed since

  // Index of the slot's model in the set; kMaxModels when it has none.
  std::size_t index_of(std::size_t slot) const noexcept {
    const auto model = models.find(slot);
    return model != models.end() ? model->second : kMaxModels;
  }
};

class SessionModels {
 public:
  // `scene` and `notices` outlive this. `seed` is that of the training recording and the fits. `training`,
  // `ready`: see ModelWorker.
  SessionModels(const Scene& scene, std::uint64_t seed, Notices& notices, std::vector<Recording> training = {},
                const std::string& ready = "");

  // Makes a slot for each request. Errors: a thread cannot be started.
  Status start(const std::vector<ModelRequest>& requests);
  // Interrupts fits; does not wait.
  void cancel() noexcept { worker_.cancel(); }
  // Call it once a frame. Returns the slots whose models became ready.
  std::vector<std::size_t> update();
  // Whether the models have changed since the last call: then publish a new set.
  bool read_changed() noexcept { return std::exchange(changed_, false); }

  // Makes a set of all ready models, which is then the newest set. `reference` may be null.
  std::unique_ptr<LiveModels> make_set(const SensorSpec& sensor, std::shared_ptr<ReferenceForce> reference);
  // The set that made `snapshot`; null: the loop had no set yet.
  const PublishedSet* set_of(const LoopSnapshot& snapshot) const noexcept;
  const PublishedSet* newest_set() const noexcept { return sets_.empty() ? nullptr : &sets_.back(); }
  // Writes the active model of the newest set into `controls`.
  void write_selection(LoopControls& controls) const;

  // The slots whose models are ready and listed, and these models.
  std::vector<std::size_t> ready_slots() const;
  std::vector<std::shared_ptr<const ForceModel>> ready_models() const;
  // Null until ready.
  const std::shared_ptr<const FittedModel>& model(std::size_t slot) const noexcept { return slots_[slot].model; }
  // The requests of all slots that are neither removed nor failed, each with its model where it is ready. A next
  // session that starts from them fits only the others.
  std::vector<ModelRequest> requests() const;

  std::size_t size() const noexcept { return slots_.size(); }
  const ModelInfo& info(std::size_t slot) const noexcept { return slots_[slot].info; }

  // The slot of the active model. The rendered force may still fade to it.
  std::size_t selected() const noexcept { return selected_; }
  bool select(std::size_t slot);  // returns false and changes nothing unless the model is ready
  // Selects the model unless the user has selected one.
  void propose(std::size_t slot);
  // The model that is the reference where no true force is known: the first of at least two ready ones. Empty: there is
  // none.
  std::optional<std::size_t> reference() const;
  // Number of models that are not fitted yet, and the estimated time until they are.
  std::size_t unfinished() const noexcept;
  double left_s() const { return worker_.left_s(); }
  // Whether any model is fitted in this session, not read from a file.
  bool fits() const noexcept;
  // Treats the model as one of this material, whatever its provenance.
  void treat_as_this_material(std::size_t slot) noexcept {
    slots_[slot].request.of_this_material = true;
    slots_[slot].info.other_material = false;
    changed_ = true;
  }

  // Shows the models of these requests, fits those that are missing and hides all others except models from files.
  // The active model stays active if it is shown; else the first model becomes active.
  void use_requests(const std::vector<ModelRequest>& requests);
  // Shows one more model by its name, fitted if there is none yet; a notice says why not.
  void add(const std::string& name);
  // Removes a model permanently and cancels its fit; not the last model that is ready, with a notice.
  void remove(std::size_t slot);
  // The slots whose models were removed or replaced since the last call. Discard all results of theirs.
  std::vector<std::size_t> read_freed() { return std::exchange(freed_, {}); }
  // Fits the model, again if it is ready, with this number of centres, before those that wait. Ignored unless
  // `takes_centres`.
  void refit(std::size_t slot, int centres);
  // Errors: the model is not ready; those of save_model.
  Status save(std::size_t slot, const std::string& path) const;
  // The depth up to which all shown models were trained, m; infinite without models.
  double trained_depth_m() const noexcept;
  // The longest relaxation time of all shown models, s, without those of creep; 0: none.
  double longest_memory_s() const noexcept;

  // Reads a model file into a new slot. Blocks for some milliseconds, some tens for a direct fit. Returns false,
  // with a notice, on failure.
  bool load_file(const std::string& path);
  // Whether no shown model is still to be fitted.
  bool all_settled() const noexcept { return unfinished() == 0; }

 private:
  struct Slot {
    ModelInfo info;
    ModelRequest request;
    std::size_t job = 0;                       // id of the worker's job
    int asked_centres = 0;                     // of the plan, before the user changed the number
    std::shared_ptr<const FittedModel> model;  // null until ready
    ProbedForces probed;                       // of the model
    bool removed = false;

    bool hidden() const { return info.state == SlotState::hidden; }
    bool takes_part() const { return model != nullptr && info.state == SlotState::ready; }
    void show() {
      info.state = model != nullptr ? SlotState::ready : info.problem.empty() ? SlotState::waiting : SlotState::failed;
    }
    bool is(const ModelRequest& other) const {  // `other` is not a file
      ModelPlan plan = request.plan;
      plan.centres = asked_centres;
      return !removed && !request.is_file() && plan == other.plan;
    }
  };

  std::size_t add_slot(const ModelRequest& request);
  std::optional<std::size_t> show(const ModelRequest& request);
  bool is_of_other_material(const Slot& slot) const;
  bool join(std::size_t index, const FinishedModel& finished);
  void unite_equal();
  std::optional<std::size_t> room() const noexcept;
  bool has_room(const std::string& what);
  std::optional<std::size_t> slot_of_job(std::size_t job) const noexcept;
  void free(std::size_t index);
  std::string distinct_name(const std::string& name, const Slot* but) const;

  const Scene& scene_;
  Notices& notices_;
  ModelWorker worker_;
  std::vector<Slot> slots_;
  std::vector<PublishedSet> sets_;  // newest last
  std::size_t selected_ = 0;
  bool user_chose_ = false, changed_ = false;
  std::size_t next_job_ = 0;
  std::vector<std::size_t> loaded_;  // slots of files since the last update
  std::vector<std::size_t> freed_;   // see read_freed
};

// Tests the ready models of a session behind the scenes: their errors over a whole recording that no model was fitted
// to, as `palpate replay` and the report compute them (scenes/evaluation/evaluate.h), and the time of their ticks. The
// result does not depend on what the user presses. The recording is the one that is replayed, a part of the training
// recording that was set apart, or that of the scene's material with another seed.
// The forces of the recording count from its own free air, as in `palpate fit`. Of a replayed recording, it also
// estimates one surface offset for all models together, which the user can apply.
// A separate thread tests each model when it becomes ready, and times all models together when all fits have ended, so
// that a slow phase of the machine affects all of them.
// Thread guarantee: one thread; only the destructor waits, some tenths of a second.
class ModelTest {
 public:
  using Models = std::vector<std::shared_ptr<const ForceModel>>;
  // Makes the recording, in the thread of the test. `progress`: see record_sensors.
  using MakeRecording = std::function<Result<Recording>(const std::function<bool(double)>& progress)>;

  // `replay` outlives this; null: nothing is replayed. Without a replay and without `make` models are only timed.
  ModelTest(ReplayControl* replay, MakeRecording make, const JndLine& jnd)
      : replay_(replay), make_(std::move(make)), jnd_(jnd) {}
  ~ModelTest() { cancelled_.store(true, std::memory_order_relaxed); }

  // Whether there is a recording to test on.
  bool has_recording() const noexcept { return replay_ != nullptr || make_ != nullptr; }
  // Call it once a frame. Returns whether there are new results.
  bool update(const SessionModels& models);
  // Whether the newest results are those of all ready models, timed together.
  bool complete() const noexcept { return complete_; }
  // The recording of the tests; null: there is none, or a test is running.
  const Recording* recording() const noexcept {
    if (running_.valid()) return nullptr;
    return replay_ != nullptr ? &replay_->recording() : made_ ? &*made_ : nullptr;
  }
  // The force of its free air, which is subtracted; 0: none, or not significant.
  double force_zero_N() const noexcept { return force_zero_N_; }
  // Number of tests with results.
  std::uint64_t results() const noexcept { return results_; }

  struct Errors : ErrorSummary {
    Interval p99_interval{kUnknown, kUnknown};
    Draws strokes;  // for the choice of the best model
  };
  struct Tested {
    std::shared_ptr<const ForceModel> model;
    Errors as_recorded, surface_moved;  // without samples if there is no recording
    Timing tick;                        // a whole tick with this model alone
  };
  const Tested* find(const ForceModel* model) const noexcept;
  // Its errors with the surface as it is now (`moved`). `tested`: of this object.
  const Errors& errors(const Tested& tested) const noexcept {
    return moved_ ? tested.surface_moved : tested.as_recorded;
  }

  // Whether to subtract the estimated offset from the positions of the replay. Returns whether that changes them.
  bool move(bool moved);
  bool moved() const noexcept { return moved_; }
  double found_m() const noexcept { return surface_.at; }  // estimated offset; 0: none yet, or not significant
  double offset_m() const noexcept { return moved_ ? found_m() : 0.0; }  // that is subtracted

 private:
  struct Outcome {
    std::vector<Tested> tested;  // of the new models
    Models timed;
    std::vector<Timing> ticks;  // of `timed`
    OffsetEstimate surface;
    double force_zero_N = 0.0;
  };
  Outcome run(const Models& untested, const Models& timed);
  void take(Outcome outcome);

  ReplayControl* replay_;
  MakeRecording make_;
  JndLine jnd_;
  bool moved_ = false, complete_ = false;
  std::uint64_t results_ = 0;
  Models ready_;  // of the last test
  std::vector<Tested> tested_;
  OffsetEstimate surface_;
  double force_zero_N_ = 0.0;
  // The thread of the test only.
  std::optional<double> air_N_;
  std::optional<Recording> made_;
  std::vector<TimedSamples> samples_;  // to time models on; none without a recording
  std::atomic<bool> cancelled_{false};
  std::future<Outcome> running_;
};

}  // namespace palpate
