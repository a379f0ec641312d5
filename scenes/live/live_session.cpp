#include "scenes/live/live_session.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string_view>

#include "engine/base/text.h"
#include "models/model/fitted_model.h"
#include "models/samples/recording_faults.h"
#include "scenes/live/true_force.h"
#include "scenes/scene/folders.h"

namespace palpate {
namespace {

constexpr std::size_t kSnapshotsAtOnce = 256;
// Time before a tick in which the loop rehearses it: a real-time thread wakes up about 30 us late, and a rehearsal of
// seven models takes 15 us.
constexpr std::int64_t kRehearse_ns = 100'000;
// The number is limited, so that a device that fails all day does not fill the disk.
constexpr int kMostFaultFiles = 50;

constexpr std::string_view kReplay = "replay:";

std::string replayed_file(const std::string& device) {
  return device.rfind(kReplay, 0) == 0 ? device.substr(kReplay.size()) : std::string();
}

// Limits the simulated hand to the forces, depths and speeds of the training data. Returns whether there is any force.
// Where no position is positive (a surface at negative positions), only the force is limited.
// Speeds are differences over at least 20 ms, to suppress encoder steps. The fastest 1 % are ignored as noise.
// The rows of a recording are not empty (read_recording).
bool limit_hand(const std::vector<Recording>& recordings, HandSettings& hand) {
  constexpr double kInside = 0.8;  // of the largest values, because the simulated hand overshoots
  constexpr double kSpan_s = 0.02;
  double strongest_N = 0.0, deepest_m = 0.0;
  std::vector<double> speeds_m_per_s;  // in contact
  for (const Recording& recording : recordings) {
    RecordingRow before = recording.rows.front();
    for (const RecordingRow& row : recording.rows) {
      strongest_N = std::max(strongest_N, row.force_N);
      deepest_m = std::max(deepest_m, row.position_m);
      const double span_s = row.time_s - before.time_s;
      if (span_s < kSpan_s) continue;
      if (row.position_m > 0.0) speeds_m_per_s.push_back(std::abs(row.position_m - before.position_m) / span_s);
      before = row;
    }
  }
  if (strongest_N <= 0.0) return false;
  hand.strongest_press_N = kInside * strongest_N;
  if (deepest_m > 0.0) hand.deepest_m = kInside * deepest_m;
  if (speeds_m_per_s.empty()) return true;
  const auto fast = speeds_m_per_s.begin() + static_cast<std::ptrdiff_t>(99 * (speeds_m_per_s.size() - 1) / 100);
  std::nth_element(speeds_m_per_s.begin(), fast, speeds_m_per_s.end());
  hand.fastest_m_per_s = kInside * *fast;
  return true;
}

// Replaces the scene's material by the named recordings, or by the replayed one: no true force is known for them.
Status take_recordings(const SessionRequest& request, Scene& scene, HandSettings& hand) {
  const std::string replayed = replayed_file(request.device);
  scene.recordings = request.recordings;
  if (scene.recordings.empty() && !replayed.empty() && request.refits) scene.recordings = {replayed};
  if (scene.recordings.empty() && replayed.empty()) return {};
  scene.material.reset();
  scene.title.clear();
  scene.description = "Models are fitted to";
  std::vector<Recording> recordings;
  for (const std::string& path : scene.recordings) {
    Result<Recording> recording = read_usable_recording(path);
    if (!recording) return recording.error();
    scene.title += (scene.title.empty() ? "" : ", ") + recording->name;
    scene.description += " " + path;
    recordings.push_back(std::move(*recording));
  }
  if (recordings.empty()) scene.title = std::filesystem::path(replayed).stem().string();
  if (limit_hand(recordings, hand)) scene.strongest_press_N = hand.strongest_press_N;
  return {};
}

// If no scene was named and all models are files, takes the scene from the first file's provenance, without its
// virtual material: it is not the truth of those models.
void take_provenance(std::vector<ModelRequest>& requests, std::size_t files, Scene& scene) {
  if (static_cast<std::size_t>(std::ranges::count_if(requests, &ModelRequest::is_file)) != files) return;
  std::erase_if(requests, [](const ModelRequest& one) { return !one.is_file(); });
  const Provenance& from = requests.front().loaded->data().provenance;
  if (auto own = load_scene(from.scene)) scene = std::move(*own);
  scene.material.reset();
  scene.title = request_name(requests.front()) + ": a model";
  scene.description = "Fitted to " + (from.recordings.empty() ? "" : from.recordings.front()) + " in " + scene.name;
}

}  // namespace

std::vector<DeviceDescription> device_choices() {
  std::vector<DeviceDescription> choices = list_devices({.calibrations = calibrations_folder()});
  std::erase_if(choices, [](const DeviceDescription& device) { return device.name.find(':') != std::string::npos; });
  return choices;
}

LiveSession::LiveSession(const SessionRequest& request, Scene scene, std::unique_ptr<Device> device)
    : request_(request),
      scene_(std::move(scene)),
      device_(std::move(device)),
      models_(scene_, request.seed, notices_),
      comparison_(models_, scene_.jnd),
      test_(device_->replay(), scene_.jnd),
      buffer_(kSnapshotsAtOnce) {}

Result<std::unique_ptr<LiveSession>> LiveSession::open(const SessionRequest& request) {
  Result<Scene> scene = load_scene(request.scene.empty() ? "silicone_block" : request.scene);
  if (!scene) return scene.error();
  DeviceRequest device_request{.calibrations = calibrations_folder(), .bus = request.bus};
  device_request.hand.strongest_press_N = scene->strongest_press_N;
  if (const Status status = take_recordings(request, *scene, device_request.hand); !status) return status.error();
  const LineUp* line_up = request.models.empty() && scene->has_material() ? find_line_up(request.line_up) : nullptr;
  Result<std::vector<ModelRequest>> plans = std::vector<ModelRequest>();
  if (request.refits)
    plans = requested_models(*scene, line_up != nullptr ? line_up->models : request.models, request.position_only);
  if (!plans) return plans.error();
  for (const ModelRequest& plan : request.kept) {
    // A plan without a model needs a material to fit to.
    if (plans->size() < kMaxModels && (plan.loaded != nullptr || scene->has_material())) plans->push_back(plan);
  }
  if (request.scene.empty() && !request.models.empty() && scene->recordings.empty())
    take_provenance(*plans, request.models.size(), *scene);
  device_request.seed = request.seed + 1;  // so that the gestures differ from those of the training recording
  Result<std::unique_ptr<Device>> device = open_device(request.device, device_request);
  if (!device) return device.error();
  std::unique_ptr<LiveSession> session(new LiveSession(request, std::move(*scene), std::move(*device)));
  if (line_up == nullptr) session->request_.line_up.clear();
  if (const Status status = session->begin(*plans); !status) return status.error();
  return session;
}

Status LiveSession::begin(const std::vector<ModelRequest>& plans) {
  if (scene_.material && !device_->measures_force()) {
    const Result<Material> material = find_material(*scene_.material);
    if (!material) return material.error();
    truth_ = std::make_shared<TrueForce>(*material);
  }
  comparison_.use_reference(*std::find_if(kReferenceKinds.begin(), kReferenceKinds.end() - 1,
                                          [&](ReferenceKind kind) { return has_reference(kind); }));
  if (replay() != nullptr) comparison_.begins_at(replay()->recording().rows.front().time_s);
  LoopSettings settings;
  settings.jnd = scene_.jnd;
  settings.rehearse_ns = kRehearse_ns;
  settings.realtime = request_.realtime;
  loop_ = std::make_unique<HapticsLoop>(*device_, settings);
  recorder_ = std::make_unique<SessionRecorder>(*loop_);
  if (std::string note = device_->note(); !note.empty()) notices_.push_back({std::move(note), false});
  if (Status status = models_.start(plans, !request_.scene.empty()); !status) return status;
  // The first set has the true force only, so that the material is rendered before any model is ready.
  if (truth_ != nullptr) publish("the start");
  return loop_->start();
}

LiveSession::~LiveSession() {
  models_.cancel();
  close();
}

void LiveSession::close() {
  recorder_.reset();  // completes a recording
  if (loop_ != nullptr) loop_->stop();
  device_->close();
}

void LiveSession::update() {
  // The snapshots come first, because new models are initialised with the motion up to now.
  read_snapshots();
  update_models();
  if (test_.update(models_)) comparison_.forget_errors("the surface was found");
  loop_->collect_models();
  newest_ = loop_->newest();
  comparison_.show(newest_);
  const LoopStatistics statistics = loop_->statistics();
  faults_.update_window(statistics.dropped_snapshots, statistics.age_s, steady_now_s());
  if (std::optional<Notice> outcome = recorder_->read_outcome())
    notices_.push_back({std::move(outcome->text), outcome->problem});
  controls_.recording = recorder_->number();
  models_.write_selection(controls_);
  loop_->set_controls(controls_);
}

void LiveSession::update_models() {
  const std::vector<std::size_t> ready = models_.update();
  for (const std::size_t slot : models_.read_freed()) comparison_.forget_slot(slot);
  if (ready.empty()) return;
  for (const std::size_t slot : ready) comparison_.begin_slot(slot);
  const std::string& name = models_.info(ready.back()).name;
  publish(name.substr(0, name.size() > 16 ? name.find('-') : name.size()) + " joined");
}

// Clears all errors, so that all models are compared over the same samples.
void LiveSession::publish(std::string why) {
  comparison_.forget_errors(std::move(why));
  auto set = models_.make_set(device_->sensor(), truth_);
  set->tick.recall(history_);
  loop_->publish_models(std::move(set));
}

void LiveSession::remove(std::size_t slot) {
  if (models_.remove(slot)) publish(models_.info(slot).name + " was removed");
}

void LiveSession::treat_as_this_material(std::size_t slot) {
  models_.treat_as_this_material(slot);
  comparison_.forget_errors(models_.info(slot).name + " joined");
}

void LiveSession::use_line_up(const std::string& name) {
  const LineUp* line_up = find_line_up(name);
  if (line_up == nullptr || !scene_.has_material()) return;
  const auto plans = requested_models(scene_, line_up->models, false);
  if (!plans) return;
  request_.line_up = name;
  models_.use_requests(*plans);
  publish("other models are shown");
}

void LiveSession::read_snapshots() {
  // Reads at most as many snapshots as the ring holds, so that a faster loop cannot keep this thread here.
  for (std::size_t round = 0; round <= kSnapshotRing / kSnapshotsAtOnce; ++round) {
    const std::size_t count = loop_->read_snapshots(buffer_.data(), buffer_.size());
    for (std::size_t i = 0; i < count; ++i) {
      if (buffer_[i].samples > 0) history_.add(buffer_[i].tick, buffer_[i].restarted);
      comparison_.add(buffer_[i], faults_.update(buffer_[i]));
      if (fault_recorder_.add(buffer_[i])) save_fault_ticks();
    }
    if (count < buffer_.size()) break;
  }
}

// Writes the last second before a fault to a file.
void LiveSession::save_fault_ticks() {
  if (fault_files_ == kMostFaultFiles) return;
  ++fault_files_;
  const std::string path = (request_.data_folder.empty() ? "" : request_.data_folder + "/") +
                           local_time_text("fault-%Y%m%d-%H%M%S-") + std::to_string(fault_files_) + ".csv";
  const Status status = write_fault_file(path, fault_recorder_.ticks());
  notices_.push_back({status ? "the last second before the fault is in " + path : status.error().message, !status});
}

bool LiveSession::has_reference(ReferenceKind kind) const noexcept {
  return kind == ReferenceKind::measured ? device_->measures_force()
         : kind == ReferenceKind::truth  ? truth_ != nullptr
                                         : models_.reference().has_value();
}

void LiveSession::use_reference(ReferenceKind kind) {
  if (has_reference(kind)) comparison_.use_reference(kind);
}

bool LiveSession::replays_training() const noexcept {
  return models_.fits() && std::ranges::count(scene_.recordings, replayed_file(request_.device)) > 0;
}

bool LiveSession::tests_recording() const noexcept {
  return replay() != nullptr && comparison_.reference() == ReferenceKind::measured && test_.rounds() > 0;
}

ModelFigures LiveSession::figures(std::size_t slot) const {
  ModelFigures figures = comparison_.figures(slot);
  if (!tests_recording()) return figures;
  const UnitErrors* tested = test_.errors(models_.model(slot).get());
  figures.errors = tested != nullptr ? static_cast<const ErrorSummary&>(*tested) : ErrorSummary{};
  return figures;
}

Verdict LiveSession::verdict() const {
  const bool of_model = comparison_.reference() == ReferenceKind::direct;
  std::vector<EvaluatedSlot> evaluated;
  for (const std::size_t slot : models_.ready_slots()) {
    if (of_model && models_.reference() == slot) continue;
    const UnitErrors* errors =
        tests_recording() ? test_.as_recorded(models_.model(slot).get()) : &comparison_.unit_errors(slot);
    if (errors == nullptr || errors->samples == 0) continue;
    evaluated.push_back({slot, errors, figures(slot).errors.p99_error_over_jnd});
  }
  if (evaluated.empty()) return {{}, false, why_no_verdict(), {}};
  Verdict verdict = judge(evaluated, models_, of_model ? models_.info(*models_.reference()).name : "");
  if (of_model && verdict.detail.empty())
    verdict.detail = "There is no true force here: test on a second recording (M).";
  if (replay() != nullptr && replays_training()) verdict.detail += " This is its training recording.";
  if (!models_.all_settled()) verdict.detail = "Preliminary: other models are still being fitted. " + verdict.detail;
  return verdict;
}

std::string LiveSession::why_no_verdict() const {
  if (models_.size() == 0) return {};
  if (!has_reference(comparison_.reference())) return reference_words();
  if (replay() != nullptr && comparison_.reference() == ReferenceKind::measured)
    return "Testing the models on " + replay()->recording().name + " ...";
  if (comparison_.outside_s() > Comparison::kLeastContact_s) {
    const std::string& name = models_.info(comparison_.mostly_outside()).name;
    return "No verdict yet: these presses are deeper or faster than what " + name + " was trained on";
  }
  return models_.ready_slots().empty() ? "The models are being fitted ..." : "Press for one second to get a verdict.";
}

std::string LiveSession::reference_words(bool brief) const {
  if (comparison_.reference() == ReferenceKind::truth)
    return brief ? "the material" : "true force of the virtual material, " + *scene_.material;
  if (comparison_.reference() == ReferenceKind::measured) {
    if (replay() == nullptr) return brief ? "the real block" : "measured force of the real block";
    return brief ? "the recording"
                 : "as recorded in " + replay()->recording().name + (replays_training() ? ", fitted to it" : "");
  }
  if (!models_.reference()) return "no truth to compare with";
  const std::string& model = models_.info(*models_.reference()).name;
  if (brief) return model;
  if (scene_.material) return "direct interpolant";
  return (scene_.recordings.empty() ? "no truth to compare with: difference from " : "best model of the recording, ") +
         model;
}

void LiveSession::reset_figures() {
  comparison_.forget_errors("they were cleared");
  faults_.acknowledge();
  ++controls_.acknowledged;
}

std::string LiveSession::device_words() const {
  const DeviceHealth& device = newest_.device;
  // The fault that made zeroing necessary comes first: an unplugged device cannot be zeroed.
  if (device.zeroing == Zeroing::needed && (device.faults & device_fault::kLosesPosition) != 0) {
    return device_fault_words(device.faults & device_fault::kLosesPosition).front();
  }
  std::string words = zeroing_words(device);
  if (words.empty() && newest_.dead_man_released) {
    words = controls_.dead_man == DeadMan::grip ? "no force: hold the switch on the handle" : "no force: hold G";
  }
  return words;
}

void LiveSession::move_surface(bool moved) {
  if (test_.move(moved)) comparison_.forget_errors("the surface moved");
}

Status LiveSession::start_recording(const std::string& path) {
  if (!has_reference(comparison_.reference())) {
    return Error{"there is no force to record yet: no reference is ready; wait for one or choose another"};
  }
  RecorderRequest request;
  request.path = path;
  request.force = comparison_.reference();
  const SensorSpec sensor = device_->sensor();
  request.columns = {sensor.has_velocity, sensor.has_acceleration};
  request.comments = {"recorded live; scene " + scene_.name + ", device " + device_->name(),
                      "force_N: " + reference_words() + ", not what the device rendered",
                      "when the stream restarts (end of a replay, seek), time_s continues 30 s later",
                      "position_m: " + (test_.offset_m() == 0.0 ? std::string("as the device gave it")
                                                                : "moved to the models' surface by " +
                                                                      fixed(-1e3 * test_.offset_m(), 3) + " mm")};
  return recorder_->start(request);
}

}  // namespace palpate
