#include "scenes/live/live_session.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string_view>

#include "devices/virtual/simulated_devices.h"
#include "engine/base/text.h"
#include "engine/live/pacer.h"
#include "models/model/fitted_model.h"
#include "models/samples/samples.h"
#include "scenes/evaluation/evaluate.h"
#include "scenes/material/rig.h"

namespace palpate {
namespace {

constexpr std::size_t kSnapshotsAtOnce = 256;
// Time before a tick in which the loop rehearses it twice, in 10 us each with six models. What is left is spun away: 10
// us more cost 1 % of a processor.
constexpr std::int64_t kRehearse_ns = 45'000;
constexpr double kLeastContact_s = 1.0;  // for a verdict on the user's own presses
constexpr double kJudged_s = 2.0;        // between two such verdicts
// The number is limited, so that a device that fails all day does not fill the disk.
constexpr int kMostFaultFiles = 50;

constexpr std::string_view kReplay = "replay:";

std::string replayed_file(const std::string& device) {
  return device.rfind(kReplay, 0) == 0 ? device.substr(kReplay.size()) : std::string();
}

// Replaces the scene's material by the named recordings, or by the replayed one: no true force is known for them.
// Returns the recordings.
Result<std::vector<Recording>> take_recordings(const SessionRequest& request, Scene& scene, HandSettings& hand) {
  const std::string replayed = replayed_file(request.device);
  std::vector<Recording> recordings;
  scene.recordings = request.recordings;
  if (scene.recordings.empty() && !replayed.empty() && request.refits) scene.recordings = {replayed};
  if (scene.recordings.empty() && replayed.empty()) return recordings;
  scene.material.reset();
  scene.title.clear();
  scene.description = "Models are fitted to";
  for (const std::string& path : scene.recordings) {
    Result<Recording> recording = read_usable_recording(path);
    if (!recording) return recording.error();
    scene.title += (scene.title.empty() ? "" : ", ") + recording->name;
    scene.description += " " + path;
    recordings.push_back(std::move(*recording));
  }
  if (recordings.empty()) scene.title = std::filesystem::path(replayed).stem().string();
  if (limit_hand(recordings, hand)) scene.strongest_press_N = hand.strongest_press_N;
  return recordings;
}

std::string test_file_of(const SessionRequest& request, const Scene& scene) {
  if (!request.test.empty()) return request.test;
  const std::string replayed = replayed_file(request.device);
  return replayed.empty() && !scene.recordings.empty() ? scene.recordings.back() : replayed;
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

LiveSession::LiveSession(const SessionRequest& request, Scene scene, std::unique_ptr<Device> device,
                         std::vector<Recording> training, std::optional<Recording> part)
    : request_(request),
      scene_(std::move(scene)),
      device_(std::move(device)),
      set_apart_(part.has_value()),
      models_(scene_, request.seed, notices_, std::move(training), request.ready_models),
      comparison_(models_,
                  device_->measures_force() ? ReferenceKind::measured
                  : scene_.material         ? ReferenceKind::truth
                                            : ReferenceKind::model,
                  scene_.jnd),
      test_(device_->replay(), make_test(std::move(part)), scene_.jnd),
      buffer_(kSnapshotsAtOnce) {}

ModelTest::MakeRecording LiveSession::make_test(std::optional<Recording> part) const {
  if (part) return [part = std::move(*part)](const auto&) -> Result<Recording> { return part; };
  const std::string file = test_file();
  if (!file.empty()) return [file](const auto&) { return read_recording(file); };
  // The seed is another one than that of the training recording.
  if (comparison_.reference() == ReferenceKind::truth) {
    return [settings = RigSettings{*scene_.material, request_.seed + 1}](const auto& progress) {
      return record_sensors(settings, progress);
    };
  }
  return {};
}

Result<std::unique_ptr<LiveSession>> LiveSession::open(const SessionRequest& request) {
  const double began_s = steady_now_s();
  Result<Scene> scene = load_scene(request.scene.empty() ? "silicone_block" : request.scene);
  if (!scene) return scene.error();
  DeviceRequest device_request{.calibrations = calibrations_folder(), .bus = request.bus};
  device_request.hand.strongest_press_N = scene->strongest_press_N;
  auto training = take_recordings(request, *scene, device_request.hand);
  if (!training) return training.error();
  const LineUp* line_up = request.models.empty() && scene->has_material() ? find_line_up(request.line_up) : nullptr;
  Result<std::vector<ModelRequest>> plans = std::vector<ModelRequest>();
  if (request.refits) plans = requested_models(*scene, line_up != nullptr ? line_up->models : request.models);
  if (!plans) return plans.error();
  // Files that the user names together with a scene count as models of it, whatever their provenance.
  for (ModelRequest& plan : *plans) plan.of_this_material = !request.scene.empty();
  for (const ModelRequest& plan : request.kept) {
    // A plan without a model needs a material to fit to.
    if (plans->size() < kMaxModels && (plan.loaded != nullptr || scene->has_material())) plans->push_back(plan);
  }
  if (request.scene.empty() && !request.models.empty() && scene->recordings.empty())
    take_provenance(*plans, request.models.size(), *scene);
  // A training recording that is the test as well keeps its last part for it, unless its models exist already.
  std::optional<Recording> part;
  const std::string test = test_file_of(request, *scene);
  const auto shared = std::ranges::find(scene->recordings, test);
  const bool set_apart = std::ranges::any_of(*plans, [&](const ModelRequest& plan) {
    return !plan.is_file() && (plan.loaded == nullptr || request.test == test);
  });
  if (shared != scene->recordings.end() && set_apart)
    part = take_test_part((*training)[static_cast<std::size_t>(shared - scene->recordings.begin())]);
  device_request.seed = request.seed + 1;  // so that the gestures differ from those of the training recording
  Result<std::unique_ptr<Device>> device = std::unique_ptr<Device>();
  if (part && replayed_file(request.device) == test) {
    *device = std::make_unique<ReplayDevice>(*part);
  } else {
    device = open_device(request.device, device_request);
  }
  if (!device) return device.error();
  std::unique_ptr<LiveSession> session(
      new LiveSession(request, std::move(*scene), std::move(*device), std::move(*training), std::move(part)));
  session->began_s_ = began_s;
  if (line_up == nullptr) session->request_.line_up.clear();
  if (const Status status = session->begin(*plans); !status) return status.error();
  return session;
}

Status LiveSession::begin(const std::vector<ModelRequest>& plans) {
  if (comparison_.reference() == ReferenceKind::truth) {
    const Result<Material> material = find_material(*scene_.material);
    if (!material) return material.error();
    truth_ = std::make_shared<TrueForce>(*material);
  }
  if (replay() != nullptr) comparison_.begins_at(replay()->recording().rows.front().time_s);
  LoopSettings settings;
  settings.jnd = scene_.jnd;
  settings.rehearse_ns = kRehearse_ns;
  settings.realtime = request_.realtime;
  loop_ = std::make_unique<HapticsLoop>(*device_, settings);
  recorder_ = std::make_unique<SessionRecorder>(*loop_);
  if (std::string note = device_->note(); !note.empty() && !request_.known_device)
    notices_.push_back({std::move(note), false});
  if (set_apart_)
    notices_.push_back(
        {"The end of " + test_file() + " is set apart: models are fitted to the rest and tested on it.", false});
  if (Status status = models_.start(plans); !status) return status;
  // The first set has the true force only, so that the material is rendered before any model is ready.
  if (truth_ != nullptr) publish();
  return loop_->start();
}

LiveSession::~LiveSession() { close(); }

void LiveSession::close() {
  models_.cancel();
  recorder_.reset();  // completes a recording
  if (loop_ != nullptr) loop_->stop();
  device_->close();
}

void LiveSession::update() {
  // The snapshots come first, because new models are initialised with the motion up to now.
  read_snapshots();
  update_models();
  if (test_.update(models_) && test_.move(test_.moved())) comparison_.forget_errors();
  loop_->collect_models();
  newest_ = loop_->newest();
  update_verdict();
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
  for (const std::size_t slot : models_.read_freed()) {
    comparison_.forget_slot(slot);
    paths_.erase(slot);
  }
  for (const std::size_t slot : ready) comparison_.begin_slot(slot);
  if (models_.read_changed()) publish();
}

// Clears all errors, so that all models are compared over the same samples.
void LiveSession::publish() {
  comparison_.forget_errors();
  auto set = models_.make_set(device_->sensor(), truth_);
  set->tick.recall(history_);
  loop_->publish_models(std::move(set));
}

void LiveSession::use_line_up(const std::string& name) {
  const LineUp* line_up = find_line_up(name);
  if (line_up == nullptr || !scene_.has_material()) return;
  const auto plans = requested_models(scene_, line_up->models);
  if (!plans) return;
  request_.line_up = name;
  models_.use_requests(*plans);
}

void LiveSession::read_snapshots() {
  // At most as many snapshots as the ring holds, so that a faster loop cannot keep this thread here.
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

void LiveSession::save_fault_ticks() {
  if (fault_files_ == kMostFaultFiles) return;
  ++fault_files_;
  const std::string path = (request_.data_folder.empty() ? "" : request_.data_folder + "/") +
                           local_time_text("fault-%Y%m%d-%H%M%S-") + std::to_string(fault_files_) + ".csv";
  const Status status = write_fault_file(path, fault_recorder_.ticks());
  notices_.push_back({status ? "the last second before the fault is in " + path : status.error().message, !status});
}

bool LiveSession::tests_training() const {
  return !set_apart_ && models_.fits() && std::ranges::count(scene_.recordings, test_file()) > 0;
}

ModelFigures LiveSession::figures(std::size_t slot) const {
  ModelFigures figures = comparison_.figures(slot);
  const PublishedSet* set = models_.set_of(newest_);
  if (const std::size_t i = set != nullptr ? set->index_of(slot) : kMaxModels; i < kMaxModels) {
    figures.force_N = newest_.tick.force_N[i];
    figures.predicted_error_N = newest_.tick.predicted_error_N[i];
    figures.out_of_domain = (newest_.tick.out_of_domain_mask >> i & 1U) != 0;
  }
  const ModelTest::Tested* tested = test_.find(models_.model(slot).get());
  if (tested != nullptr) figures.tick = tested->tick;
  if (!test_.has_recording()) return figures;
  figures.errors = {};
  if (tested != nullptr && !models_.info(slot).other_material) {
    figures.errors = test_.errors(*tested);
    figures.p99_interval = test_.errors(*tested).p99_interval;
  }
  if (const auto path = paths_.find(slot); path != paths_.end()) figures.path = path->second;
  return figures;
}

std::optional<LiveSession::Worst> LiveSession::worst(std::size_t slot, bool of_test, double zero_s) const {
  if (slot >= models_.size() || models_.info(slot).state != SlotState::ready) return std::nullopt;
  Worst worst{.slot = slot};
  if (const Recording* recording = of_test ? test_.recording() : nullptr)
    worst.history = worst_of_test(slot, *recording, zero_s);
  const ForceHistory& history = worst.history ? *worst.history : comparison_.history();
  float largest = 0.0F;
  std::size_t at = history.size();
  for (std::size_t i = 0; i < history.size(); ++i) {
    const float error = std::abs(history[i].sustained_over_jnd[slot]);
    if (!history[i].counts || !(error > largest)) continue;
    largest = error;
    at = i;
  }
  if (at == history.size()) return std::nullopt;
  worst.at_s = history[at].loop_time_s;
  worst.words = motion_words(motion_at(at, history.size(), [&](std::size_t i) {
    return std::pair(history[i].loop_time_s, static_cast<double>(history[i].position_m));
  }));
  return worst;
}

// Replays the test twice: to find the moment of the largest error, and to keep the ticks around it.
std::shared_ptr<const ForceHistory> LiveSession::worst_of_test(std::size_t slot, const Recording& as_recorded,
                                                               double zero_s) const {
  constexpr double kBefore_s = 30.0, kAfter_s = 2.0;  // a hold of half a minute, in about 10 MB
  const std::vector<std::size_t> slots = models_.ready_slots();
  const Recording recording = with_force_zero(as_recorded, test_.force_zero_N());
  const auto each_tick = [&](const auto& use) {
    NoticedErrors noticed;
    (void)palpate::replay(
        recording, models_.ready_models(),
        [&](const RecordingRow& row, const TickSnapshot& tick, const auto&) {
          HistoryPoint point;
          point.loop_time_s = zero_s + row.time_s - recording.rows.front().time_s;
          point.time_s = row.time_s;
          point.position_m = static_cast<float>(tick.position_m);
          point.depth_m = static_cast<float>(tick.depth_m);
          point.reference_N = static_cast<float>(row.force_N);
          point.counts = point.in_contact = tick.in_contact;
          point.active = static_cast<std::uint8_t>(slot);
          for (std::size_t i = 0; i < slots.size(); ++i) point.force_N[slots[i]] = static_cast<float>(tick.force_N[i]);
          noticed.add(point, scene_.jnd);
          use(point);
        },
        test_.offset_m());
  };
  float largest = 0.0F;
  double worst_s = std::numeric_limits<double>::quiet_NaN();
  each_tick([&](const HistoryPoint& point) {
    const float error = std::abs(point.sustained_over_jnd[slot]);
    if (!point.counts || !(error > largest)) return;
    largest = error;
    worst_s = point.time_s;
  });
  const auto is_near = [&](double time_s) { return time_s >= worst_s - kBefore_s && time_s <= worst_s + kAfter_s; };
  auto history = std::make_shared<ForceHistory>(
      static_cast<std::size_t>(std::ranges::count_if(recording.rows, is_near, &RecordingRow::time_s)));
  each_tick([&](const HistoryPoint& point) {
    if (is_near(point.time_s)) history->append(point);
  });
  return history;
}

void LiveSession::update_verdict() {
  const std::vector<std::size_t> ready = models_.ready_slots();
  const double now_s = steady_now_s() - began_s_;
  const auto note = [&](double& time_s, bool reached) { time_s = reached && std::isnan(time_s) ? now_s : time_s; };
  note(start_.first_model_s, !ready.empty());
  note(start_.all_models_s, !ready.empty() && models_.all_settled());
  const bool live = !test_.has_recording();
  // A sentence about a model that is gone, or whose figures are not known yet, waits.
  const bool refits = std::ranges::any_of(ready, [&](std::size_t slot) { return models_.info(slot).refitting; });
  const bool known = !refits && (!verdict_.chosen || (std::ranges::count(ready, *verdict_.chosen) > 0 &&
                                                      (live || figures(*verdict_.chosen).errors.samples > 0)));
  if (!known) {
    verdict_ = {};
    judged_ = 0;
  }
  if (refits || !test_.complete() || (live && comparison_.counted_s() < kLeastContact_s)) return;
  // The errors of the ticks change with each tick; the sentence does not flicker.
  if (live ? now_s < judged_s_ + kJudged_s : judged_ == test_.results()) return;
  judged_s_ = now_s;
  judged_ = test_.results();
  const bool of_model = live && comparison_.reference() == ReferenceKind::model;
  std::vector<JudgedModel> judged;
  for (const std::size_t slot : ready) {
    const ModelFigures its = figures(slot);
    const ModelInfo& info = models_.info(slot);
    if (its.errors.samples == 0 || its.tick.median_ns <= 0.0 || (of_model && models_.reference() == slot)) continue;
    const ModelTest::Tested* tested = live ? nullptr : test_.find(models_.model(slot).get());
    judged.push_back({{its.errors.within_jnd, its.errors.p99_error_over_jnd, its.tick.median_ns,
                       tested != nullptr ? &test_.errors(*tested).strokes : nullptr},
                      slot,
                      info.name,
                      info.paper,
                      its.tick});
    if (info.takes_centres) paths_[slot][info.centres] = {its.tick.median_ns, its.errors.p99_error_over_jnd};
  }
  if (judged.empty()) return;
  verdict_ = judge(judged, of_model ? models_.info(*models_.reference()).name : "");
  note(start_.verdict_s, true);
  models_.propose(*verdict_.chosen);
  const std::string test =
      "The test is " + test_name() +
      (test_.force_zero_N() == 0.0
           ? ""
           : ", its forces counted from the " + three_digits(1e3 * test_.force_zero_N()) + " mN of its free air");
  verdict_.detail = (of_model           ? "There is no true force here: open a second recording to test on (O)."
                     : live             ? "The test is the presses so far, against " + reference_words(true) + "."
                     : tests_training() ? test + ", to which the models were fitted."
                                        : test + ", which no model was fitted to; it chose the model.") +
                    verdict_.detail;
}

Verdict LiveSession::verdict() const {
  Verdict verdict = verdict_;
  const std::size_t unfinished = models_.unfinished();
  const std::string fitting = "Fitting " + std::to_string(unfinished) + (unfinished == 1 ? " model" : " models") +
                              ", about " + fixed(std::max(1.0, std::ceil(models_.left_s())), 0) + " s left";
  if (!verdict.chosen) {
    verdict.headline = models_.size() == 0             ? ""
                       : unfinished > 0                ? fitting
                       : !has_reference()              ? "There is nothing to compare this model with"
                       : models_.ready_slots().empty() ? "No model could be fitted"
                       : test_.has_recording()         ? "Testing the models ..."
                                                       : "Press the block for a second: the models are compared";
  } else if (unfinished > 0) {
    verdict.detail = fitting + ". " + verdict.detail;
  }
  return verdict;
}

std::string LiveSession::test_file() const { return test_file_of(request_, scene_); }
std::string LiveSession::test_name() const {
  if (replay() != nullptr) return replay()->recording().name;
  const std::string file = test_file();
  if (!file.empty()) return (set_apart_ ? "the end of " : "") + std::filesystem::path(file).stem().string();
  return "another press of the same block";
}

std::string LiveSession::reference_words(bool brief) const {
  if (comparison_.reference() == ReferenceKind::truth)
    return brief ? "the material" : "true force of the virtual material, " + *scene_.material;
  if (comparison_.reference() == ReferenceKind::measured) {
    if (replay() == nullptr) return brief ? "the real block" : "measured force of the real block";
    return brief ? "the recording"
                 : "as recorded in " + replay()->recording().name + (tests_training() ? ", fitted to it" : "");
  }
  if (!models_.reference()) return "no truth to compare with";
  const std::string& model = models_.info(*models_.reference()).name;
  return brief ? model : "no truth to compare with: difference from " + model;
}

void LiveSession::reset_figures() {
  comparison_.forget_errors();
  faults_.acknowledge();
  ++controls_.acknowledged;
}

std::string LiveSession::device_words() const {
  const DeviceHealth& device = newest_.device;
  // The fault that made zeroing necessary comes first: an unplugged device cannot be zeroed.
  if (device.zeroing == Zeroing::needed && (device.faults & device_fault::kLosesPosition) != 0)
    return device_fault_words(device.faults & device_fault::kLosesPosition).front();
  std::string words = zeroing_words(device);
  if (words.empty() && newest_.dead_man_released)
    words = controls_.dead_man == DeadMan::grip ? "no force: hold the switch on the handle" : "no force: hold G";
  return words;
}

void LiveSession::move_surface(bool moved) {
  if (test_.move(moved)) comparison_.forget_errors();
  judged_ = 0;
}

Status LiveSession::start_recording(const std::string& path) {
  if (!has_reference()) return Error{"there is no force to record yet: no reference is ready; wait for one"};
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
