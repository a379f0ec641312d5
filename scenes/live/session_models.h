// The models of a session and the sets of them that the haptics loop holds.
//
// Slots keep the numbers in which models were asked for. A slot's model is fitted or read by the
// worker, the quickest first, and joins the next set when it is ready, so that a session is alive at once.
// Thread guarantee: one thread; it never waits for the worker but in the destructor.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/live/live_tick.h"
#include "scenes/evaluation/model_timing.h"
#include "scenes/live/notices.h"
#include "scenes/scene/scene.h"

namespace palpate {

enum class SlotState : std::uint8_t {
  waiting,
  fitting,
  ready,
  failed,
  hidden,  // of a line-up that is not shown, or removed: not evaluated, not listed
};

// What a slot's model is and how far it has come; how well it does is Comparison's.
struct ModelInfo {
  std::string name;    // distinct among the slots
  std::string method;  // a method's name; "position" for depth alone
  int centres = 0;     // nodes for a grid; 0 until ready
  SlotState state = SlotState::waiting;
  double progress = 0.0;  // of the fit, 0..1
  std::string problem;    // when failed
  bool foreign = false;   // of another material than the one that is pressed: nothing to compare it with
  Timing tick;            // a whole one of this model alone
  double tick_ns() const noexcept { return tick.low_ns; }  // other programs only ever make it slower
  bool refitting = false;  // with another number of centres; the old one is there until then
  bool takes_centres = false;
  bool paper = false;  // by the recipe of 2009
};

class FittedModel;
class ModelWorker;
struct FinishedModel;
struct SlotPlan;

// Maps the models of a set in the loop to their slots: snapshots of it come after the next one was published.
struct PublishedSet {
  // In place of a slot whose model was removed.
  static constexpr std::size_t kRemoved = static_cast<std::size_t>(-1);
  std::uint32_t id = 0;
  std::vector<std::size_t> slots;

  // The slot's place in the set; nothing when it is not in it.
  std::optional<std::size_t> place_of(std::size_t slot) const noexcept;
};

class SessionModels {
 public:
  // `scene` and `notices` outlive this. `seed`: of the training recording and the fits.
  SessionModels(const Scene& scene, std::uint64_t seed, Notices& notices);
  SessionModels(const SessionModels&) = delete;
  SessionModels& operator=(const SessionModels&) = delete;
  // Interrupts fits.
  ~SessionModels();

  // A slot for each plan. `claimed`: files among them are of this material, whoever asked
  // for both says so. Errors: no thread.
  Status start(const std::vector<SlotPlan>& plans, bool claimed);
  // Interrupts fits; does not wait.
  void cancel() noexcept;
  // Once a frame. Returns the slots whose models became ready; when there are any, publish a new set.
  std::vector<std::size_t> update();

  // All ready models; `reference` may be null. The newest set is this one now.
  std::unique_ptr<LiveModels> make_set(const SensorSpec& sensor, std::shared_ptr<ReferenceForce> reference);
  // The set that made `snapshot`; null: none, or one of long ago.
  const PublishedSet* set_of(const LoopSnapshot& snapshot) const noexcept;
  const PublishedSet* newest_set() const noexcept { return sets_.empty() ? nullptr : &sets_.back(); }
  // Which model of the newest set is active.
  void write_selection(LoopControls& controls) const;

  // The slots whose models are there and shown.
  std::vector<std::size_t> ready_slots() const;
  const std::shared_ptr<const FittedModel>& model(std::size_t slot) const noexcept;  // null until ready
  // All plans that are not removed, each with its model where there is one: for another session that starts
  // from these models and fits none of them again.
  std::vector<SlotPlan> plans() const;

  std::size_t size() const noexcept;
  const ModelInfo& info(std::size_t slot) const noexcept;
  const std::vector<FeatureSpec>& features(std::size_t slot) const noexcept;

  // The slot of the active model, as asked for; the force fades to it.
  std::size_t selected() const noexcept { return selected_; }
  bool select(std::size_t slot);  // false, and ignored: not ready
  // What models are compared with where there is no truth: the first direct interpolant; of files alone
  // the first of several.
  std::optional<std::size_t> reference() const noexcept;
  // Whether any is fitted here, to the material itself.
  bool fits() const noexcept;
  // It is a model of what is pressed, whatever its file says.
  void claim(std::size_t slot) noexcept;

  // Shows the models of these plans and hides all others but those of files; what is not there yet is
  // fitted. What is active stays so if it is shown, else the first is.
  void use_plans(const std::vector<SlotPlan>& plans);
  // Takes a model out for good; false, with a notice: it is the last one.
  bool remove(std::size_t slot);
  // The slots whose models are gone since the last call: what is known of them is of no model any more.
  std::vector<std::size_t> read_freed();
  // A name that another one has gets a number.
  void rename(std::size_t slot, const std::string& name);
  // Fits a model anew with so many centres, in the background; ignored for one that takes none.
  void refit(std::size_t slot, int centres);
  // Errors: not ready, as save_model.
  Status save(std::size_t slot, const std::string& path) const;
  // Greatest depth that all shown models were trained with, metres; infinite without any.
  double trained_depth_m() const noexcept;
  // The longest memory of all shown models, s: filters that began that long ago have forgotten how.
  double longest_memory_s() const noexcept;

  // Reads a model file into a new slot at once, in some milliseconds, tens of them for a direct fit; false, and
  // a notice: it cannot.
  bool load_file(const std::string& path);
  // Whether nothing that is shown is still to come.
  bool all_settled() const noexcept;

 private:
  struct Slot;

  void show_progress();
  Slot& add_slot(const SlotPlan& plan);
  bool is_foreign(const Slot& slot) const;
  bool join(std::size_t index, FinishedModel& finished);
  bool has_room(const std::string& what);
  void select_what_is_there();
  std::optional<std::size_t> slot_of_job(std::size_t job) const noexcept;
  void free(std::size_t index);
  std::string distinct_name(const std::string& name, const Slot* but) const;

  const Scene& scene_;
  Notices& notices_;
  std::unique_ptr<ModelWorker> worker_;
  std::vector<std::unique_ptr<Slot>> slots_;
  std::vector<PublishedSet> sets_;  // newest last
  std::optional<std::size_t> direct_;
  std::size_t selected_ = 0;
  bool user_chose_ = false;
  std::size_t next_job_ = 0;
  std::vector<std::size_t> loaded_;  // since the last update, files
  std::vector<std::size_t> freed_;   // see read_freed
};

}  // namespace palpate
