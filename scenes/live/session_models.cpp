#include "scenes/live/session_models.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <system_error>

#include "engine/base/text.h"
#include "models/model/file/model_io.h"
#include "models/model/fitted_model.h"
#include "models/samples/samples.h"
#include "models/trend/trend_estimator.h"

namespace palpate {
namespace {

// The loop has one set, another waits for it, and snapshots of earlier ones may still be unread.
constexpr std::size_t kKeptSets = 16;

}  // namespace

SessionModels::SessionModels(const Scene& scene, std::uint64_t seed, Notices& notices, std::vector<Recording> training,
                             const std::string& ready)
    : scene_(scene), notices_(notices), worker_(scene_, seed, std::move(training), ready) {}

Status SessionModels::start(const std::vector<ModelRequest>& requests) {
  for (const ModelRequest& request : requests) worker_.add_job(slots_[add_slot(request)].job, request);
  return worker_.start();
}

// The slot for a new model: that of a removed model, else a new one, else that of a hidden model; empty: there is none.
std::optional<std::size_t> SessionModels::room() const noexcept {
  for (const bool removed : {true, false}) {
    for (std::size_t i = 0; i < slots_.size(); ++i)
      if (removed ? slots_[i].removed : slots_[i].hidden()) return i;
    if (slots_.size() < kMaxModels) return slots_.size();
  }
  return std::nullopt;
}

std::size_t SessionModels::add_slot(const ModelRequest& request) {
  const std::size_t index = *room();
  if (index == slots_.size()) {
    slots_.emplace_back();
  } else if (!slots_[index].removed) {
    free(index);
  }
  Slot& slot = slots_[index] = Slot{};
  slot.job = next_job_++;
  slot.info.name = distinct_name(request_name(request), &slot);
  if (!request.is_file()) slot.info.method = family_name(request.plan);
  slot.info.takes_centres = !request.is_file() && request.plan.selects_centres() && scene_.has_material();
  slot.info.paper = !request.is_file() && request.plan.base == Base::force;
  slot.request = request;
  slot.asked_centres = request.plan.centres;
  return index;
}

std::vector<std::size_t> SessionModels::update() {
  const auto progress = worker_.progress();
  if (const auto index = progress ? slot_of_job(progress->job_id) : std::nullopt) {
    ModelInfo& info = slots_[*index].info;
    if (info.state == SlotState::waiting) info.state = SlotState::fitting;
    if (info.state == SlotState::fitting) info.progress = progress->share;
  }
  std::vector<std::size_t> ready = std::exchange(loaded_, {});
  for (const FinishedModel& finished : worker_.read_finished()) {
    const std::optional<std::size_t> index = slot_of_job(finished.job_id);
    if (!index) continue;  // the model was removed meanwhile
    Slot& slot = slots_[*index];
    // The user has asked for another number of centres meanwhile: another fit follows.
    const bool old = slot.info.refitting && finished.centres != slot.request.plan.centres;
    if (join(*index, finished)) ready.push_back(*index);
    slot.info.refitting = old;
  }
  if (!ready.empty()) unite_equal();
  return ready;
}

// Of several models with the same forces one is listed: the simplest, else the first.
void SessionModels::unite_equal() {
  changed_ = true;
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    Slot& slot = slots_[i];
    slot.info.equals.clear();
    if (slot.info.state == SlotState::equal) slot.info.state = SlotState::ready;
    if (slot.takes_part()) order.push_back(i);
  }
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return slots_[i].model->centre_count(); });
  for (std::size_t k = 0; k < order.size(); ++k) {
    Slot& slot = slots_[order[k]];
    const auto same = std::ranges::find_if(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(k),
                                           [&](std::size_t i) { return slots_[i].probed == slot.probed; });
    Slot& listed = slots_[*same];
    if (*same != order[k]) slot.info.state = SlotState::equal;
    const std::string asked = request_name(slot.request);
    if (!slot.request.is_file() && asked != listed.model->name()) listed.info.equals.push_back(asked);
  }
  for (Slot& slot : slots_)
    if (slot.takes_part()) slot.info.name = distinct_name(slot.model->name(), &slot);
  const auto shown = ready_slots();
  if (!shown.empty() && !slots_[selected_].takes_part()) selected_ = shown.front();
}

std::optional<std::size_t> SessionModels::slot_of_job(std::size_t job) const noexcept {
  for (std::size_t i = 0; i < slots_.size(); ++i)
    if (slots_[i].job == job && !slots_[i].removed) return i;
  return std::nullopt;
}

