// The contents of a frame as plain data, read from the session once a frame, so that blocks, overlay, panels and
// exhibit are consistent, and the texts can be tested without a session; the state of the window (the user's settings,
// dialogs, the time that is shown); and the functions that panels call. No panel sees the session. Thread guarantee:
// values of the window's thread.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/live/haptics_loop.h"
#include "engine/live/pacer.h"
#include "engine/tick/jnd.h"
#include "rendering/picture/block_view.h"
#include "rendering/ui/colours.h"
#include "scenes/live/live_session.h"
#include "scenes/live/session_recorder.h"

namespace palpate {

// Instead of a slot: the block of a reference that is no model.
inline constexpr std::size_t kReferenceBlock = static_cast<std::size_t>(-1);

// A command of the window. Keys, buttons, tooltips and the list of keys come from one table of commands
// (rendering/app/demo_commands.cpp).
struct WindowCommand {
  enum class When : std::uint8_t {
    pressed,   // once for each press
    repeated,  // also when the keyboard repeats the key
    held,      // in every frame while the key is held
  };
  std::vector<int> keys{};                 // of GLFW, any of them; empty: `shown` describes the input
  std::string shown{};                     // replaces the names of the keys in the list
  std::string label{};                     // of its button or menu item; empty: none
  std::string help{};                      // one line
  std::function<void(std::size_t)> run{};  // the argument is the index in `keys`; 0 for the button
  When when = When::pressed;
  bool control = false;        // with Ctrl
  bool bar = false;            // has a button; else, with a label, a menu item
  bool replay = false;         // available only during a replay; its button is in the bar of the replay
  std::function<bool()> on{};  // whether it is switched on, which its button shows
  std::string label_on{};      // label while it is switched on; empty: `label`
};

// A choice of several, as it is now. Its key takes the next one, the dialog View shows all.
struct WindowChoice {
  int key;  // of GLFW
  const char* title;
  const char* help;
  std::vector<std::string> names;        // those that are available
  std::size_t now;                       // index into `names`; the largest number: none of them
  std::function<void(std::size_t)> set;  // the argument is an index into `names`
  const char* why_none = "";             // a notice for the key where `names` is empty
};

inline constexpr double kShown_s = 10.0;       // time span of the curves without zoom
inline constexpr double kLeastShown_s = 0.02;  // smallest time span of the curves

inline constexpr std::size_t kAllBlocks = BlockView::kMostBlocks;  // a block of each model and of the reference

inline constexpr float kSmallestText = 0.8F;  // factor on the size of text
inline constexpr float kLargestText = 1.6F;

// The time that curves, blocks and numbers show.
struct CurveTime {
  double zero_s = 0.0;  // loop time at 0 of the time axes
  double shown_s = kShown_s;
  // Paused curves end at paused_at_s (loop time) - scrolled_back_s.
  bool paused = false;
  double paused_at_s = 0.0, scrolled_back_s = 0.0;
  // Loop time under the mouse, at the beginning of a zoom, of the moment to which blocks and numbers are dragged, and
  // of that where they rest without a drag; NaN: none.
  double hover_s = std::numeric_limits<double>::quiet_NaN();
  double zoom_from_s = std::numeric_limits<double>::quiet_NaN();
  double moment_s = std::numeric_limits<double>::quiet_NaN();
  double rest_s = std::numeric_limits<double>::quiet_NaN();
  bool dragging = false;
  bool returns = false;  // the time runs again after the drag

