// The window program without its command line: a session, a window, and the work of a frame. demo_frame.cpp draws,
// demo_input.cpp has keys and mouse, demo_commands.cpp the table of commands, demo_files.cpp files.
// Thread guarantee: main thread only.
#pragma once

#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "rendering/app/window.h"
#include "rendering/panels/exhibit.h"
#include "rendering/panels/panel.h"
#include "rendering/picture/block_view.h"
#include "rendering/ui/ui.h"
#include "scenes/live/live_session.h"
#include "scenes/live/session_recorder.h"
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
  void save_settings();

  // Call it once a frame: processes finished background work and recordings.
  void update(const LiveSession& session);
  // Calls `open_recording` for a file with an extension other than .json; loads any other file as a model.
  void open(const std::string& path, LiveSession& session);
  // Reads a recording or another program's table in the background, then asks whether to train or to test on it.
  void open_recording(const std::string& path);
  void record(LiveSession& session);
  void save_curves(const LiveSession& session, const WindowView& shown, const CurveColumns& columns);
  void save_table(const WindowView& shown);
  std::string picture_path() { return new_path("/picture-%Y%m%d-%H%M%S", ".png"); }
  void save_model(const LiveSession& session);
  void look_for_devices();
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
  // Saves `what` with `write` to such a path, with a notice.
  void save(const std::string& what, const char* name, const char* extension,
            const std::function<Status(const std::string& path)>& write);

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

struct DemoRequest {
  SessionRequest session;
  WindowRequest window;
  bool exhibit = false;  // --kiosk: a game for visitors instead of the panel
  ExhibitTimes exhibit_times;
  std::string settings_file;            // empty: settings are neither read nor saved
  std::vector<std::string> recordings;  // files; the window asks whether to train or to test models on them
};

struct KeyPress {
  int key = 0;  // GLFW's
  int modifiers = 0;
  bool again = false;  // repeated by the keyboard
};

// Position in the air near the surface at which the key that moves the tool outwards stops it.
inline constexpr double kHover_m = -0.002;

class DemoApp {
 public:
  // Errors: those of LiveSession::open and Window::open, a broken shader.
  static Result<std::unique_ptr<DemoApp>> create(const DemoRequest& request);
  ~DemoApp();
  // Saves all that is to be saved and lets go of the device; then only the destructor may be called, which waits for
  // fits. A factorisation cannot be interrupted.
  void finish();

  // Processes events, updates the session, draws and shows a frame, and waits for the next one.
  void frame();
  bool closing() const noexcept;
  void close();
  // An error when the program closes by itself because no session could be opened.
  const Status& outcome() const noexcept { return outcome_; }
  // Completes a recording, removes the force and closes the device, without GLFW and OpenGL: for the loss of the
  // display. Returns the text of --stats.
  std::string end();
  // Draws the present state and saves it. Errors: those of Window::save_frame.
  Status screenshot(const std::string& path, bool overwrite);

  LiveSession& session() noexcept { return *session_; }
  ViewState& view() noexcept { return view_; }
  const WindowView& shown() const noexcept { return shown_; }  // of the last frame
  const Exhibit& exhibit() const noexcept { return exhibit_; }
  const BlockView& blocks() const noexcept { return *blocks_; }
  Window& window() noexcept { return *window_; }

  // GLFW's callbacks call these. Dropped files: see DemoFiles::open. A key counts even when it was pressed and released
  // within a frame. `action`: of GLFW.
  void drop_files(const std::vector<std::string>& paths);
  void handle_key_event(int key, int action, int modifiers);
  // An input of any kind, after which the texts are drawn in every frame for a moment.
  void note_input();
  // The table of commands. An exhibit has its own buttons.
  std::vector<WindowCommand>& commands() noexcept { return commands_; }

