// Keyboard and mouse of the window: keys run commands, the mouse moves the tool and the camera.
// Thread guarantee: main thread only.
#pragma once

#include <vector>

#include "rendering/panels/scene_overlay.h"

namespace palpate {

struct KeyPress {
  int key = 0;  // GLFW's
  int modifiers = 0;
  bool again = false;  // repeated by the keyboard
};

// The state that decides which keys have an effect in this frame.
struct KeyContext {
  bool replays = false;  // a recording is replayed, see WindowCommand::replay
  bool in_list = false;  // a list or menu is open, which takes the keys that move through it
};

// Position in the air near the surface at which the key that moves the tool outwards stops it.
inline constexpr double kHover_m = -0.002;

class DemoInput {
 public:
  // A key counts even when it was pressed and released within a frame. `action`: of GLFW.
  void add_key(int key, int action, int modifiers);
  // Returns and clears the keys that were pressed since the last call.
  std::vector<KeyPress> take_keys();
  // Forgets all keys, also those that are held.
  void let_go();
  // The keys that were pressed and released since the last call of take_keys.
  std::vector<int> tapped() const;
  // Runs the commands whose keys are held, or were pressed. A held command runs at least once for each press in
  // `pressed`, even if the key was released within a slow frame.
  void run_held(const std::vector<KeyPress>& pressed, const std::vector<WindowCommand>& commands,
                const KeyContext& context) const;
  static void run(const KeyPress& press, const std::vector<WindowCommand>& commands, const KeyContext& context);

  // Call it once a frame with the velocity of the held keys, positive inwards; 0: none is held. The loop then moves the
  // tool, inwards up to 8 % beyond the trained depth, outwards up to kHover_m.
  void drive_tool(const LiveSession& session, double velocity_m_per_s);

  // Call it within a frame, because ImGui clears the motion of the wheel at its end. Returns whether the mouse has just
  // left the picture, so that the tool was lifted.
  bool handle_mouse(LiveSession& session, const WindowView& shown, BlockView& blocks, const ViewState& view,
                    const SceneArea& area);
  // The same for a frame without texts, while only the mouse moves. Returns false, without an effect, if that is not
  // enough: a button or a key is held, or the mouse is not over the free part of the picture.
  bool follow_mouse(LiveSession& session, const WindowView& shown, const BlockView& blocks, const ViewState& view,
                    const SceneArea& area, const ImVec2& mouse);

 private:
  bool is_down(int key) const;

  std::vector<KeyPress> keys_;
  std::vector<int> down_;  // keys that are held
  bool drives_ = false;    // a key moved the tool in the frame before
  bool orbiting_ = false;
  bool over_scene_ = false;  // in the frame before
  ImVec2 mouse_{-1.0F, -1.0F};
};

}  // namespace palpate
