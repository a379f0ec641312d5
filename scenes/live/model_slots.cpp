#include "scenes/live/model_slots.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "models/model/file/model_io.h"
#include "models/model/fitted_model.h"
#include "scenes/worker/model_worker.h"
#include "scenes/worker/slot_plan.h"

namespace palpate {
namespace {

std::string recordings_of(const FittedModel& model) {
  std::string names;
  for (const std::string& name : model.data().provenance.recordings) names += (names.empty() ? "" : ", ") + name;
  return names;
}

}  // namespace

struct ModelSlots::Slot {
  SlotView view;
  SlotPlan plan;
  int asked_centres = 0;                     // of the plan, before it was changed by hand
  std::shared_ptr<const FittedModel> model;  // null until ready
  bool removed = false;
  bool claimed = false;  // of a file: somebody said that it is of this material

  bool hidden() const { return view.state == SlotState::hidden; }
  bool takes_part() const { return model != nullptr && !hidden(); }
  void show() {
    view.state = model != nullptr ? SlotState::ready : view.problem.empty() ? SlotState::waiting : SlotState::failed;
  }
  bool is(const SlotPlan& other) const {  // which is no file
    return !removed && plan.origin == other.origin && plan.method == other.method && plan.paper == other.paper &&
           asked_centres == other.centres;
  }
};

std::optional<std::size_t> PublishedSet::place_of(std::size_t slot) const noexcept {
  const auto place = std::find(slots.begin(), slots.end(), slot);
  if (place == slots.end()) return std::nullopt;
  return static_cast<std::size_t>(place - slots.begin());
}

ModelSlots::ModelSlots(const Scene& scene, std::uint64_t seed, Notices& notices)
    : scene_(scene), notices_(notices), worker_(std::make_unique<ModelWorker>(scene_, seed)) {}

ModelSlots::~ModelSlots() = default;

Status ModelSlots::start(const std::vector<SlotPlan>& plans, bool claimed) {
  for (const SlotPlan& plan : plans) {
    add_slot(plan).claimed = claimed;
    worker_->add_job(slots_.size() - 1, plan, slots_.size() == 1);
  }
  return worker_->start();
}

ModelSlots::Slot& ModelSlots::add_slot(const SlotPlan& plan) {
  slots_.push_back(std::make_unique<Slot>());
  Slot& slot = *slots_.back();
  slot.view.name = distinct_name(plan_name(plan), &slot);
  slot.view.method = plan_method(plan);
  slot.view.takes_centres = plan.origin == ModelOrigin::method && plan.method->can_take(kTakesCentres);
  slot.view.paper = plan.paper;
  slot.plan = plan;
  slot.asked_centres = plan.centres;
  return slot;
}

void ModelSlots::cancel() noexcept { worker_->cancel(); }

std::vector<std::size_t> ModelSlots::update() {
  show_progress();
  std::vector<std::size_t> ready = std::exchange(loaded_, {});
  for (FinishedModel& finished : worker_->read_finished()) {
    Slot& slot = *slots_[finished.job_id];
    // Asked for again while it was made: the newer one counts.
    const bool old = slot.view.refitting && finished.plan.centres != slot.plan.centres;
    if (join(finished.job_id, finished)) ready.push_back(finished.job_id);
    slot.view.refitting = old;
  }
  return ready;
}

void ModelSlots::show_progress() {
  const ModelWorker::Progress progress = worker_->progress();
  if (!progress.working || progress.job_id >= slots_.size()) return;
  SlotView& view = slots_[progress.job_id]->view;
  if (view.state == SlotState::waiting) view.state = SlotState::fitting;
  if (view.state == SlotState::fitting) view.progress = progress.share;
}

// A truth is one of a material: a model of something else is not wrong where it differs.
// A recording was named together with the models that are held against it.
bool ModelSlots::is_foreign(const Slot& slot) const {
  if (!scene_.material || slot.claimed || slot.plan.origin != ModelOrigin::file) return false;
  const std::vector<std::string>& recordings = slot.model->data().provenance.recordings;
  return std::any_of(recordings.begin(), recordings.end(), [&](const std::string& name) {
    const std::string start = *scene_.material + "_";  // as the rig names its own
    return name.rfind(start, 0) != 0 || name.find_first_not_of("0123456789", start.size()) != std::string::npos;
  });
}

Status ModelSlots::save(std::size_t slot, const std::string& path) const {
  if (slot >= slots_.size() || slots_[slot]->model == nullptr) return Error{"there is no model to save yet"};
  return save_model(path, slots_[slot]->model->data(), false);
}

bool ModelSlots::fits() const noexcept {
  return std::any_of(slots_.begin(), slots_.end(),
                     [](const auto& slot) { return slot->plan.origin != ModelOrigin::file; });
}

std::optional<std::size_t> ModelSlots::reference() const noexcept {
  if (direct_) return direct_;
  if (fits()) return std::nullopt;
  const auto shown = shown_slots();
  return shown.size() > 1 ? std::optional<std::size_t>(shown.front()) : std::nullopt;
}

bool ModelSlots::all_settled() const noexcept {
  return std::none_of(slots_.begin(), slots_.end(), [](const auto& slot) {
    const SlotState state = slot->view.state;
    return slot->view.refitting || state == SlotState::waiting || state == SlotState::fitting;
  });
}

std::vector<std::size_t> ModelSlots::shown_slots() const {
  std::vector<std::size_t> shown;
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    if (slots_[i]->takes_part()) shown.push_back(i);
  }
  return shown;
}

