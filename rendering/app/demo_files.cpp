// What the window does with files, settings and sessions.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <utility>

#include "engine/base/atomic_file.h"
#include "engine/live/pacer.h"
#include "rendering/app/demo_app.h"
#include "rendering/panels/panel_parts.h"
#include "rendering/panels/panel_views.h"
#include "scenes/scene/assets.h"
#include "scenes/scene/local_time.h"
#include "scenes/scene/user_folders.h"
#include "scenes/worker/slot_plan.h"

namespace palpate {

void DemoApp::use_settings(const DemoRequest& request) {
  settings_file_ = request.settings_file;
  if (settings_file_.empty() || view_.exhibit) return;
  auto settings = read_settings(settings_file_);
  if (!settings) {
    notify(settings.error().message, true);
    return;
  }
  settings_ = *settings;
  view_.theme = settings_.theme;
  view_.block_count = settings_.block_count;
  view_.difference = settings_.difference;
  view_.text_size = settings_.text_size;
  view_.picker.recent = settings_.recent;
}

void DemoApp::save_settings() {
  if (settings_file_.empty() || view_.exhibit || blocks_ == nullptr) return;
  settings_.theme = view_.theme;
  settings_.block_count = view_.block_count;
  settings_.difference = view_.difference;
  settings_.text_size = view_.text_size;
  settings_.recent = view_.picker.recent;
  if (!session_->line_up().empty()) settings_.line_up = session_->line_up();
  settings_.camera = blocks_->camera().turned();
  // Nobody is there to read of it any more.
  (void)write_settings(settings_file_, settings_);
}

// Another material: its own models, fitted to it.
void DemoApp::switch_to(const std::string& scene, const std::string& recording, const std::string& device) {
  next_ = request_;
  next_->scene = scene;
  next_->recording = recording;
  next_->device = device;
  next_->models.clear();
  if (next_->line_up.empty()) next_->line_up = line_ups().front().name;
}

void DemoApp::reopen(const SessionRequest& request) {
  SessionRequest wanted = request;
  // A device belongs to one session at a time.
  session_.reset();
  auto session = LiveSession::open(wanted);
  if (!session) {
    notify(session.error().message, true);
    wanted = request_;
    session = LiveSession::open(wanted);
  }
  if (!session) {  // not even what was there: the device has gone
    wanted.device = "mouse";
    session = LiveSession::open(wanted);
  }
  request_ = wanted;
  session_ = std::move(*session);
  auto blocks = BlockView::create(session_->scene());
  if (blocks) blocks_ = std::move(*blocks);
  blocks_->camera().turn(settings_.camera);
  blocks_framed_ = 0;
  stirred_ = true;
  panel_ = Panel{};  // no curve of the old one
  toasts_.clear();
  view_.time = CurveTime{};
  view_.time.zero_s = steady_now_s();
}

// A large file takes a while to read, in which the picture goes on. The last one counts.
void DemoApp::offer(const std::string& path) {
  const auto folder = data_folder();
  if (!folder) {
    notify(folder.error().message, true);
    return;
  }
  arriving_ = std::async(std::launch::async, [path, folder = *folder] { return offer_recording(path, folder); });
  notify("reading " + path, false);
}

void DemoApp::show_offer() {
  if (!arriving_.valid() || arriving_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  const Result<RecordingOffer> offered = arriving_.get();
  if (offered) {
    view_.offered = {offered->path, offered->words, {}};
  } else {
    view_.offered = {{}, {}, offered.error().message};
  }
}

// Recorded and on the disk: what now?
void DemoApp::offer_finished_recording() {
  const RecordingStatus status = session_->recording();
  if (status.active || status.saving) {
    recording_ = status.path;
  } else if (!recording_.empty()) {
    std::error_code missing;
    if (!view_.exhibit && std::filesystem::exists(recording_, missing)) view_.offered = {recording_, {}, {}};
    recording_.clear();
  }
}

void DemoApp::next_line_up() {
  if (!session_->scene().has_material()) {
    notify("there is nothing to fit models to: O chooses a material, a recording is one too", false);
    return;
  }
  const std::vector<LineUp>& all = line_ups();
  const auto at =
      std::find_if(all.begin(), all.end(), [&](const LineUp& one) { return one.name == session_->line_up(); });
  const LineUp& next = at == all.end() || at + 1 == all.end() ? all.front() : *(at + 1);
  session_->use_line_up(next.name);
  request_.line_up = next.name;
  request_.models.clear();
  notify(std::string(next.name) + ": " + next.help, false);
}

// As deep as there are data, and softly a little beyond.
double DemoApp::limited_depth_m(double requested_m) const {
  constexpr double kMargin = 0.08;  // of that depth
  const double known_m = session_->models().trained_depth_m();
  if (requested_m <= known_m) return requested_m;
  const double margin_m = kMargin * known_m;
  return known_m + margin_m * (1.0 - std::exp((known_m - requested_m) / margin_m));
}

void DemoApp::record() {
  if (session_->recording().active) {
    session_->stop_recording();
    return;
  }
  const auto folder = data_folder();
  if (!folder) {
    notify(folder.error().message, true);
    return;
  }
  const std::string path = *folder + local_time_text("/session-%Y%m%d-%H%M%S.csv");
  const Status status = session_->start_recording(path);
  notify(status ? "recording to " + path : status.error().message, !status);
}

CurveSource DemoApp::curve_source() const {
  CurveSource source{session_->scene().title, session_->device_name(), session_->reference_words(),
                     session_->jnd(),         view_.time.zero_s,       {}};
  for (std::size_t i = 0; i < session_->models().size(); ++i) {
    if (session_->models().view(i).state == SlotState::ready)
      source.models.push_back(
          {i, session_->models().view(i).name, slot_colour(models_view(*session_), i, Theme::light)});
  }
  return source;
}

// What the curves show now, as a figure and as data.
void DemoApp::save_curves() {
  const auto folder = data_folder();
  if (!folder) {
    notify(folder.error().message, true);
    return;
  }
  const std::string path = *folder + local_time_text("/curves-%Y%m%d-%H%M%S");
  const double to_s = view_.time.end_s(steady_now_s());
  const double from_s = to_s - view_.time.shown_s;
  const CurveSource source = curve_source();
  Status status = write_file_atomically(path + ".svg", curve_svg(panel_.columns(), source, from_s, to_s), false);
  if (status)
    status =
        write_file_atomically(path + ".csv", curve_csv(session_->comparison().history(), source, from_s, to_s), false);
  notify(status ? "saved " + path + ".svg and .csv" : status.error().message, !status);
}

void DemoApp::save_model() {
  const auto folder = data_folder();
  if (!folder) {
    notify(folder.error().message, true);
    return;
  }
  const std::size_t slot = session_->models().selected();
  std::string path = *folder + "/model" + local_time_text("-%Y%m%d-%H%M%S.json");
  const Status status = session_->save_model(slot, path);
  notify(status ? "saved " + session_->models().view(slot).name + " to " + path : status.error().message, !status);
}

void DemoApp::choose_device() {
  view_.device_list = !view_.device_list;
  if (!view_.device_list || looking_.valid()) return;
  view_.devices.clear();
  looking_ = std::async(std::launch::async, device_choices);
}

Status DemoApp::set_up_exhibit(const ExhibitTimes& times) {
  const auto assets = find_assets();
  if (!assets) return assets.error();
  auto languages = read_exhibit_words(*assets + "/exhibit");
  if (!languages) return languages.error();
  const auto folder = data_folder();
  exhibit_.set_up(std::move(*languages), folder ? *folder + local_time_text("/exhibit-%Y%m%d.txt") : "", times);
  return {};
}

void DemoApp::write_to_log(const std::string& text) const {
  const auto folder = data_folder();
  if (!folder) return;
  std::ofstream(*folder + "/exhibit.log", std::ios::app) << local_time_text("%Y-%m-%d %H:%M:%S ") << text << '\n';
}

}  // namespace palpate
