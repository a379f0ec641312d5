// The window program without its command line: a session, a window, and one
// frame after the other. Keys and mouse are demo_input.h, files demo_files.h.
//
// Thread guarantee: main thread only.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "rendering/app/demo_files.h"
#include "rendering/app/demo_input.h"
#include "rendering/app/window.h"
#include "rendering/panels/exhibit.h"
#include "rendering/panels/panel.h"
#include "rendering/panels/scene_overlay.h"
#include "rendering/panels/view_state.h"
#include "rendering/picture/block_view.h"
#include "rendering/picture/resolution.h"
#include "rendering/ui/ui_context.h"
#include "rendering/ui/ui_style.h"
#include "scenes/live/live_session.h"

namespace palpate {

struct DemoRequest {
  SessionRequest session;
  WindowRequest window;
  bool exhibit = false;  // a game for visitors in place of the panel
  ExhibitTimes exhibit_times;
  std::string settings_file;            // empty: nothing is remembered
  std::vector<std::string> recordings;  // offered to be trained or tested on
};

class DemoApp {
 public:
  // Errors: those of LiveSession::open and Window::open, a broken shader.
  static Result<std::unique_ptr<DemoApp>> create(const DemoRequest& request);
  DemoApp(const DemoApp&) = delete;
  DemoApp& operator=(const DemoApp&) = delete;
  ~DemoApp();

  // Events, session, picture, panel; shows it and waits for the next frame's time.
  void frame();
  bool closing() const noexcept;
  void close();
  // Why it ended by itself: no session could be opened any more, and there is none.
  const Status& outcome() const noexcept { return outcome_; }
  // Draws the present state once more and saves it.
  Status screenshot(const std::string& path, bool overwrite);

  LiveSession& session() noexcept { return *session_; }
  ViewState& view() noexcept { return view_; }
  const WindowView& shown() const noexcept { return shown_; }  // in the last frame
  const Exhibit& exhibit() const noexcept { return exhibit_; }
  const BlockView& blocks() const noexcept { return *blocks_; }
  const FrameFigures& frames() const noexcept { return frames_; }
  const std::vector<Toast>& toasts() const noexcept { return toasts_; }
  Window& window() noexcept { return *window_; }

  // What events do; GLFW's callbacks call them. A key counts even when it was
  // pressed and let go within a frame. `action`: of GLFW.
  // Model files (.json) are loaded; all else is offered to be trained or tested on, as
  // recordings or as other programs' tables.
  void drop_files(const std::vector<std::string>& paths);
  void handle_key_event(int key, int action, int modifiers);
  // All that can be asked for, a row each; an exhibit has buttons of its own.
  std::vector<WindowCommand>& commands() noexcept { return commands_; }

 private:
  DemoApp() = default;
  Status set_up(const DemoRequest& request);
  void listen();
  std::vector<WindowCommand> make_commands();
  void handle_keys();
  void handle_exhibit_key(const KeyPress& press);
  void close_windows();
  void select_listed(std::size_t number);
  void pause_or_run();
  void next_block_count();
  void scroll_curves(double by_s);
  void seek_replay(double by_s);
  void read_notices(double now_s);
  void draw();
  void draw_blocks();
  void count_frame(double now_s);
  std::vector<BlockPose> block_poses() const;
  std::vector<BlockPose> true_poses() const;  // not deeper than they are
  BlockPose model_pose(std::size_t slot, BlockPose pose) const;
  BlockPose reference_pose(BlockPose pose) const;
  SceneArea scene_area() const;
  Status set_up_exhibit(const ExhibitTimes& times);
  void notify(std::string text, bool problem);
  void look();
  // Another session in place of this one, after this frame.
  void use_material(const std::string& scene, const std::vector<std::string>& recordings, const std::string& device);
  void use_device(const std::string& device);  // for the same models
  void start_offer();
  void use_line_up(const LineUp& line_up);
  void reopen(const SessionRequest& request);
  void next_line_up();
  void next_reference();
  void next_dead_man();

  // What lies on the window goes before it.
  std::unique_ptr<Window> window_;
  std::unique_ptr<LiveSession> session_;
  std::unique_ptr<BlockView> blocks_;
  std::unique_ptr<UiContext> ui_;
  UiStyle style_;
  SidePanel panel_;
  SceneOverlay overlay_;
  Exhibit exhibit_{1};
  ViewState view_;
  WindowView shown_;
  DemoInput input_;
  DemoFiles files_{view_, [this](std::string text, bool problem) { notify(std::move(text), problem); }};
  SessionRequest request_;
  std::string first_device_;            // as the program was asked for it
  std::optional<SessionRequest> next_;  // what to go on with after this frame
  FrameFigures frames_;
  Resolution resolution_;
  std::vector<Toast> toasts_;
  std::vector<WindowCommand> commands_;
  double frame_began_s_ = 0.0;
  double frame_s_ = 0.0;       // since the frame before, at most a tenth of a second
  double last_frame_s_ = 0.0;  // its end
  double second_began_s_ = 0.0;
  std::uint64_t frames_this_second_ = 0;
  std::size_t blocks_framed_ = 1;
  bool leaving_ = false;  // an exhibit's only way out
  Status outcome_;
};

}  // namespace palpate
