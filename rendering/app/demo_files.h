// The window's work with files and devices: settings, dropped files, saved files, statistics, the list of devices.
// Thread guarantee: main thread only; slow work runs in the background.
#pragma once

#include <deque>
#include <functional>
#include <future>
#include <string>

#include "engine/base/result.h"
#include "rendering/panels/time_plot.h"
#include "rendering/panels/view_state.h"
#include "rendering/panels/window_view.h"
#include "scenes/live/live_session.h"
#include "scenes/live/session_recordings.h"
#include "scenes/plot/plot.h"

namespace palpate {

// The settings that the window keeps between runs, a JSON file in the user's configuration folder; a missing file gives
// the defaults. Errors: the file has no settings.
Result<Settings> read_settings(const std::string& path);
Status write_settings(const std::string& path, const Settings& settings);

// The JSON text of --stats: haptics, graphics, start (seconds until the comparison stood), models, verdict, faults,
// scene, device, reference.
std::string stats_text(const LiveSession& session, const WindowView& shown, const FrameFigures& frames);

// The curves of the panel as a figure (gnuplot) and as a table (CSV). `source`: scene and device.
// Two panels: force with the JND band, and difference in JND. Every point is the tick of a column (CurveColumn::tick).
Plot curve_plot(const CurveColumns& columns, const WindowView& shown, const CurveTime& time, const std::string& source);

// Every tick that the curves show, with the columns time_s,depth_m,reference_N,rendered_N and "<name>_N" for each
// model. A missing force is an empty field.
std::string curve_csv(const WindowView& shown, const CurveTime& time, const std::string& source);

// Does this work and shows its results as notices.
class DemoFiles {
 public:
  using Notify = std::function<void(std::string text, bool problem)>;
  using Read = std::function<Result<ConvertedRecording>(const std::string& path, const std::string& folder)>;
  // `view` outlives this. `notify` shows a notice. `read` is called in a background thread and may block.
  DemoFiles(ViewState& view, Notify notify, Read read = convert_recording)
      : view_(view), notify_(std::move(notify)), read_(std::move(read)) {}
  ~DemoFiles() { finish(); }
  // Waits for the work that runs, and completes the saves that wait.
  void finish();

  // Reads the settings from `file`; empty: settings are neither read nor saved.
  void use_settings(const std::string& file);
  void save_settings(const LiveSession& session, const CameraTurn& camera);

  // Call it once a frame: processes finished background work and recordings.
  void update(const LiveSession& session);
  // Calls `open_recording` for a file with an extension other than .json; loads any other file as a model.
  void open(const std::string& path, LiveSession& session);
  // Reads a recording or another program's table in the background, then asks whether to train or to test on it.
  void open_recording(const std::string& path);
  void record(LiveSession& session);
  void save_curves(const LiveSession& session, const WindowView& shown, const CurveColumns& columns);
  void save_model(const LiveSession& session);
  void look_for_devices();
  // Appends to the log file of the exhibit.
  static void write_to_log(const std::string& text);

 private:
  // The second part of a task: `update` calls it when the work in the background is done.
  using Finish = std::function<void()>;
  struct Task {
    std::function<Finish()> work;
    bool saves = false;  // it is completed even if the window closes
  };
  void remember(const std::string& path);  // adds it to the recent files
  // A path in the user's data folder, with a name made of the time and a number; empty, after a notice, where there is
  // no folder.
  std::string new_path(const char* name, const char* extension);

  ViewState& view_;
  Notify notify_;
  Read read_;
  std::string settings_file_;
  int saved_ = 0;             // number of the newest path of `new_path`: two may be of the same second
  std::deque<Task> waiting_;  // `update` starts one after the other in the background
  std::future<Finish> running_;
  bool searching_ = false;  // a search for devices waits or runs
  std::string recording_;   // the file that is being recorded; empty: none
};

}  // namespace palpate