 private:
  DemoApp() = default;
  Status set_up(const DemoRequest& request);
  void listen();
  std::vector<WindowChoice> choices();
  std::vector<WindowCommand> make_commands();
  void handle_keys();
  void run_commands(const std::vector<KeyPress>& keys);
  void run_held(const std::vector<KeyPress>& pressed, bool in_list) const;
  void run_pressed(const KeyPress& press, bool in_list) const;
  bool runs(const WindowCommand& command, int key, bool in_list) const;
  bool press_focused(const KeyPress& press);
  void handle_exhibit_key(const KeyPress& press);
  bool is_down(int key) const;
  std::vector<int> tapped() const;
  void drive_tool();
  void handle_mouse();
  void lift_tool();
  void begin_stroke(const ImVec2& mouse);
  void follow_stroke();
  void hover_block(const ImVec2& mouse);
  double limited_depth_m(double requested_m) const;
  std::optional<std::size_t> block_at(const ImVec2& point) const;
  std::size_t block_count() const { return std::max<std::size_t>(shown_.blocks.size(), 1); }
  void close_windows();
  void select_listed(std::size_t number);
  void use_block_count(std::size_t wanted);
  void use_line_up(const LineUp& line_up);
  void use_worst(std::size_t slot);
  void leave_worst();
  void stop_or_go_on();
  WindowActions make_actions();
  void read_notices();
  bool needs_texts(double now_s);
  void draw(bool texts);
  void draw_texts();
  void draw_blocks(bool new_texts);
  std::vector<BlockPose> block_poses() const;
  BlockPose model_pose(std::size_t slot, BlockPose pose) const;
  BlockPose reference_pose(BlockPose pose) const;
  Status set_up_exhibit(const ExhibitTimes& times);
  void notify(std::string text, bool problem);
  void look();
  // Replace the session after this frame.
  void use_material(const std::string& scene, const std::vector<std::string>& recordings, const std::string& device);
  void use_device(const std::string& device);  // keeps the models
  void use_recording_roles();
  void reopen(const SessionRequest& request);

  // The first member, because those that draw into it have to be destroyed before it.
  std::unique_ptr<Window> window_;
  std::unique_ptr<LiveSession> session_;
  std::unique_ptr<BlockView> blocks_;
  std::unique_ptr<UiContext> ui_;
  UiStyle style_;
  ForceCurves curves_;
  Exhibit exhibit_;
  ViewState view_;
  WindowView shown_;
  std::vector<KeyPress> keys_;   // since the last frame
  std::vector<int> down_;        // keys that are held
  bool drives_ = false;          // a key moved the tool in the frame before
  double driven_until_s_ = 0.0;  // at least, by a tap of a key; steady clock
  bool orbiting_ = false;
  // One stroke of the pointer is one press of the block where it began, until the button is released.
  struct Stroke {
    std::size_t block = 0;
    float from_px = 0.0F;  // y at depth 0
    bool hovers = false;   // without a button, in an exhibit
  };
  std::optional<Stroke> stroke_;
  ImVec2 mouse_{-1.0F, -1.0F};
  DemoFiles files_{view_, [this](std::string text, bool problem) { notify(std::move(text), problem); }};
  SessionRequest request_;
  std::string first_device_;            // of the command line
  std::optional<SessionRequest> next_;  // the session to open after this frame
  std::vector<WindowCommand> commands_;
  WindowActions actions_;
  double key_velocity_m_per_s_ = 0.0;  // of the tool by the keys of this frame, positive inwards
  WindowLayout layout_;
  Pixels panel_{false};          // the picture of the panel
  bool panel_waits_ = false;     // it is drawn in the next frame
  double texts_due_s_ = 0.0;     // when the texts are drawn next
  double lively_until_s_ = 0.0;  // until then they are drawn in every frame
  bool no_model_ = true;         // in the last frame
  std::string picture_;          // a file for the picture of the next frame; empty: none
  double last_frame_s_ = 0.0;    // end of the last frame
  bool leaving_ = false;         // `close` was called; an exhibit ends only by it
  Status outcome_;
};

}  // namespace palpate
