// The state of the window: the user's settings, dialogs, the time that the curves show, figures of the frames.
// Thread guarantee: values of the window's thread.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "engine/live/pacer.h"
#include "rendering/picture/block_view.h"
#include "rendering/ui/colours.h"
#include "scenes/live/live_session.h"
#include "scenes/live/session_recordings.h"

namespace palpate {

inline constexpr double kShown_s = 10.0;       // time span of the curves without zoom
inline constexpr double kLeastShown_s = 0.02;  // smallest time span of the curves

inline constexpr std::size_t kAllBlocks = BlockView::kMostBlocks;  // a block of each model and of the reference

inline constexpr float kSmallestText = 0.8F;  // factor on the size of text
inline constexpr float kLargestText = 1.6F;

// The part of the time that the curves show.
struct CurveTime {
  double zero_s = 0.0;  // loop time at 0 of the time axes
  double shown_s = kShown_s;
  // Paused curves end at paused_at_s (loop time) - scrolled_back_s.
  bool paused = false;
  double paused_at_s = 0.0, scrolled_back_s = 0.0;
  // Loop time under the mouse, and at the beginning of a drag; NaN: none.
  double hover_s = std::numeric_limits<double>::quiet_NaN();
  double drag_from_s = std::numeric_limits<double>::quiet_NaN();

  // Loop time at the right edge of the curves; `now_s` unless paused.
  double end_s(double now_s) const noexcept { return paused ? paused_at_s - scrolled_back_s : now_s; }
  void pause(double at_s) noexcept {
    if (paused) return;
    paused = true;
    paused_at_s = at_s;
    scrolled_back_s = 0.0;
  }
  void run() noexcept {
    paused = false;
    scrolled_back_s = 0.0;
    shown_s = kShown_s;
  }
  // Pauses and shows the range between two times, in either order.
  void zoom(double one_s, double other_s) noexcept {
    paused = true;
    scrolled_back_s = 0.0;
    paused_at_s = std::max(one_s, other_s);
    shown_s = std::max(kLeastShown_s, paused_at_s - std::min(one_s, other_s));
  }
  // Scrolls paused curves back by `by_s`, at most to `oldest_s`.
  void scroll_back(double by_s, double oldest_s) noexcept {
    if (!paused) return;
    const double most_s = std::max(0.0, paused_at_s - shown_s - oldest_s);
    scrolled_back_s = std::clamp(scrolled_back_s + by_s, 0.0, std::max(most_s, scrolled_back_s));
  }
};

struct TableState {
  int column = -1;  // the column that it is sorted by; -1: by slot
  bool rising = false;
  std::array<char, 64> name{};  // the name that is being typed
};

// Recordings that the user opened; models are fitted to all but the test. The user has to confirm it.
struct RecordingRoles {
  std::vector<ConvertedRecording> recordings;
  std::string tested;   // path of the test; empty: none
  std::string problem;  // why a file could not be read
  bool any() const noexcept { return !recordings.empty() || !problem.empty(); }
  // Adds a recording. If there are several, the last one becomes the test.
  void add(ConvertedRecording recording) {
    std::erase_if(recordings, [&](const ConvertedRecording& other) { return other.path == recording.path; });
    recordings.push_back(std::move(recording));
    if (recordings.size() > 1) tested = recordings.back().path;
  }
  std::vector<std::string> training() const {
    std::vector<std::string> paths;
    for (const ConvertedRecording& one : recordings)
      if (one.path != tested) paths.push_back(one.path);
    return paths;
  }
};

struct FilePicker {
  std::string folder;              // empty: the dialog is closed
  std::vector<std::string> files;  // in `folder`
  std::array<char, 512> path{};    // the path that is being typed
  bool takes_focus = false;        // the path gets the focus: the dialog or another folder was opened
};

// Settings that are kept between runs.
struct Settings {
  Theme theme = Theme::light;
  std::size_t blocks = kAllBlocks;  // 1, 2 or all
  bool difference = true;           // the lower curves show the difference of every tick; else its mean over 50 ms
  float text_size = 1.0F;           // factor
  std::string line_up;              // empty: the default
  std::vector<std::string> recent;  // files that were opened, the newest first
  CameraTurn camera;
  bool operator==(const Settings&) const = default;
};

struct Dialogs {
  bool help = false;
  bool file_list = false;   // files to open
  bool scene_list = false;  // scenes to choose from
  bool device_list = false;
  bool view_list = false;  // choices of the display
  RecordingRoles recording_roles;
  FilePicker picker;

  bool any() const noexcept {
    return help || file_list || scene_list || device_list || view_list || recording_roles.any();
  }
};

// The exhibit's control of the picture.
struct ExhibitState {
  bool on = false;
  bool blind = false;         // hides which model is active
  bool close_up = false;      // the camera is nearer
  bool tool_is_held = false;  // keeps the tool out of the block; the mouse has no effect
};

struct FrameFigures {
  TimeHistogram times;  // from the end of one frame to that of the next
  double seconds = 0.0;
  double recent_s = 0.0;  // mean of one frame, of about the last 60; 0: unknown

  void add(double frame_s) noexcept {
    times.add(static_cast<std::int64_t>(1e9 * frame_s));
    seconds += frame_s;
    recent_s += (frame_s - recent_s) / (recent_s > 0.0 ? 60.0 : 1.0);
  }
};

// A notice over the picture.
struct Toast : Notice {
  double until_s = 0.0;  // window time
};

struct ViewState {
  Settings settings;
  Dialogs dialogs;
  ExhibitState exhibit;
  CurveTime time;
  TableState table;
  std::vector<DeviceDescription> devices;  // empty: no search has finished
  FrameFigures frames;
  std::vector<Toast> toasts;
  bool scales_force = false;                           // shows the sliders that scale the rendered force
  bool exaggerated = false;                            // arrows show ten times the difference
  int requested_centres = 0;                           // last value of the slider of centres
  bool details = false;                                // shows the figures and faults of the loop
  float health_px = 0.0F;                              // height of the lines about the loop in the last frame
  bool has_pressed = false;                            // the user has pressed a block, so that the hint is hidden
  std::size_t pointed = static_cast<std::size_t>(-1);  // slot of the row under the mouse; its curves are labelled
  bool verdict = true;                                 // plots error against time of a tick; else error against force
};

}  // namespace palpate
