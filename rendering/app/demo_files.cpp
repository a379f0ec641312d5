#include "rendering/app/demo_app.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/common.hpp>
#include <nlohmann/json.hpp>
#include <utility>

#include "engine/base/files.h"
#include "engine/base/text.h"
#include "scenes/scene/scene.h"

namespace palpate {

// The settings as JSON: a missing field is the default.
NLOHMANN_JSON_SERIALIZE_ENUM(Theme, {{Theme::light, "light"}, {Theme::dark, "dark"}})
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(Settings, theme, text_size, recent)

namespace {

using Json = nlohmann::ordered_json;

Json times_json(const TimePercentiles& times) {
  return {{"p50", times.p50_us}, {"p99", times.p99_us}, {"p99_9", times.p99_9_us}, {"max", times.max_us}};
}

// Figures are null if there are no samples.
Json model_json(const ModelView& slot) {
  const auto known = [&](double value) { return slot.errors.samples > 0 ? value : kUnknown; };
  return {{"name", slot.name},
          {"method", slot.method},
          {"centres", slot.centres},
          {"samples", slot.errors.samples},
          {"within_jnd", known(slot.errors.within_jnd)},
          {"rms_error_N", known(slot.errors.rms_error_N)},
          {"max_error_over_jnd", known(slot.errors.max_error_over_jnd)},
          {"p99_error_over_jnd", known(slot.errors.p99_error_over_jnd)},
          {"tick_ns", slot.tick_ns() > 0.0 ? slot.tick_ns() : kUnknown},
          {"equals", slot.equals}};
}

constexpr double kFigure_jnd = 3.0;

std::string number(float value) { return std::isnan(value) ? "" : general(value, 6); }

std::string title_of(const WindowView& shown, const std::string& source) {
  return source + "; compared with: " + shown.reference_words;
}

Series curve_of(const ModelsView& models, std::size_t slot) {
  const glm::uvec3 parts(glm::round(255.0F * slot_colour(models, slot, Theme::light)));
  return {models.slots[slot].name, parts.r << 16 | parts.g << 8 | parts.b, Mark::line, {}};
}

}  // namespace

Result<Settings> read_settings(const std::string& path) {
  const auto text = read_whole_file(path);
  if (!text) return Settings();
  try {
    Settings settings = nlohmann::json::parse(*text).get<Settings>();
    settings.text_size = std::clamp(settings.text_size, kSmallestText, kLargestText);
    return settings;
  } catch (const nlohmann::json::exception&) {
    return Error{path + ": found no settings of the window; the defaults are used"};
  }
}

Status write_settings(const std::string& path, const Settings& settings) {
  return write_file_atomically(path, nlohmann::json(settings).dump(2) + "\n", true);
}

std::string stats_text(const LiveSession& session, const WindowView& shown, const FrameFigures& frames) {
  const LoopStatistics loop = session.loop().statistics();
  const TimePercentiles frame = frames.times.percentiles();
  const LiveSession::StartTimes& start = session.start_times();
  Json models = Json::array(), faults = Json::array();
  for (const ModelView& model : shown.models.slots)
    if (model.state == SlotState::ready) models.push_back(model_json(model));
  for (const FaultEvent& fault : session.faults().events())
    faults.push_back({{"loop_time_s", fault.loop_time_s}, {"text", fault.text}, {"count", fault.count}});
  constexpr double kMsPerUs = 1e-3;
  const Json all = {
      {"haptics",
       {{"ticks", loop.ticks},
        {"missed_deadlines", loop.missed_deadlines},
        {"lateness_us", times_json(loop.lateness)},
        {"tick_us", times_json(loop.tick)},
        {"scheduling", session.loop().scheduling().scheduling},
        {"scheduling_fix", session.loop().scheduling().fix}}},
      {"graphics",
       {{"frames", frame.count},
        {"fps", frames.seconds > 0.0 ? static_cast<double>(frame.count) / frames.seconds : 0.0},
        {"frame_ms",
         {{"p50", kMsPerUs * frame.p50_us}, {"p99", kMsPerUs * frame.p99_us}, {"max", kMsPerUs * frame.max_us}}}}},
      // A NaN, not yet, becomes null.
      {"start",
       {{"first_row_s", start.first_model_s}, {"all_rows_s", start.all_models_s}, {"verdict_s", start.verdict_s}}},
      {"models", models},
      {"verdict", shown.models.verdict.headline},
      {"faults", faults},
      {"scene", session.scene().name},
      {"device", session.device_name()},
      {"reference", session.reference_words()}};
  return all.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Plot curve_plot(const CurveColumns& columns, const WindowView& shown, const CurveTime& time,
                const std::string& source) {
  const std::vector<std::size_t> slots = shown.models.drawn();
  const double to_s = time.end_s(shown.now_s), from_s = to_s - time.shown_s;
  Panel force, difference;
  force.title = title_of(shown, source);
  force.y = {"Force [N]", "", false, 0.0};
  force.series = {{"within 1 JND", kMutedColour, Mark::area, {}}, {"reference", kMeasuredColour, Mark::line, {}}};
  difference.x.title = "Time [s]";
  difference.y = {"Difference [JND]", "", false, -kFigure_jnd, kFigure_jnd};
  difference.series = {force.series[0]};
  for (const std::size_t slot : slots)
    for (Panel* panel : {&force, &difference}) panel->series.push_back(curve_of(shown.models, slot));
  for (Panel* panel : {&force, &difference}) {
    panel->x.low = from_s - time.zero_s;
    panel->x.high = to_s - time.zero_s;
  }
  for (const CurveColumn& column : columns.columns()) {
    const HistoryPoint& tick = column.tick;
    if (!column.any || tick.loop_time_s < from_s || tick.loop_time_s > to_s) continue;
    const double time_s = tick.loop_time_s - time.zero_s, reference_N = tick.reference_N, jnd_N = column.jnd_N;
    force.series[0].rows.push_back({time_s, reference_N, reference_N - jnd_N, reference_N + jnd_N});
    force.series[1].rows.push_back({time_s, reference_N});
    difference.series[0].rows.push_back({time_s, 0.0, -1.0, 1.0});
    for (std::size_t i = 0; i < slots.size(); ++i) {
      force.series[i + 2].rows.push_back({time_s, static_cast<double>(tick.force_N[slots[i]])});
      difference.series[i + 1].rows.push_back({time_s, tick.difference_over_jnd(slots[i], shown.models.jnd)});
    }
  }
  Plot plot;
  plot.name = "curves";
  plot.height = 1.2;  // with room for the legend of many models
  plot.panels = {std::move(force), std::move(difference)};
  return plot;
}

std::string curve_csv(const WindowView& shown, const CurveTime& time, const std::string& source) {
  const ForceHistory& history = *shown.history;
  const double to_s = time.end_s(shown.now_s);
  std::string csv = "# " + title_of(shown, source) + "\ntime_s,depth_m,reference_N,rendered_N";
  const std::vector<std::size_t> slots = shown.models.drawn();
  for (const std::size_t slot : slots) csv.append(",").append(shown.models.slots[slot].name).append("_N");
  csv += "\n";
  for (std::size_t i = history.first_at(to_s - time.shown_s); i < history.size(); ++i) {
    const HistoryPoint& point = history[i];
    if (point.loop_time_s > to_s) break;
    csv += fixed(point.loop_time_s - time.zero_s, 6) + "," + number(point.depth_m) + "," + number(point.reference_N) +
           "," + number(point.rendered_N);
    for (const std::size_t slot : slots) csv.append(",").append(number(point.force_N[slot]));
    csv += "\n";
  }
  return csv;
}

std::string DemoFiles::new_path(const char* name, const char* extension) {
  const auto folder = data_folder();
  if (folder) return *folder + local_time_text(name) + "-" + std::to_string(++saved_) + extension;
  notify_(folder.error().message, true);
  return {};
}

void DemoFiles::finish() {
  if (running_.valid()) running_.wait();
  for (const Task& task : std::exchange(waiting_, {}))
    if (task.saves) (void)task.work();
}

void DemoFiles::use_settings(const std::string& file) {
  settings_file_ = file;
  if (file.empty()) return;
  auto settings = read_settings(file);
  if (!settings) return notify_(settings.error().message, true);
  view_.settings = *settings;
}

void DemoFiles::save_settings() {
  // The window is closing, so an error cannot be shown.
  if (!settings_file_.empty()) (void)write_settings(settings_file_, view_.settings);
}

void DemoFiles::update(const LiveSession& session) {
  if (running_.valid() && running_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) running_.get()();
  if (!running_.valid() && !waiting_.empty()) {
    running_ = std::async(std::launch::async, std::move(waiting_.front().work));
    waiting_.pop_front();
  }
  // When a recording is saved, asks for its role.
  const RecordingStatus status = session.recording();
  if (status.active || status.saving) {
    recording_ = status.path;
  } else if (!recording_.empty()) {
    std::error_code missing;
    if (!view_.exhibit.on && std::filesystem::exists(recording_, missing))
      view_.dialogs.recording_roles.add({recording_, {}});
    recording_.clear();
  }
}

void DemoFiles::open(const std::string& path, LiveSession& session) {
  std::error_code unknown;
  if (!std::filesystem::exists(path, unknown)) {
    notify_("there is no file " + path, true);
  } else if (may_be_recording(path)) {
    open_recording(path);
  } else if (session.models().load_file(path)) {
    remember(path);
  }
}

void DemoFiles::remember(const std::string& path) {
  constexpr std::size_t kRecent = 5;
  std::vector<std::string>& recent = view_.settings.recent;
  std::erase(recent, path);
  recent.insert(recent.begin(), path);
  if (recent.size() > kRecent) recent.pop_back();
}

void DemoFiles::open_recording(const std::string& path) {
  const auto into = data_folder();
  if (!into) return notify_(into.error().message, true);
  notify_("reading " + path, false);
  waiting_.push_back({[this, read = read_, path, into = *into]() -> Finish {
    return [this, path, offered = read(path, into)] {
      if (!offered) {
        view_.dialogs.recording_roles.problem = offered.error().message;
        return;
      }
      if (offered->path != path) notify_("imported " + path + " as " + offered->path, false);
      view_.dialogs.recording_roles.add(*offered);
      remember(path);
    };
  }});
}

void DemoFiles::record(LiveSession& session) {
  if (session.recording().active) return session.stop_recording();
  const std::string path = new_path("/session-%Y%m%d-%H%M%S", ".csv");
  if (path.empty()) return;
  const Status status = session.start_recording(path);
  notify_(status ? "recording to " + path : status.error().message, !status);
}

// Saves the data of the visible curves and a figure of them, in the background.
void DemoFiles::save_curves(const LiveSession& session, const WindowView& shown, const CurveColumns& columns) {
  const std::string path = new_path("/curves-%Y%m%d-%H%M%S", "");
  if (path.empty()) return;
  const std::string source = session.scene().title + ", " + session.device_name();
  const auto save = [this, path, table = curve_csv(shown, view_.time, source),
                     plot = curve_plot(columns, shown, view_.time, source)]() -> Finish {
    if (const Status written = write_file_atomically(path + ".csv", table, false); !written)
      return [this, written] { notify_(written.error().message, true); };
    return [this, path, drawn = draw_plot(plot, path + ".svg", false)] {
      notify_(drawn ? "saved " + path + ".svg and .csv"
                    : "saved " + path + ".csv without a figure: " + drawn.error().message,
              !drawn);
    };
  };
  waiting_.push_back({save, true});
}

void DemoFiles::save_table(const WindowView& shown) {
  save("the table", "/table-%Y%m%d-%H%M%S", ".csv",
       [&](const std::string& path) { return write_file_atomically(path, table_csv(shown.models), false); });
}

void DemoFiles::save_model(const LiveSession& session) {
  const SessionModels& models = session.models();
  save(models.info(models.selected()).name, "/model-%Y%m%d-%H%M%S", ".json",
       [&](const std::string& path) { return models.save(models.selected(), path); });
}

void DemoFiles::save(const std::string& what, const char* name, const char* extension,
                     const std::function<Status(const std::string&)>& write) {
  const std::string path = new_path(name, extension);
  if (path.empty()) return;
  const Status written = write(path);
  notify_(written ? "saved " + what + " to " + path : written.error().message, !written);
}

void DemoFiles::look_for_devices() {
  view_.devices.clear();
  if (std::exchange(searching_, true)) return;
  waiting_.push_back({[this]() -> Finish {
    return [this, found = device_choices()] {
      view_.devices = found;
      searching_ = false;
    };
  }});
}

void DemoFiles::write_to_log(const std::string& text) {
  const auto into = data_folder();
  if (!into) return;
  std::ofstream(*into + "/exhibit.log", std::ios::app) << local_time_text("%Y-%m-%d %H:%M:%S ") << text << '\n';
}

}  // namespace palpate
