// The window program without its command line: a session, a window, and the work of a frame. demo_frame.cpp draws,
// demo_input.cpp has keys and mouse, demo_commands.cpp the table of commands, demo_files.h files.
// Thread guarantee: main thread only.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "rendering/app/demo_files.h"
#include "rendering/app/window.h"
#include "rendering/panels/exhibit.h"
#include "rendering/panels/panel.h"
#include "rendering/panels/scene_overlay.h"
#include "rendering/panels/view_state.h"
#include "rendering/picture/block_view.h"
#include "rendering/ui/ui_context.h"
#include "rendering/ui/ui_style.h"
#include "scenes/live/live_session.h"

namespace palpate {

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
  void handle_exhibit_key(const KeyPress& press);
  bool is_down(int key) const;
  std::vector<int> tapped() const;
  void drive_tool();
  void handle_mouse();
  bool follow_mouse(const ImVec2& mouse);
  void move_tool_to(const ImVec2& mouse);
  double limited_depth_m(double requested_m) const;
  std::optional<std::size_t> block_at(const ImVec2& point, bool aimed) const;
  void close_windows();
  void select_listed(std::size_t number);
  void use_block_count(std::size_t wanted);
  void use_line_up(const LineUp& line_up);
  void read_notices(double now_s);
  bool needs_texts(double now_s);
  void draw(bool texts);
  void draw_texts();
  std::vector<Viewport> draw_blocks();
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
  bool over_scene_ = false;  // the mouse, in the frame before
  ImVec2 mouse_{-1.0F, -1.0F};
  DemoFiles files_{view_, [this](std::string text, bool problem) { notify(std::move(text), problem); }};
  SessionRequest request_;
  std::string first_device_;            // of the command line
  std::optional<SessionRequest> next_;  // the session to open after this frame
  std::vector<WindowCommand> commands_;
  double key_velocity_m_per_s_ = 0.0;  // of the tool by the keys of this frame, positive inwards
  WindowLayout layout_;
  double texts_due_s_ = 0.0;       // when the texts are drawn next
  double lively_until_s_ = 0.0;    // until then they are drawn in every frame
  std::vector<Viewport> changed_;  // parts of the window in this frame
  bool no_model_ = true;           // in the last frame
  bool everything_ = true;         // the next frame draws all of the window
  double frame_began_s_ = 0.0;
  double last_frame_s_ = 0.0;  // end of the last frame
  bool leaving_ = false;       // `close` was called; an exhibit ends only by it
  Status outcome_;
};

}  // namespace palpate
