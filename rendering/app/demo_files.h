// What the window does with files and devices: its settings, what is dropped and what is
// saved. Whatever comes of it is told by `notify`.
//
// Thread guarantee: main thread only; slow work goes on beside it.
#pragma once

#include <functional>
#include <future>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "rendering/app/settings.h"
#include "rendering/panels/curve_files.h"
#include "rendering/panels/window_view.h"
#include "scenes/live/live_session.h"
#include "scenes/live/notices.h"
#include "scenes/live/recording_offer.h"

namespace palpate {

class LiveSession;

class DemoFiles {
 public:
  using Notify = std::function<void(std::string text, bool problem)>;
  using Read = std::function<Result<RecordingOffer>(const std::string& path, const std::string& folder)>;
  // `view` outlives this. `read`: any thread, blocks.
  DemoFiles(ViewState& view, Notify notify, Read read = offer_recording)
      : view_(view), notify_(std::move(notify)), read_(std::move(read)) {}

  // Of this file; empty: nothing is remembered.
  void use_settings(const std::string& file);
  void save_settings(const LiveSession& session, const CameraTurn& camera);

  // Once a frame: what has been read, found or recorded meanwhile.
  void update(const LiveSession& session);
  // A model (.json) is loaded; all else is offered to be trained or tested on, as a
  // recording or as another program's table.
  void open(const std::string& path, LiveSession& session);
  void offer(const std::string& path);
  void record(LiveSession& session);
  void save_curves(const LiveSession& session, const WindowView& shown, const CurveColumns& columns);
  void save_model(const LiveSession& session);
  void look_for_devices();
  // For the host of an exhibit.
  static void write_to_log(const std::string& text);

 private:
  void remember(const std::string& path);  // as opened of late
  // Where files go; empty, and told: nowhere.
  std::string folder();

  ViewState& view_;
  Notify notify_;
  Read read_;
  std::string settings_file_;
  std::future<Result<RecordingOffer>> arriving_;    // a file that is read
  std::string reading_;                             // its path
  std::vector<std::string> waiting_;                // to be read after it
  std::future<std::vector<DeviceChoice>> looking_;  // for devices
  std::future<Notice> drawing_;                     // a figure of the curves
  std::string recording_;                           // the file that is being recorded; empty: none
};

}  // namespace palpate
