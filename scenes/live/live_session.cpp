#include "scenes/live/live_session.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "devices/registry/auto_device.h"
#include "devices/registry/device_registry.h"
#include "devices/virtual/replay_device.h"
#include "scenes/scene/assets.h"
#include "scenes/live/live_slot.h"
#include "scenes/worker/model_worker.h"
#include "scenes/live/true_force.h"
#include "scenes/scene/local_time.h"

namespace palpate {
namespace {

// A job_id of a file that has no slot yet.
constexpr std::size_t kNoSlot = static_cast<std::size_t>(-1);
constexpr std::size_t kSnapshotsAtOnce = 256;
constexpr std::size_t kMostNotices = 100;
// A device that fails all day does not fill the disk.
constexpr int kMostFaultFiles = 50;
// A longer gap between snapshots is a stall, in which the picture stood still.
constexpr double kLongestStep_s = 0.1;

}  // namespace

LiveSession::LiveSession(const SessionRequest& request, Scene scene, std::unique_ptr<Device> device)
    : request_(request),
      scene_(std::move(scene)),
      device_(std::move(device)),
      auto_(dynamic_cast<AutoDevice*>(device_.get())),
      mouse_(dynamic_cast<MouseDevice*>(device_.get())),
      replay_(dynamic_cast<ReplayDevice*>(device_.get())),
      buffer_(kSnapshotsAtOnce) {}

Result<std::unique_ptr<LiveSession>> LiveSession::open(const SessionRequest& request) {
  Result<Scene> scene = load_scene(request.scene);
  if (!scene) return scene.error();
  const Result<std::vector<SlotPlan>> plans = plan_slots(*scene, request.models, request.position_only);
  if (!plans) return plans.error();
  DeviceRequest wanted;
  wanted.seed = request.seed + 1;  // other gestures than those of the training recording
  wanted.hand.strongest_press_N = scene->strongest_press_N;
  wanted.bus = request.bus;
  if (const auto assets = find_assets()) wanted.calibrations = *assets + "/devices";
  Result<std::unique_ptr<Device>> device = open_device(request.device, wanted);
  if (!device) return device.error();
  std::unique_ptr<LiveSession> session(new LiveSession(request, std::move(*scene), std::move(*device)));
  for (const SlotPlan& plan : *plans) {
    auto slot = std::make_unique<Slot>();
    slot->view.name = session->distinct_name(plan_name(plan), nullptr);
    slot->view.method = plan_method(plan);
    slot->plan = plan;
    session->slots_.push_back(std::move(slot));
  }
  if (const Status status = session->begin(); !status) return status.error();
  return session;
}

Status LiveSession::begin() {
  if (scene_.material && replay_ == nullptr) {
    const Result<Material> material = find_material(*scene_.material);
    if (!material) return material.error();
    truth_ = std::make_shared<TrueForce>(*material);
  }
  reference_ = replay_ != nullptr  ? ReferenceKind::measured
               : truth_ != nullptr ? ReferenceKind::truth
                                   : ReferenceKind::direct;
  LoopSettings settings;
  settings.realtime = request_.realtime;
  settings.tick.jnd = scene_.jnd;
  loop_ = std::make_unique<HapticsLoop>(*device_, settings);
  recorder_ = std::make_unique<SessionRecorder>(*loop_);
  worker_ = std::make_unique<ModelWorker>(scene_, request_.seed);
  for (std::size_t i = 0; i < slots_.size(); ++i) worker_->add_job(i, slots_[i]->plan);
  outstanding_ = slots_.size();
  if (std::string note = device_->note(); !note.empty()) say(std::move(note), false);
  if (Status status = worker_->start(); !status) return status;
  return loop_->start();
}

LiveSession::~LiveSession() {
  if (worker_ != nullptr) worker_->cancel();
  if (recorder_ != nullptr) {
    stop_recording();
    recorder_->wait();
  }
  if (loop_ != nullptr) loop_->stop();
}

void LiveSession::update() {
  take_models();
  loop_->collect_models();
  take_snapshots();
  show_newest();
  see_faults();
  if (std::optional<Notice> outcome = recorder_->take_outcome()) {
    // It may have ended by itself.
    recording_ = 0;
    send_controls();
    say(std::move(outcome->text), outcome->problem);
  }
}

void LiveSession::take_snapshots() {
  // At most what the ring holds: a loop that is quicker than this is not waited for.
  for (std::size_t round = 0; round <= kSnapshotRing / kSnapshotsAtOnce; ++round) {
    const std::size_t count = loop_->read_snapshots(buffer_.data(), buffer_.size());
    for (std::size_t i = 0; i < count; ++i) take(buffer_[i]);
    if (count < buffer_.size()) break;
  }
}

void LiveSession::take(const LoopSnapshot& snapshot) {
  const PublishedSet* set = set_of(snapshot);
  const double reference_N = reference_in(snapshot, set);
  const double step_s = std::clamp(snapshot.loop_time_s - last_loop_time_s_, 0.0, kLongestStep_s);
  last_loop_time_s_ = snapshot.loop_time_s;
  // Filters that begin in the middle of a press know nothing of its beginning: no
  // model is judged before the tool has been in the air once.
  if (snapshot.restarted || set == nullptr) begun_in_air_ = false;
  if (set != nullptr && !snapshot.tick.in_contact) begun_in_air_ = true;
  HistoryPoint point;
  point.loop_time_s = snapshot.loop_time_s;
  point.depth_m = static_cast<float>(snapshot.tick.depth_m);
  point.reference_N = static_cast<float>(reference_N);
  point.rendered_N = static_cast<float>(snapshot.rendered_N);
  point.in_contact = snapshot.tick.in_contact;
  point.out_of_domain = (snapshot.tick.out_of_domain_mask >> snapshot.selected & 1U) != 0;
  point.trouble = faults_.see(snapshot);
  point.force_N.fill(std::nanf(""));
  if (set != nullptr) {
    for (std::size_t i = 0; i < set->slots.size(); ++i) {
      point.force_N[set->slots[i]] = static_cast<float>(snapshot.tick.force_N[i]);
      take_slot(i, set->slots[i], snapshot, reference_N);
    }
  }
  for (const auto& slot : slots_) slot->dent.step(snapshot.tick.depth_m, slot->late_error_over_jnd, step_s);
  history_.append(point);
}

// `index`: the slot's model in the set that made the snapshot.
void LiveSession::take_slot(std::size_t index, std::size_t slot_index, const LoopSnapshot& snapshot,
                            double reference_N) {
  Slot& slot = *slots_[slot_index];
  slot.late_error_over_jnd = 0.0;
  const bool counts = begun_in_air_ && snapshot.samples > 0 && snapshot.tick.in_contact &&
                      (snapshot.tick.fault == TickFault::none || snapshot.tick.fault == TickFault::force_not_finite);
  if (!counts) return;
  slot.time.add(snapshot.evaluation_ns[index]);
  if (!std::isfinite(reference_N)) return;
  const double force_N = snapshot.tick.force_N[index];
  slot.late_error_over_jnd = scene_.jnd.error_over_jnd(force_N, reference_N);
  slot.view.errors.add(force_N, reference_N, (snapshot.tick.out_of_domain_mask >> index & 1U) != 0, scene_.jnd);
}

void LiveSession::show_newest() {
  newest_ = loop_->newest();
  const PublishedSet* set = set_of(newest_);
  reference_N_ = reference_in(newest_, set);
  for (const auto& slot : slots_) {
    slot->view.dent_m = slot->dent.depth_m();
    slot->view.dent_error_over_jnd = slot->dent.error_over_jnd();
    slot->view.evaluation_ns = slot->time.median_ns();
  }
  if (set == nullptr) return;
  const bool compared = newest_.tick.in_contact && std::isfinite(reference_N_);
  for (std::size_t i = 0; i < set->slots.size(); ++i) {
    SlotView& view = slots_[set->slots[i]]->view;
    view.force_N = newest_.tick.force_N[i];
    view.out_of_domain = (newest_.tick.out_of_domain_mask >> i & 1U) != 0;
    view.error_N = compared ? view.force_N - reference_N_ : 0.0;
    view.error_over_jnd = compared ? scene_.jnd.error_over_jnd(view.force_N, reference_N_) : 0.0;
  }
}

void LiveSession::see_faults() {
  const double at_s = steady_now_s();
  faults_.see_dropped(loop_->dropped_snapshots(), at_s);
  faults_.see_age(loop_->age_s(), at_s);
  save_fault_ticks();
}

// The last second before a fault, in a file beside wherever the program runs.
void LiveSession::save_fault_ticks() {
  const auto ticks = loop_->take_fault_ticks();
  if (!ticks || fault_files_ == kMostFaultFiles) return;
  ++fault_files_;
  const std::string path = local_time_text("fault-%Y%m%d-%H%M%S-") + std::to_string(fault_files_) + ".csv";
  const Status status = write_fault_file(path, *ticks);
  say(status ? "the last second before the fault is in " + path : status.error().message, !status);
}

const LiveSession::PublishedSet* LiveSession::set_of(const LoopSnapshot& snapshot) const noexcept {
  for (auto set = sets_.rbegin(); set != sets_.rend(); ++set) {
    if (set->id == snapshot.models_id) return &*set;
  }
  return nullptr;
}

double LiveSession::reference_in(const LoopSnapshot& snapshot, const PublishedSet* set) const noexcept {
  switch (reference_) {
    case ReferenceKind::measured: return snapshot.measured_N;
    case ReferenceKind::truth: return snapshot.reference_N;
    case ReferenceKind::direct: break;
  }
  if (set == nullptr || !direct_slot_) return kNoForce;
  const auto place = std::find(set->slots.begin(), set->slots.end(), *direct_slot_);
  if (place == set->slots.end()) return kNoForce;
  return snapshot.tick.force_N[static_cast<std::size_t>(place - set->slots.begin())];
}

// Models.

void LiveSession::take_models() {
  const ModelWorker::Progress progress = worker_->progress();
  if (progress.working && progress.job_id < slots_.size()) {
    SlotView& view = slots_[progress.job_id]->view;
    if (view.state == SlotState::waiting) view.state = SlotState::fitting;
    if (view.state == SlotState::fitting) view.progress = progress.share;
  }
  bool joined = false;
  for (FinishedModel& finished : worker_->take_finished()) {
    --outstanding_;
    if (finished.job_id == kNoSlot) {
      take_file(finished);
    } else {
      join(finished.job_id, finished);
    }
    joined = joined || finished.model != nullptr;
  }
  if (joined) publish();
}

void LiveSession::take_file(FinishedModel& finished) {
  --outstanding_files_;
  if (finished.model == nullptr) {
    say(finished.problem, true);
    return;
  }
  slots_.push_back(std::make_unique<Slot>());
  slots_.back()->plan = finished.plan;
  join(slots_.size() - 1, finished);
  say("loaded " + slots_.back()->view.name + " from " + finished.plan.path, false);
}

void LiveSession::join(std::size_t index, FinishedModel& finished) {
  Slot& slot = *slots_[index];
  if (finished.model == nullptr) {
    slot.view.state = SlotState::failed;
    slot.view.problem = finished.problem;
    say(slot.view.name + ": " + finished.problem, true);
    return;
  }
  const bool first = std::none_of(slots_.begin(), slots_.end(),
                                  [](const auto& other) { return other->view.state == SlotState::ready; });
  slot.model = finished.model;
  slot.dent = Dent(slot.model->features());
  slot.view.state = SlotState::ready;
  slot.view.progress = 1.0;
  slot.view.centres = slot.model->centre_count();
  if (slot.plan.origin != ModelOrigin::position) {
    slot.view.method = slot.model->method();
    slot.view.name = distinct_name(slot.model->name(), &slot);
  }
  if (!direct_slot_ && slot.view.method == "direct") direct_slot_ = index;
  if (first || (index == 0 && !user_chose_)) selected_ = index;
}

void LiveSession::publish() {
  PublishedSet set;
  set.id = sets_.empty() ? 1 : sets_.back().id + 1;
  std::vector<std::shared_ptr<const ForceModel>> models;
  std::uint32_t selected = 0;
  std::uint32_t written = kMaxModels;
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    if (slots_[i]->view.state != SlotState::ready) continue;
    if (i == selected_) selected = static_cast<std::uint32_t>(models.size());
    if (direct_slot_ == i) written = static_cast<std::uint32_t>(models.size());
    models.push_back(slots_[i]->model);
    set.slots.push_back(i);
  }
  auto next = std::make_unique<LiveModels>(set.id, device_->sensor(), std::move(models), truth_);
  next->selected = selected;
  next->written_model = written;
  sets_.push_back(std::move(set));
  loop_->publish_models(std::move(next));
  send_controls();
}

