// Keyboard and mouse of the window: keys run rows of the table of commands, the mouse
// moves the tool and the view.
//
// Thread guarantee: main thread only.
#pragma once

#include <vector>

#include "rendering/panels/scene_overlay.h"

namespace palpate {

struct KeyPress {
  int key = 0;  // GLFW's
  int modifiers = 0;
  bool again = false;  // the keyboard repeats it
};

// Where the tool rests in the air while nobody presses.
inline constexpr double kRest_m = -0.008;

// As deep as there are data, and softly a little beyond.
double limited_depth_m(const LiveSession& session, double requested_m);
// So far in; a mouse only.
void nudge_tool(const LiveSession& session, double by_m);

class DemoInput {
 public:
  // A key counts even when it was pressed and let go within a frame. `action`: of GLFW.
  void add_key(int key, int action, int modifiers);
  // Since the last call.
  std::vector<KeyPress> take_keys();
  void let_go();
  // Those that are held; `replays`: those of a replay too.
  void run_held(const std::vector<WindowCommand>& commands, bool replays) const;
  static void run(const KeyPress& press, const std::vector<WindowCommand>& commands, bool replays);

  // Inside a frame: its end forgets the wheel.
  void keep_wheel();
  // Whether the mouse has just left the picture, and the tool let go.
  bool handle_mouse(LiveSession& session, const WindowView& shown, BlockView& blocks, const ViewState& view,
                    const SceneArea& area);

 private:
  std::vector<KeyPress> keys_;
  std::vector<int> down_;  // keys that are held
  float wheel_ = 0.0F;
  bool orbiting_ = false;
  bool over_scene_ = false;  // in the frame before
};

}  // namespace palpate
