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
constexpr double kKeyStep_m = 0.0003;  // a frame, while held
// The probe moves a third as far as the mouse does on the picture: a block is
// pressed by millimetres, and a hand holds a mouse no finer than a few pixels.
constexpr float kMouseGain = 0.33F;
constexpr double kScrollStep_s = 0.1;
constexpr double kSeekStep_s = 2.0;
constexpr double kSpeedStep = 1.25;
constexpr float kClick_px = 4.0F;

constexpr std::pair<int, Command> kCommandKeys[] = {{GLFW_KEY_N, Command::next_line_up},
                                                    {GLFW_KEY_X, Command::exaggerate},
                                                    {GLFW_KEY_O, Command::scene_list},
                                                    {GLFW_KEY_H, Command::help},
                                                    {GLFW_KEY_SLASH, Command::help},
                                                    {GLFW_KEY_B, Command::next_block_count},
                                                    {GLFW_KEY_SPACE, Command::pause_curves},
                                                    {GLFW_KEY_C, Command::reset_figures},
                                                    {GLFW_KEY_V, Command::difference},
                                                    {GLFW_KEY_F, Command::next_reference},
                                                    {GLFW_KEY_R, Command::record},
                                                    {GLFW_KEY_M, Command::file_list},
                                                    {GLFW_KEY_L, Command::details},
                                                    {GLFW_KEY_T, Command::theme},
                                                    {GLFW_KEY_Z, Command::zero},
                                                    {GLFW_KEY_D, Command::dead_man},
                                                    {GLFW_KEY_S, Command::save_curves},
                                                    {GLFW_KEY_HOME, Command::home_view},
                                                    {GLFW_KEY_EQUAL, Command::larger_text},
                                                    {GLFW_KEY_KP_ADD, Command::larger_text},
                                                    {GLFW_KEY_MINUS, Command::smaller_text},
                                                    {GLFW_KEY_KP_SUBTRACT, Command::smaller_text},
                                                    {GLFW_KEY_F11, Command::fullscreen}};

void scroll_back(const LiveSession& session, ViewState& view, double by_s) {
  if (session.comparison().history().size() > 0) view.time.scroll_back(by_s, session.comparison().history()[0].loop_time_s);
}

}  // namespace

void DemoApp::press_key(int key, int modifiers) { keys_.push_back({key, modifiers}); }

void DemoApp::nudge_tool(double by_m) {
  ToolInput* tool = session_->mouse();
  const double at_m = session_->newest().tick.position_m;
  if (tool != nullptr && (by_m < 0.0 || limited_depth_m(at_m + by_m) > at_m)) tool->nudge(by_m, steady_now_s());
}

void DemoApp::handle_keys() {
  if (ImGui::GetIO().WantTextInput) {  // somebody types a name
    keys_.clear();
    return;
  }
  if (ImGui::IsKeyDown(GLFW_KEY_DOWN)) nudge_tool(kKeyStep_m);
  if (ImGui::IsKeyDown(GLFW_KEY_UP)) nudge_tool(-kKeyStep_m);
  if (ImGui::IsKeyDown(GLFW_KEY_G) && session_->dead_man() == DeadMan::key) session_->hold();
  if (ImGui::IsKeyDown(GLFW_KEY_LEFT)) scroll_back(*session_, view_, kScrollStep_s);
  if (ImGui::IsKeyDown(GLFW_KEY_RIGHT)) scroll_back(*session_, view_, -kScrollStep_s);
  for (const KeyPress& press : std::exchange(keys_, {})) handle_key(press);
  // The next visitor finds it as new.
  if (view_.kiosk && open_day_.update(*session_, view_)) blocks_->camera().go_home();
}

void DemoApp::handle_key(const KeyPress& press) {
  if ((press.modifiers & GLFW_MOD_CONTROL) != 0) {
    const bool chord = (press.modifiers & GLFW_MOD_SHIFT) != 0;
    if (press.key == GLFW_KEY_Q && (chord || !view_.kiosk)) close();
    return;
  }
  if (view_.kiosk) {
    open_day_.press_key(press.key, *session_, view_);
    return;
  }
  for (const auto& [key, command] : kCommandKeys) {
    if (press.key == key) run(command);
  }
  const std::vector<std::size_t> listed = models_view(*session_).listed();
  const auto number = static_cast<std::size_t>(press.key - GLFW_KEY_1);
  if (press.key >= GLFW_KEY_1 && press.key <= GLFW_KEY_9 && number < listed.size()) session_->select(listed[number]);
  if (press.key == GLFW_KEY_ESCAPE) close_windows();
  if (session_->replay() != nullptr) replay_key(press.key);
}

void DemoApp::close_windows() {
  view_.help = view_.file_list = view_.details = view_.scene_list = false;
  view_.offered_recording.clear();
}

void DemoApp::replay_key(int key) {
  ReplayControl& replay = *session_->replay();
  switch (key) {
    case GLFW_KEY_P:
      replay.pause(!replay.paused());
      break;
    case GLFW_KEY_LEFT_BRACKET:
      replay.seek(std::max(0.0, replay.playhead_s() - kSeekStep_s));
      break;
    case GLFW_KEY_RIGHT_BRACKET:
      replay.seek(replay.playhead_s() + kSeekStep_s);
      break;
    case GLFW_KEY_COMMA:
      replay.set_speed(replay.speed() / kSpeedStep);
      break;
    case GLFW_KEY_PERIOD:
      replay.set_speed(replay.speed() * kSpeedStep);
      break;
    default:
      break;
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
  if (!over_scene) return;
  if (wheel_ != 0.0F) {
    if (io.KeyCtrl) {
      blocks_->camera().zoom(std::pow(kZoom_per_step, wheel_));
    } else {
      nudge_tool(-kWheelStep_m * static_cast<double>(wheel_));
    }
  }
  if (!view_.kiosk && ImGui::IsMouseReleased(ImGuiMouseButton_Left) &&
      io.MouseDragMaxDistanceSqr[ImGuiMouseButton_Left] < kClick_px * kClick_px) {
    if (const auto slot = overlay_.slot_at(*session_, *blocks_, view_, area, io.MousePos))
      session_->select(*slot);
  }
  if (io.MouseDelta.x != 0.0F || io.MouseDelta.y != 0.0F) move_tool_to_mouse();
}

void DemoApp::move_tool_to_mouse() {
  ToolInput* tool = session_->mouse();
  if (tool == nullptr) return;
  const SceneArea area = scene_area();
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const glm::vec2 size(area.size.x, area.size.y);
  const std::vector<std::size_t> slots = shown_slots(*session_, view_.block_count);
  const std::size_t count = std::max<std::size_t>(slots.size(), 1);
  const auto over = overlay_.slot_at(*session_, *blocks_, view_, area, mouse);
  if (!over && !slots.empty()) return;
  const auto at = std::find(slots.begin(), slots.end(), over.value_or(0));
  const auto index = static_cast<std::size_t>(at == slots.end() ? 0 : at - slots.begin());
  const glm::vec2 surface = blocks_->on_screen(index, count, {0.0F, 0.0F, 0.0F}, size);
  const float below_px = mouse.y - area.at.y - surface.y;
  const auto requested_m = static_cast<double>(kMouseGain * below_px * blocks_->depth_per_pixel(index, count, size));
  tool->set_target(limited_depth_m(requested_m), steady_now_s());
}

}  // namespace palpate