// A model file of another material is not compared with the true force of this one. If the user named recordings, there
// is no true force, and no model counts as one of another material.
bool SessionModels::is_of_other_material(const Slot& slot) const {
  if (!scene_.material || slot.request.of_this_material || !slot.request.is_file()) return false;
  const std::vector<std::string>& recordings = slot.model->data().provenance.recordings;
  return std::ranges::any_of(recordings, [&](const std::string& name) {
    const std::string start = *scene_.material + "_";  // the rig names its recordings MATERIAL_SEED
    return name.rfind(start, 0) != 0 || name.find_first_not_of("0123456789", start.size()) != std::string::npos;
  });
}

Status SessionModels::save(std::size_t slot, const std::string& path) const {
  if (slot >= slots_.size() || slots_[slot].model == nullptr) return Error{"there is no model to save yet"};
  return save_model(path, slots_[slot].model->data(), false);
}

bool SessionModels::fits() const noexcept {
  return std::ranges::any_of(slots_, [](const Slot& slot) { return !slot.request.is_file(); });
}

std::optional<std::size_t> SessionModels::reference() const {
  const auto shown = ready_slots();
  return shown.size() > 1 ? std::optional<std::size_t>(shown.front()) : std::nullopt;
}

std::size_t SessionModels::unfinished() const noexcept {
  return static_cast<std::size_t>(std::ranges::count_if(slots_, [](const Slot& slot) {
    const SlotState state = slot.info.state;
    return (slot.info.refitting && state == SlotState::ready) || state == SlotState::waiting ||
           state == SlotState::fitting;
  }));
}

std::vector<std::size_t> SessionModels::ready_slots() const {
  std::vector<std::size_t> shown;
  for (std::size_t i = 0; i < slots_.size(); ++i)
    if (slots_[i].takes_part()) shown.push_back(i);
  return shown;
}

std::vector<std::shared_ptr<const ForceModel>> SessionModels::ready_models() const {
  std::vector<std::shared_ptr<const ForceModel>> models;
  for (const std::size_t slot : ready_slots()) models.push_back(slots_[slot].model);
  return models;
}

bool SessionModels::join(std::size_t index, const FinishedModel& finished) {
  Slot& slot = slots_[index];
  if (!finished.model) {
    slot.info.problem = finished.model.error().message;
    notices_.push_back({slot.info.name + ": " + slot.info.problem, true});
    if (!slot.hidden()) slot.show();  // an earlier model stays in use
    return false;
  }
  const bool first = ready_slots().empty();
  slot.model = *finished.model;
  if (!slot.hidden()) slot.show();
  slot.info.progress = 1.0;
  slot.info.centres = slot.model->centre_count();
  if (slot.info.centres == 0) slot.info.takes_centres = false;  // no correction was taken
  slot.probed = probed_forces(slot.model);
  slot.info.other_material = is_of_other_material(slot);
  slot.info.method = slot.model->method();
  const auto plan = parse_plan(slot.info.method);
  slot.info.paper = plan && plan->base == Base::force;
  if (!slot.hidden() && first) selected_ = index;
  return true;
}

void SessionModels::use_requests(const std::vector<ModelRequest>& requests) {
  for (Slot& slot : slots_)
    if (!slot.request.is_file()) slot.info.state = SlotState::hidden;
  std::optional<std::size_t> first;
  for (const ModelRequest& request : requests) {
    const auto index = show(request);
    if (!first) first = index;
  }
  if (slots_[selected_].hidden() && first) selected_ = *first;
  unite_equal();
}

// Shows the model of this request, which is fitted if there is none yet. Empty, with a notice: there is no room.
std::optional<std::size_t> SessionModels::show(const ModelRequest& request) {
  const auto same = std::ranges::find_if(slots_, [&](const Slot& slot) { return slot.is(request); });
  auto index = static_cast<std::size_t>(same - slots_.begin());
  if (same == slots_.end()) {
    if (!has_room("show " + request_name(request))) return std::nullopt;
    index = add_slot(request);
    worker_.add_job(slots_[index].job, request);
  }
  slots_[index].show();
  return index;
}

void SessionModels::add(const std::string& name) {
  const auto requests = requested_models(scene_, {name});
  if (!requests) return notices_.push_back({requests.error().message, true});
  if (show(requests->front())) unite_equal();
}

void SessionModels::remove(std::size_t index) {
  if (index >= slots_.size() || slots_[index].removed) return;
  Slot& slot = slots_[index];
  if (slot.takes_part() && ready_slots().size() == 1)
    return notices_.push_back({"the last model cannot be removed", false});
  slot.removed = true;
  slot.info.state = SlotState::hidden;
  worker_.cancel_job(slot.job);
  free(index);
  unite_equal();
}

