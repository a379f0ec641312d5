// Keyboard and mouse of the window.
#include <epoxy/gl.h>
// After epoxy, which brings OpenGL's functions.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "rendering/app/demo_app.h"

namespace palpate {
namespace {

constexpr float kOrbit_rad_per_px = 0.006F;
constexpr float kZoom_per_step = 0.9F;
constexpr double kWheelStep_m = 0.0005;
// The probe moves a third as far as the mouse does on the picture: a block is
// pressed by millimetres, and a hand holds a mouse no finer than a few pixels.
constexpr float kMouseGain = 0.33F;
constexpr float kClick_px = 4.0F;

}  // namespace

void DemoApp::handle_key_event(int key, int action, int modifiers) {
  stirred_ = true;
  std::erase(down_, key);
  if (view_.exhibit && action == GLFW_RELEASE && key == GLFW_KEY_DOWN) Exhibit::let_go(*session_);
  if (action == GLFW_RELEASE) return;
  down_.push_back(key);
  keys_.push_back({key, modifiers, action == GLFW_REPEAT});
}

void DemoApp::handle_keys() {
  if (ImGui::GetIO().WantTextInput) {  // somebody types a name
    for (const KeyPress& press : keys_)
      if (press.key == GLFW_KEY_ESCAPE) close_windows();
    keys_.clear();
    down_.clear();
    return;
  }
  run_held();
  for (const KeyPress& press : std::exchange(keys_, {})) handle_key(press);
  // The next visitor finds it as new.
  if (view_.exhibit && exhibit_.update(*session_, view_)) blocks_->camera().go_home();
}

void DemoApp::run_held() {
  for (const WindowCommand& command : commands_) {
    if (command.when != WindowCommand::When::held) continue;
    for (std::size_t i = 0; i < command.keys.size(); ++i) {
      if (std::find(down_.begin(), down_.end(), command.keys[i]) != down_.end()) command.run(i);
    }
  }
}

void DemoApp::handle_key(const KeyPress& press) {
  const bool control = (press.modifiers & GLFW_MOD_CONTROL) != 0;
  if (view_.exhibit) {
    const bool chord = control && (press.modifiers & GLFW_MOD_SHIFT) != 0;
    if (chord && press.key == GLFW_KEY_Q) close();
    if (chord && press.key == GLFW_KEY_T) exhibit_.show_host(!exhibit_.shows_host());
    if (press.key == GLFW_KEY_Z && session_->newest().device.zeroing == Zeroing::needed) session_->start_zeroing();
    if (!control && !press.again) exhibit_.press_key(press.key, *session_);
    return;
  }
  for (const WindowCommand& command : commands_) {
    const auto key = std::find(command.keys.begin(), command.keys.end(), press.key);
    if (key == command.keys.end() || command.control != control) continue;
    if (command.replay && session_->replay() == nullptr) continue;
    const bool wanted =
        command.when == WindowCommand::When::repeated || (command.when == WindowCommand::When::pressed && !press.again);
    if (wanted) command.run(static_cast<std::size_t>(key - command.keys.begin()));
  }
}

void DemoApp::handle_mouse() {
  const ImGuiIO& io = ImGui::GetIO();
  const SceneArea area = scene_area();
  const bool over_scene = area.holds(io.MousePos) && !io.WantCaptureMouse;
  if (ImGui::IsMouseClicked(ImGuiMouseButton_Right) && over_scene) orbiting_ = true;
  if (!ImGui::IsMouseDown(ImGuiMouseButton_Right)) orbiting_ = false;
  if (orbiting_) {
    blocks_->camera().orbit(-kOrbit_rad_per_px * io.MouseDelta.x, kOrbit_rad_per_px * io.MouseDelta.y);
    return;
  }
  // A finger that leaves the screen lets go.
  if (view_.exhibit && ImGui::IsMouseReleased(ImGuiMouseButton_Left)) Exhibit::let_go(*session_);
  if (!over_scene) return;
  if (wheel_ != 0.0F) {
    if (io.KeyCtrl) {
      blocks_->camera().zoom(std::pow(kZoom_per_step, wheel_));
    } else {
      nudge_tool(-kWheelStep_m * static_cast<double>(wheel_));
    }
  }
  if (!view_.exhibit && ImGui::IsMouseReleased(ImGuiMouseButton_Left) &&
      io.MouseDragMaxDistanceSqr[ImGuiMouseButton_Left] < kClick_px * kClick_px) {
    if (const auto slot = overlay_.slot_at(*session_, *blocks_, view_, area, io.MousePos)) session_->select(*slot);
  }
  const bool touched = view_.exhibit && ImGui::IsMouseClicked(ImGuiMouseButton_Left);  // twice at the same place
  if (io.MouseDelta.x != 0.0F || io.MouseDelta.y != 0.0F || touched) move_tool_to_mouse();
}

void DemoApp::move_tool_to_mouse() {
  ToolInput* tool = session_->mouse();
  if (tool == nullptr || view_.tool_is_held) return;
  const SceneArea area = scene_area();
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const glm::vec2 size(area.size.x, area.size.y);
  const std::vector<std::size_t> slots = shown_slots(*session_, view_.block_count);
  const std::size_t count = std::max<std::size_t>(slots.size(), 1);
  const auto over = overlay_.slot_at(*session_, *blocks_, view_, area, mouse);
  if (!over && !slots.empty() && !view_.exhibit) return;  // a visitor need not aim
  const auto at = std::find(slots.begin(), slots.end(), over.value_or(0));
  const auto index = static_cast<std::size_t>(at == slots.end() ? 0 : at - slots.begin());
  const glm::vec2 surface = blocks_->on_screen(index, count, {0.0F, 0.0F, 0.0F}, size);
  const float below_px = mouse.y - area.at.y - surface.y;
  const auto requested_m = static_cast<double>(kMouseGain * below_px * blocks_->depth_per_pixel(index, count, size));
  tool->set_target(limited_depth_m(requested_m), steady_now_s());
}

}  // namespace palpate