bool ModelSlots::join(std::size_t index, FinishedModel& finished) {
  Slot& slot = *slots_[index];
  if (finished.model == nullptr) {
    notices_.push_back({slot.view.name + ": " + finished.problem, true});
    slot.view.problem = finished.problem;
    if (!slot.hidden()) slot.show();  // an old one stays
    return false;
  }
  const bool first = shown_slots().empty();
  slot.model = finished.model;
  if (!slot.hidden()) slot.show();
  slot.view.progress = 1.0;
  slot.view.centres = slot.model->centre_count();
  slot.view.tick_ns = finished.tick_ns;
  slot.view.foreign = is_foreign(slot);
  if (slot.plan.origin != ModelOrigin::position) {
    slot.view.method = slot.model->method();
    std::string name = slot.model->name();
    if (slot.plan.paper) name += kPaperMark;
    slot.view.name = distinct_name(name, &slot);
  }
  if (!direct_ && slot.view.method == "direct" && !slot.plan.paper) direct_ = index;
  if (!slot.hidden() && (first || (index == 0 && !user_chose_))) selected_ = index;
  return true;
}

void ModelSlots::use_plans(const std::vector<SlotPlan>& plans) {
  for (const auto& slot : slots_) {
    if (slot->plan.origin != ModelOrigin::file) slot->view.state = SlotState::hidden;
  }
  std::optional<std::size_t> first;
  for (const SlotPlan& plan : plans) {
    const auto same = std::find_if(slots_.begin(), slots_.end(), [&](const auto& slot) { return slot->is(plan); });
    auto index = static_cast<std::size_t>(same - slots_.begin());
    if (same == slots_.end()) {
      if (!has_room("show " + plan_name(plan))) continue;
      add_slot(plan);
      index = slots_.size() - 1;
      worker_->add_job(index, plan, !first);
    }
    slots_[index]->show();
    if (!first) first = index;
  }
  if (slots_[selected_]->hidden() && first) selected_ = *first;
  select_what_is_there();
}

// The active model must be one that takes part, as soon as there is one.
void ModelSlots::select_what_is_there() {
  const auto shown = shown_slots();
  if (!shown.empty() && !slots_[selected_]->takes_part()) selected_ = shown.front();
}

void ModelSlots::remove(std::size_t index) {
  if (index >= slots_.size()) return;
  Slot& slot = *slots_[index];
  if (shown_slots().size() == (slot.takes_part() ? 1 : 0)) {
    notices_.push_back({"the last model stays: there must be one to press", false});
    return;
  }
  slot.removed = true;
  slot.view.state = SlotState::hidden;
  select_what_is_there();
}

void ModelSlots::rename(std::size_t slot, const std::string& name) {
  if (slot < slots_.size() && !name.empty()) slots_[slot]->view.name = distinct_name(name, slots_[slot].get());
}

void ModelSlots::refit(std::size_t index, int centres) {
  if (index >= slots_.size() || !slots_[index]->view.takes_centres || centres < 1) return;
  Slot& slot = *slots_[index];
  if (slot.model == nullptr || slot.plan.centres == centres) return;
  slot.plan.centres = centres;
  slot.view.refitting = true;
  worker_->add_job(index, slot.plan);
}

