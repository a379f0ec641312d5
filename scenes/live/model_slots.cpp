#include "scenes/live/model_slots.h"

#include <algorithm>
#include <utility>

#include "models/model/fitted_model.h"
#include "scenes/worker/model_worker.h"
#include "scenes/worker/slot_plan.h"

namespace palpate {
namespace {

// The job of a file that has no slot yet.
constexpr std::size_t kNoSlot = static_cast<std::size_t>(-1);

}  // namespace

struct ModelSlots::Slot {
  SlotView view;
  SlotPlan plan;
  std::shared_ptr<const FittedModel> model;  // null until ready
};

std::optional<std::size_t> PublishedSet::place_of(std::size_t slot) const noexcept {
  const auto place = std::find(slots.begin(), slots.end(), slot);
  if (place == slots.end()) return std::nullopt;
  return static_cast<std::size_t>(place - slots.begin());
}

ModelSlots::ModelSlots(const Scene& scene, std::uint64_t seed, Notices& notices)
    : scene_(scene), notices_(notices), worker_(std::make_unique<ModelWorker>(scene_, seed)) {}

ModelSlots::~ModelSlots() = default;

Status ModelSlots::start(const std::vector<SlotPlan>& plans) {
  for (const SlotPlan& plan : plans) {
    auto slot = std::make_unique<Slot>();
    slot->view.name = distinct_name(plan_name(plan), nullptr);
    slot->view.method = plan_method(plan);
    slot->plan = plan;
    slots_.push_back(std::move(slot));
    worker_->add_job(slots_.size() - 1, plan);
  }
  outstanding_ = slots_.size();
  return worker_->start();
}

void ModelSlots::cancel() noexcept { worker_->cancel(); }

std::vector<std::size_t> ModelSlots::update() {
  show_progress();
  std::vector<std::size_t> ready;
  for (FinishedModel& finished : worker_->take_finished()) {
    --outstanding_;
    const bool file = finished.job_id == kNoSlot;
    const bool joined = file ? add_file(finished) : join(finished.job_id, finished);
    if (joined) ready.push_back(file ? slots_.size() - 1 : finished.job_id);
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

bool ModelSlots::add_file(FinishedModel& finished) {
  --outstanding_files_;
  if (finished.model == nullptr) {
    notices_.add(finished.problem, true);
    return false;
  }
  slots_.push_back(std::make_unique<Slot>());
  slots_.back()->plan = finished.plan;
  join(slots_.size() - 1, finished);
  notices_.add("loaded " + slots_.back()->view.name + " from " + finished.plan.path, false);
  return true;
}

bool ModelSlots::join(std::size_t index, FinishedModel& finished) {
  Slot& slot = *slots_[index];
  if (finished.model == nullptr) {
    slot.view.state = SlotState::failed;
    slot.view.problem = finished.problem;
    notices_.add(slot.view.name + ": " + finished.problem, true);
    return false;
  }
  const bool first = std::none_of(slots_.begin(), slots_.end(),
                                  [](const auto& other) { return other->view.state == SlotState::ready; });
  slot.model = finished.model;
  slot.view.state = SlotState::ready;
  slot.view.progress = 1.0;
  slot.view.centres = slot.model->centre_count();
  if (slot.plan.origin != ModelOrigin::position) {
    slot.view.method = slot.model->method();
    slot.view.name = distinct_name(slot.model->name(), &slot);
  }
  if (!direct_ && slot.view.method == "direct") direct_ = index;
  if (first || (index == 0 && !user_chose_)) selected_ = index;
  return true;
}

std::unique_ptr<LiveModels> ModelSlots::make_set(const SensorSpec& sensor,
                                                 std::shared_ptr<ReferenceForce> reference) {
  PublishedSet set;
  set.id = sets_.empty() ? 1 : sets_.back().id + 1;
  std::vector<std::shared_ptr<const ForceModel>> models;
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    if (slots_[i]->view.state != SlotState::ready) continue;
    models.push_back(slots_[i]->model);
    set.slots.push_back(i);
  }
  auto next = std::make_unique<LiveModels>(set.id, sensor, std::move(models), std::move(reference));
  next->selected = static_cast<std::uint32_t>(set.place_of(selected_).value_or(0));
  if (const auto place = direct_ ? set.place_of(*direct_) : std::nullopt) {
    next->written_model = static_cast<std::uint32_t>(*place);
  }
  sets_.push_back(std::move(set));
  return next;
}

const PublishedSet* ModelSlots::set_of(const LoopSnapshot& snapshot) const noexcept {
  const auto set = std::find_if(sets_.rbegin(), sets_.rend(),
                                [&](const PublishedSet& one) { return one.id == snapshot.models_id; });
  return set != sets_.rend() ? &*set : nullptr;
}

void ModelSlots::write_selection(LoopControls& controls) const {
  if (sets_.empty()) return;
  controls.models_id = sets_.back().id;
  controls.selected =
      static_cast<std::uint32_t>(sets_.back().place_of(selected_).value_or(sets_.back().slots.size()));
}

std::vector<std::shared_ptr<const ForceModel>> ModelSlots::ready_models() const {
  std::vector<std::shared_ptr<const ForceModel>> models;
  for (const auto& slot : slots_) {
    if (slot->view.state == SlotState::ready) models.push_back(slot->model);
  }
  return models;
}

std::size_t ModelSlots::size() const noexcept { return slots_.size(); }
const SlotView& ModelSlots::view(std::size_t slot) const noexcept { return slots_[slot]->view; }
SlotView& ModelSlots::view(std::size_t slot) noexcept { return slots_[slot]->view; }
const std::vector<FeatureSpec>& ModelSlots::features(std::size_t slot) const noexcept {
  return slots_[slot]->model->features();
}

bool ModelSlots::select(std::size_t slot) {
  if (slot >= slots_.size() || slots_[slot]->view.state != SlotState::ready) return false;
  selected_ = slot;
  user_chose_ = true;
  return true;
}

void ModelSlots::load_file(const std::string& path) {
  if (slots_.size() + outstanding_files_ >= kMaxModels) {
    notices_.add("cannot load " + path + ": there are " + std::to_string(kMaxModels) +
                     " models already; start again with fewer",
                 true);
    return;
  }
  ++outstanding_;
  ++outstanding_files_;
  SlotPlan plan;
  plan.origin = ModelOrigin::file;
  plan.path = path;
  worker_->add_job(kNoSlot, plan);
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