void LiveSession::send_controls() {
  LoopControls controls;
  controls.recording = recording_;
  controls.acknowledged = acknowledged_;
  controls.dead_man = dead_man_;
  controls.held_s = held_s_;
  if (!sets_.empty()) {
    const std::vector<std::size_t>& in_set = sets_.back().slots;
    const auto place = std::find(in_set.begin(), in_set.end(), selected_);
    controls.models_id = sets_.back().id;
    controls.selected = static_cast<std::uint32_t>(place - in_set.begin());
  }
  loop_->set_controls(controls);
}

const SlotView& LiveSession::slot(std::size_t index) const noexcept { return slots_[index]->view; }

void LiveSession::select(std::size_t slot) {
  if (slot >= slots_.size() || slots_[slot]->view.state != SlotState::ready) return;
  selected_ = slot;
  user_chose_ = true;
  send_controls();
}

void LiveSession::load_file(const std::string& path) {
  if (slots_.size() + outstanding_files_ >= kMaxModels) {
    say("cannot load " + path + ": there are " + std::to_string(kMaxModels) +
            " models already; start again with fewer",
        true);
    return;
  }
  ++outstanding_;
  ++outstanding_files_;
  worker_->add_job(kNoSlot, {ModelOrigin::file, Method::greedy, path, nullptr});
}

bool LiveSession::all_settled() const noexcept { return outstanding_ == 0; }

std::string LiveSession::distinct_name(const std::string& name, const Slot* but) const {
  const auto taken = [&](const std::string& candidate) {
    return std::any_of(slots_.begin(), slots_.end(),
                       [&](const auto& slot) { return slot.get() != but && slot->view.name == candidate; });
  };
  std::string candidate = name;
  for (int i = 2; taken(candidate); ++i) candidate = name + "-" + std::to_string(i);
  return candidate;
}

void LiveSession::say(std::string text, bool problem) {
  if (notices_.size() == kMostNotices) notices_.erase(notices_.begin());
  notices_.push_back({std::move(text), problem});
}

std::vector<Notice> LiveSession::take_notices() { return std::exchange(notices_, {}); }

}  // namespace palpate