// Removes the slot from all published sets, so that another model may use it.
void SessionModels::free(std::size_t index) {
  freed_.push_back(index);
  for (PublishedSet& set : sets_) set.models.erase(index);
}

void SessionModels::refit(std::size_t index, int centres) {
  if (index >= slots_.size() || !slots_[index].info.takes_centres || centres < 1) return;
  Slot& slot = slots_[index];
  if (slot.request.plan.centres == centres) return;
  slot.request.plan.centres = centres;
  if (slot.model == nullptr) slot.info.name = distinct_name(request_name(slot.request), &slot);
  slot.request.loaded = nullptr;
  slot.info.refitting = true;
  worker_.add_job(slot.job, slot.request, true);
}

double SessionModels::trained_depth_m() const noexcept {
  double depth_m = std::numeric_limits<double>::infinity();
  for (const std::size_t slot : ready_slots()) {
    const ModelData& data = slots_[slot].model->data();
    for (std::size_t i = 0; i < data.features.size(); ++i)
      if (data.features[i].kind == FeatureKind::depth)
        depth_m = std::min(depth_m, data.upper[static_cast<Eigen::Index>(i)]);
  }
  return depth_m;
}

double SessionModels::longest_memory_s() const noexcept {
  double memory_s = 0.0;
  for (const std::size_t slot : ready_slots())
    for (const double time_s : relaxation_times_s(slots_[slot].model->features()))
      memory_s = std::max(memory_s, time_s);
  return memory_s;
}

bool SessionModels::has_room(const std::string& what) {
  if (room()) return true;
  notices_.push_back(
      {"cannot " + what + ": there are " + std::to_string(kMaxModels) + " models already; take one out (x on its row)",
       true});
  return false;
}

std::unique_ptr<LiveModels> SessionModels::make_set(const SensorSpec& sensor,
                                                    std::shared_ptr<ReferenceForce> reference) {
  PublishedSet set;
  set.id = sets_.empty() ? 1 : sets_.back().id + 1;
  for (const std::size_t slot : ready_slots()) set.models.emplace(slot, set.models.size());
  auto next = std::make_unique<LiveModels>(set.id, sensor, ready_models(), std::move(reference));
  next->selected = static_cast<std::uint32_t>(set.models.contains(selected_) ? set.index_of(selected_) : 0);
  if (const auto model = this->reference(); model && set.models.contains(*model))
    next->written_model = static_cast<std::uint32_t>(set.index_of(*model));
  sets_.push_back(std::move(set));
  if (sets_.size() > kKeptSets) sets_.erase(sets_.begin());
  return next;
}

const PublishedSet* SessionModels::set_of(const LoopSnapshot& snapshot) const noexcept {
  const auto set =
      std::find_if(sets_.rbegin(), sets_.rend(), [&](const PublishedSet& one) { return one.id == snapshot.models_id; });
  return set != sets_.rend() ? &*set : nullptr;
}

void SessionModels::write_selection(LoopControls& controls) const {
  if (sets_.empty()) return;
  controls.models_id = sets_.back().id;
  controls.selected = static_cast<std::uint32_t>(sets_.back().index_of(selected_));
}

std::vector<ModelRequest> SessionModels::requests() const {
  std::vector<ModelRequest> requests;
  for (const auto& slot : slots_) {
    if (slot.removed || slot.info.state == SlotState::failed) continue;
    requests.push_back(slot.request);
    if (!slot.info.refitting) requests.back().loaded = slot.model;
  }
  return requests;
}

bool SessionModels::select(std::size_t slot) {
  if (slot >= slots_.size() || !slots_[slot].takes_part()) return false;
  selected_ = slot;
  user_chose_ = true;
  return true;
}

void SessionModels::propose(std::size_t slot) {
  if (!user_chose_ && slot < slots_.size() && slots_[slot].takes_part()) selected_ = slot;
}

bool SessionModels::load_file(const std::string& path) {
  if (!has_room("load " + path)) return false;
  auto model = load_model(path);
  if (!model) {
    notices_.push_back({model.error().message, true});
    return false;
  }
  const ModelRequest request{.plan = {}, .path = path, .loaded = std::move(*model)};
  const std::size_t index = add_slot(request);
  const Slot& slot = slots_[index];
  loaded_.push_back(index);
  join(index, {slot.job, 0, request.loaded});
  unite_equal();
  notices_.push_back({"loaded " + slot.info.name + " from " + path +
                          (slot.info.state == SlotState::equal ? ", whose forces are those of a model that is there"
                           : slot.info.other_material ? ": of " + joined(slot.model->data().provenance.recordings) +
                                                            ", without a reference force here"
                                                      : ""),
                      false});
  return true;
}

