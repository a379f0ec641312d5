// Keyboard and mouse of the window.
#include <epoxy/gl.h>
// After epoxy, which brings OpenGL's functions.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/live/pacer.h"
#include "rendering/app/demo_input.h"
#include "rendering/panels/exhibit.h"

namespace palpate {
namespace {

constexpr float kOrbit_rad_per_px = 0.006F;
constexpr float kZoom_per_step = 0.9F;
constexpr double kWheelStep_m = 0.0005;
// The probe moves a third as far as the mouse does on the picture: a block is
// pressed by millimetres, and a hand holds a mouse no finer than a few pixels.
constexpr float kMouseGain = 0.33F;
constexpr float kClick_px = 4.0F;

void move_tool_to_mouse(LiveSession& session, const BlockView& blocks, const SceneOverlay& overlay,
                        const ViewState& view, const SceneArea& area) {
  ToolInput* tool = session.mouse();
  if (tool == nullptr || view.tool_is_held) return;
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const glm::vec2 size(area.size.x, area.size.y);
  const std::vector<std::size_t> slots = shown_slots(session, view.block_count);
  const std::size_t count = std::max<std::size_t>(slots.size(), 1);
  const auto over = overlay.slot_at(session, blocks, view, area, mouse);
  if (!over && !slots.empty() && !view.exhibit) return;  // a visitor need not aim
  const auto at = std::find(slots.begin(), slots.end(), over.value_or(0));
  const auto index = static_cast<std::size_t>(at == slots.end() ? 0 : at - slots.begin());
  const glm::vec2 surface = blocks.on_screen(index, count, {0.0F, 0.0F, 0.0F}, size);
  const float below_px = mouse.y - area.at.y - surface.y;
  const auto requested_m = static_cast<double>(kMouseGain * below_px * blocks.depth_per_pixel(index, count, size));
  tool->set_target(limited_depth_m(session, requested_m), steady_now_s());
}

}  // namespace

double limited_depth_m(const LiveSession& session, double requested_m) {
  constexpr double kMargin = 0.08;  // of that depth
  const double known_m = session.models().trained_depth_m();
  if (requested_m <= known_m) return requested_m;
  const double margin_m = kMargin * known_m;
  return known_m + margin_m * (1.0 - std::exp((known_m - requested_m) / margin_m));
}

void nudge_tool(const LiveSession& session, double by_m) {
  ToolInput* tool = session.mouse();
  const double at_m = session.newest().tick.position_m;
  if (tool != nullptr && (by_m < 0.0 || limited_depth_m(session, at_m + by_m) > at_m))
    tool->nudge(by_m, steady_now_s());
}

void DemoInput::add_key(int key, int action, int modifiers) {
  std::erase(down_, key);
  if (action == GLFW_RELEASE) return;
  down_.push_back(key);
  keys_.push_back({key, modifiers, action == GLFW_REPEAT});
}

std::vector<KeyPress> DemoInput::take_keys() { return std::exchange(keys_, {}); }

void DemoInput::let_go() {
  keys_.clear();
  down_.clear();
}

void DemoInput::run_held(const std::vector<WindowCommand>& commands, bool replays) const {
  for (const WindowCommand& command : commands) {
    if (command.when != WindowCommand::When::held || (command.replay && !replays)) continue;
    for (std::size_t i = 0; i < command.keys.size(); ++i) {
      if (std::find(down_.begin(), down_.end(), command.keys[i]) != down_.end()) command.run(i);
    }
  }
}

void DemoInput::run(const KeyPress& press, const std::vector<WindowCommand>& commands, bool replays) {
  const bool control = (press.modifiers & GLFW_MOD_CONTROL) != 0;
  for (const WindowCommand& command : commands) {
    const auto key = std::find(command.keys.begin(), command.keys.end(), press.key);
    if (key == command.keys.end() || command.control != control) continue;
    if (command.replay && !replays) continue;
    const bool wanted =
        command.when == WindowCommand::When::repeated || (command.when == WindowCommand::When::pressed && !press.again);
    if (wanted) command.run(static_cast<std::size_t>(key - command.keys.begin()));
  }
}

void DemoInput::keep_wheel() { wheel_ = ImGui::GetIO().MouseWheel; }

void DemoInput::handle_mouse(LiveSession& session, BlockView& blocks, const SceneOverlay& overlay,
                             const ViewState& view, const SceneArea& area) {
  const ImGuiIO& io = ImGui::GetIO();
  const bool over_scene = area.holds(io.MousePos) && !io.WantCaptureMouse;
  if (ImGui::IsMouseClicked(ImGuiMouseButton_Right) && over_scene) orbiting_ = true;
  if (!ImGui::IsMouseDown(ImGuiMouseButton_Right)) orbiting_ = false;
  if (orbiting_) {
    blocks.camera().orbit(-kOrbit_rad_per_px * io.MouseDelta.x, kOrbit_rad_per_px * io.MouseDelta.y);
    return;
  }
  // A finger that leaves the screen lets go.
  if (view.exhibit && ImGui::IsMouseReleased(ImGuiMouseButton_Left)) Exhibit::let_go(session);
  if (!over_scene) return;
  if (wheel_ != 0.0F) {
    if (io.KeyCtrl) {
      blocks.camera().zoom(std::pow(kZoom_per_step, wheel_));
    } else {
      nudge_tool(session, -kWheelStep_m * static_cast<double>(wheel_));
    }
  }
  if (!view.exhibit && ImGui::IsMouseReleased(ImGuiMouseButton_Left) &&
      io.MouseDragMaxDistanceSqr[ImGuiMouseButton_Left] < kClick_px * kClick_px) {
    if (const auto slot = overlay.slot_at(session, blocks, view, area, io.MousePos)) session.select(*slot);
  }
  const bool touched = view.exhibit && ImGui::IsMouseClicked(ImGuiMouseButton_Left);  // twice at the same place
  if (io.MouseDelta.x != 0.0F || io.MouseDelta.y != 0.0F || touched)
    move_tool_to_mouse(session, blocks, overlay, view, area);
}

}  // namespace palpate