  // Loop time at the right edge of the curves; `now_s` unless paused.
  double end_s(double now_s) const noexcept { return paused ? paused_at_s - scrolled_back_s : now_s; }
  // Loop time of blocks and numbers.
  double at_s(double now_s) const noexcept {
    return !std::isnan(moment_s) ? moment_s : !std::isnan(rest_s) ? rest_s : end_s(now_s);
  }
  void pause(double at_s) noexcept {
    if (paused) return;
    paused = true;
    paused_at_s = at_s;
    scrolled_back_s = 0.0;
  }
  void run() noexcept { *this = {.zero_s = zero_s}; }
  // Moves blocks and numbers to a moment; `end_s`: at the right edge of the curves, which stand still.
  void drag_to(double at_s, double end_s) noexcept {
    if (std::isnan(moment_s)) returns = !paused;
    pause(end_s);
    moment_s = at_s;
  }
  // Returns to now, or to the end of curves that stood still before.
  void end_drag() noexcept {
    if (!std::isnan(moment_s) && returns) paused = false;
    moment_s = std::numeric_limits<double>::quiet_NaN();
    dragging = false;
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

// Settings; theme, size of text and recent files are kept between runs, so that the next user starts with the
// comparison.
struct Settings {
  Theme theme = Theme::light;
  float text_size = 1.0F;           // factor
  std::vector<std::string> recent;  // files that were opened, the newest first
  std::size_t blocks = kAllBlocks;  // 1, 2 or all
  bool operator==(const Settings&) const = default;
};

enum class Dialog : std::uint8_t { none, help, files, scenes, devices, view, exports };

struct Dialogs {
  Dialog open = Dialog::none;      // one at a time
  RecordingRoles recording_roles;  // a dialog in front of that one
  FilePicker picker;

  bool any() const noexcept { return open != Dialog::none || recording_roles.any(); }
};

// The exhibit's control of the picture.
struct ExhibitState {
  bool on = false;
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

struct Toast : Notice {
  double left_s = 0.0;
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
  bool scales_force = false;                // shows the sliders that scale the rendered force
  int focus = -1;                           // the button that Tab has reached; -1: none
  bool opens_menu = false;                  // the next frame opens the menu
  bool exaggerated = false;                 // arrows show ten times the difference
  int requested_centres = 0;                // last value of the slider of centres
  bool details = false;                     // shows the faults of the loop
  float health_px = 0.0F;                   // height of the lines about the loop in the last frame
  bool has_pressed = false;                 // the user has pressed a block, so that the hint is hidden
  std::size_t pointed = kReferenceBlock;    // slot of the row under the mouse
  std::size_t crossed = kReferenceBlock;    // the same of the frame before, for the row's button
  std::size_t second = kReferenceBlock;     // slot of the other of two models that are compared; or none
  bool material = false;                    // the block of the reference is the chosen one
  std::optional<LiveSession::Worst> worst;  // it is shown instead of the present
};

// A slot: its model and its errors.
struct ModelView : ModelInfo, ModelFigures {
  // Whether the errors are known: there are samples, and no other number of centres is being fitted.
  bool is_judged() const noexcept { return errors.samples > 0 && !refitting; }
};

struct ModelsView {
  std::vector<ModelView> slots;
  std::size_t selected = 0;
  std::optional<std::size_t> second;            // the other of two models that are compared with each other only
  bool compared = true;                         // there is a reference
  std::size_t reference = kReferenceBlock;      // its slot, if it is a model
  std::string reference_name = "the material";  // the reference in few words
  std::string counted;                          // the samples that the errors cover, in words
  std::string test_name;                        // the recording that they are of, in words; empty: none
  bool replays_training = false;                // the replayed recording belongs to the training set
  JndLine jnd{};
  Verdict verdict;
  HistoryPoint now;     // the tick that blocks and numbers show; without one all forces are NaN
  bool stands = false;  // it is no longer the newest tick

  // The slots that are not hidden, in order. Keys and tables number them.
  std::vector<std::size_t> listed() const;
  // The slots that are ready, of two compared models only these; the active one last: it is drawn on top.
  std::vector<std::size_t> drawn() const;
  // The number of a listed slot, from 1.
  std::size_t number_of(std::size_t slot) const;
  // The active model; null unless it is ready.
  const ModelView* active() const noexcept;
  // Whether the active model is in contact outside its training domain, except in a replay of training data.
  bool out_of_domain() const noexcept;
};

struct HealthView {
  LoopStatistics loop;
  RtStatus scheduling;
  LoopSnapshot newest;
  double missed_of_late = 0.0;  // see FaultLog
  std::vector<FaultEvent> faults;
  std::vector<std::string> alarms;  // not acknowledged yet
  std::string device_name;
};

struct WindowView {
  ModelsView models;
  HealthView health;
  const Scene* scene = nullptr;  // not null in a result of window_view
  std::string device_words;      // what the user has to do so that the device renders force; may be empty
  ToolInput* tool = nullptr;     // null: a mouse cannot move the tool
  bool hand_explores = false;    // the tool moves by itself
  bool renders_force = false;
  bool settled = false;  // no model is still to be fitted
  ForceScale scale;
  RecordingStatus recording;
  ReplayControl* replay = nullptr;  // null: nothing is replayed
  double surface_m = 0.0;           // of the replay: the offset at which the models fit best; 0: none
  bool surface_moved = false;       // it is subtracted
  // The slots that have a block, in ascending order. If there is too little room, the active model and that of the
  // verdict come first. With several blocks the last one is kReferenceBlock if the reference is no model.
  std::vector<std::size_t> blocks;
  std::string reference_block;  // name of the block of the reference
  std::string reference_words;
  double now_s = 0.0;          // loop time at the right edge of running curves: now; of a paused replay its last tick
  double usual_depth_m = 0.0;  // the axes extend at least to this depth
  const ForceHistory* history = nullptr;        // of the session or of a test; not null in a result of window_view
  std::shared_ptr<const ForceHistory> of_test;  // keeps that of a test
};

// The functions that panels, overlay, dialogs and exhibit call. A slot is the first argument.
struct WindowActions {
  using OfSlot = std::function<void(std::size_t)>;
  using OfText = std::function<void(const std::string&)>;
  OfSlot select, worst;
  std::function<SessionModels&()> models;
  std::function<void(const ForceScale&)> scale;
  std::function<void()> zero_device, look_for_devices;
  std::function<void(bool)> move_surface;
  OfText use_scene, open, use_device;
  std::function<void()> use_recording_roles;           // trains and tests as Dialogs::recording_roles says
  std::function<void()> lift_tool, reset_figures;      // of the exhibit: out of the block; clears errors and alarms
  std::function<std::vector<WindowChoice>()> choices;  // of the dialog View
  std::vector<std::pair<const char*, std::function<void()>>> exports;  // what can be saved, in this order
  const std::vector<WindowCommand>* commands = nullptr;                // for the buttons and the list of keys
};

WindowView window_view(const LiveSession& session, const ViewState& view);

// A warning that the active model is outside its training domain; else empty.
std::string data_warning(const ModelsView& models);

// The big number and its description, of the selected model: its 99 % error of the test, as in the table, and its
// largest error in the press that is seen. Without a reference it is the predicted error.
struct BigNumber {
  std::string number{};  // "–": not known; empty: there is no model
  std::string what{}, below{};
  double error_over_jnd = 0.0, press_over_jnd = 0.0;  // above 1 they are drawn in kAboveJndColour
};
BigNumber big_number(const ModelsView& models);

std::string table_csv(const ModelsView& models);

}  // namespace palpate