std::string SessionModels::distinct_name(const std::string& name, const Slot* but) const {
  std::string candidate = name;
  const auto is_taken = [&](const Slot& slot) {
    return &slot != but && slot.info.state != SlotState::equal && slot.info.name == candidate;
  };
  for (int i = 2; std::ranges::any_of(slots_, is_taken); ++i) candidate = name + "-" + std::to_string(i);
  return candidate;
}

bool ModelTest::update(const SessionModels& models) {
  if (running_.valid()) {
    if (running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
    take(running_.get());
    ++results_;
    complete_ = models.all_settled() && ready_ == models.ready_models();
    return true;
  }
  const Models ready = models.ready_models();
  const bool settled = models.all_settled();
  if (ready.empty() || (ready == ready_ && (complete_ || !settled))) return false;
  Models untested;
  std::ranges::copy_if(ready, std::back_inserter(untested),
                       [&](const auto& one) { return find(one.get()) == nullptr; });
  complete_ = false;
  ready_ = ready;
  try {
    running_ = std::async(std::launch::async, [this, untested, timed = settled ? ready : untested] {
      lower_thread_priority();
      return run(untested, timed);
    });
  } catch (const std::system_error&) {
    // Without a thread there are no results; the errors are those of the ticks.
  }
  return false;
}

ModelTest::Outcome ModelTest::run(const Models& untested, const Models& timed) {
  const auto progress = [this](double) { return !cancelled_.load(std::memory_order_relaxed); };
  Outcome outcome;
  if (replay_ == nullptr && make_ != nullptr && !made_) {
    Result<Recording> made = make_(progress);
    if (!made) return outcome;
    made_ = std::move(*made);
  }
  const Recording* recording = replay_ != nullptr ? &replay_->recording() : made_ ? &*made_ : nullptr;
  if (recording != nullptr && !air_N_) air_N_ = prepare_recording(*recording)->surface.force_zero_N;
  outcome.force_zero_N = air_N_.value_or(0.0);
  if (recording == nullptr) {
    for (const auto& model : untested) outcome.tested.push_back({model, {}, {}, {}});
  } else if (!untested.empty()) {
    std::vector<EvaluatedModel> evaluated;
    for (const auto& model : untested) evaluated.push_back({model, jnd_});
    EvaluationRequest request;
    request.control.progress = progress;
    request.move_surface = replay_ != nullptr;
    request.force_zero_N = outcome.force_zero_N;
    auto result = evaluate(*recording, evaluated, request);
    if (!result) return outcome;
    const auto errors_of = [](const ModelErrors& errors) -> Errors {
      const UnitErrors of_units = errors.unit_errors();
      return {of_units, of_units.p99_interval(), of_units.drawn_strokes};
    };
    for (std::size_t i = 0; i < untested.size(); ++i) {
      const auto& one = result->models[i];
      outcome.tested.push_back({untested[i], errors_of(one.as_recorded), errors_of(one.surface_moved), {}});
    }
    samples_ = std::move(result->timing);
  }
  if (replay_ != nullptr) {
    const Recording zeroed = with_force_zero(*recording, outcome.force_zero_N);
    outcome.surface = locate_surface(thinned_rows(zeroed, kSearchRows), timed, jnd_);
  }
  outcome.timed = timed;
  for (const ModelTiming& timing : time_models(timed, samples_)) outcome.ticks.push_back(timing.tick);
  return outcome;
}

void ModelTest::take(Outcome outcome) {
  for (Tested& one : outcome.tested) tested_.push_back(std::move(one));
  std::erase_if(tested_, [&](const Tested& one) { return std::ranges::count(ready_, one.model) == 0; });
  for (Tested& one : tested_) {
    const auto at = std::ranges::find(outcome.timed, one.model);
    if (at != outcome.timed.end()) one.tick = outcome.ticks[static_cast<std::size_t>(at - outcome.timed.begin())];
  }
  if (outcome.timed == ready_) surface_ = outcome.surface;
  force_zero_N_ = outcome.force_zero_N;
}

const ModelTest::Tested* ModelTest::find(const ForceModel* model) const noexcept {
  const auto found = std::ranges::find_if(tested_, [&](const Tested& one) { return one.model.get() == model; });
  return found == tested_.end() ? nullptr : &*found;
}

bool ModelTest::move(bool moved) {
  moved_ = moved;
  if (replay_ == nullptr || replay_->surface_offset_m() == offset_m()) return false;
  replay_->move_surface(offset_m());
  return true;
}

}  // namespace palpate