double ModelSlots::trained_depth_m() const noexcept {
  double depth_m = std::numeric_limits<double>::infinity();
  for (const std::size_t slot : shown_slots()) {
    const ModelData& data = slots_[slot]->model->data();
    for (std::size_t i = 0; i < data.features.size(); ++i) {
      if (data.features[i].kind == FeatureKind::depth)
        depth_m = std::min(depth_m, data.upper[static_cast<Eigen::Index>(i)]);
    }
  }
  return depth_m;
}

bool ModelSlots::has_room(const std::string& what) {
  if (slots_.size() < kMaxModels) return true;
  notices_.push_back(
      {"cannot " + what + ": there are " + std::to_string(kMaxModels) + " models already; start again with fewer",
       true});
  return false;
}

std::unique_ptr<LiveModels> ModelSlots::make_set(const SensorSpec& sensor, std::shared_ptr<ReferenceForce> reference) {
  PublishedSet set;
  set.id = sets_.empty() ? 1 : sets_.back().id + 1;
  std::vector<std::shared_ptr<const ForceModel>> models;
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    // The reference stays, also where it is not shown.
    if (!slots_[i]->takes_part() && !(direct_ == i && slots_[i]->model != nullptr)) continue;
    models.push_back(slots_[i]->model);
    set.slots.push_back(i);
  }
  auto next = std::make_unique<LiveModels>(set.id, sensor, std::move(models), std::move(reference));
  next->selected = static_cast<std::uint32_t>(set.place_of(selected_).value_or(0));
  if (const auto model = this->reference(); model && set.place_of(*model)) {
    next->written_model = static_cast<std::uint32_t>(*set.place_of(*model));
  }
  sets_.push_back(std::move(set));
  return next;
}

const PublishedSet* ModelSlots::set_of(const LoopSnapshot& snapshot) const noexcept {
  const auto set =
      std::find_if(sets_.rbegin(), sets_.rend(), [&](const PublishedSet& one) { return one.id == snapshot.models_id; });
  return set != sets_.rend() ? &*set : nullptr;
}

void ModelSlots::write_selection(LoopControls& controls) const {
  if (sets_.empty()) return;
  controls.models_id = sets_.back().id;
  controls.selected = static_cast<std::uint32_t>(sets_.back().place_of(selected_).value_or(sets_.back().slots.size()));
}

std::vector<std::shared_ptr<const ForceModel>> ModelSlots::ready_models() const {
  std::vector<std::shared_ptr<const ForceModel>> models;
  for (const std::size_t slot : shown_slots()) models.push_back(slots_[slot]->model);
  return models;
}

std::size_t ModelSlots::size() const noexcept { return slots_.size(); }
const SlotView& ModelSlots::view(std::size_t slot) const noexcept { return slots_[slot]->view; }
SlotView& ModelSlots::view(std::size_t slot) noexcept { return slots_[slot]->view; }
const std::vector<FeatureSpec>& ModelSlots::features(std::size_t slot) const noexcept {
  return slots_[slot]->model->features();
}

bool ModelSlots::select(std::size_t slot) {
  if (slot >= slots_.size() || !slots_[slot]->takes_part()) return false;
  selected_ = slot;
  user_chose_ = true;
  return true;
}

void ModelSlots::load_file(const std::string& path) {
  if (!has_room("load " + path)) return;
  auto model = load_model(path);
  if (!model) {
    notices_.push_back({model.error().message, true});
    return;
  }
  SlotPlan plan;
  plan.origin = ModelOrigin::file;
  plan.path = path;
  const Slot& slot = add_slot(plan);
  loaded_.push_back(slots_.size() - 1);
  FinishedModel finished = finished_model(loaded_.back(), plan, std::move(*model));
  join(loaded_.back(), finished);
  notices_.push_back(
      {"loaded " + slot.view.name + " from " + path +
           (slot.view.foreign ? ": of " + recordings_of(*slot.model) + ", no truth to compare it with" : ""),
       false});
}

std::string ModelSlots::distinct_name(const std::string& name, const Slot* but) const {
  const auto taken = [&](const std::string& candidate) {
    return std::any_of(slots_.begin(), slots_.end(),
                       [&](const auto& slot) { return slot.get() != but && slot->view.name == candidate; });
  };
  std::string candidate = name;
  for (int i = 2; taken(candidate); ++i) candidate = name + "-" + std::to_string(i);
  return candidate;
}

}  // namespace palpate
