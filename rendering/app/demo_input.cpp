// Keys and mouse: keys run commands, the mouse moves the tool and the camera.
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "engine/live/pacer.h"
#include "rendering/app/demo_app.h"

namespace palpate {
namespace {

constexpr float kOrbit_rad_per_px = 0.006F;
constexpr float kZoom_per_step = 0.9F;
constexpr double kWheelStep_m = 0.0005;
// The tool moves a third of the mouse's distance on the picture, because presses are millimetres deep and a hand moves
// a mouse with a precision of a few pixels.
constexpr float kMouseGain = 0.33F;
constexpr float kClick_px = 4.0F;
// The share of the distance from the surface to the lower edge at which the tool is at the largest trained depth.
constexpr float kReach = 0.8F;
constexpr CameraTurn kCloseUp{0.0F, 0.0F, 0.85F};  // of the reveal of an exhibit

}  // namespace

void DemoApp::handle_key_event(int key, int action, int modifiers) {
  if (view_.exhibit.on && action == GLFW_RELEASE && key == GLFW_KEY_DOWN) Exhibit::let_go(*session_);
  note_input();
  std::erase(down_, key);
  if (action == GLFW_RELEASE) return;
  down_.push_back(key);
  keys_.push_back({key, modifiers, action == GLFW_REPEAT});
}

void DemoApp::handle_keys() {
  const std::vector<KeyPress> keys = std::exchange(keys_, {});
  const auto escape = [](const KeyPress& press) { return press.key == GLFW_KEY_ESCAPE; };
  key_velocity_m_per_s_ = 0.0;
  const bool typing = ImGui::GetIO().WantTextInput;
  if (typing) {
    if (std::any_of(keys.begin(), keys.end(), escape)) close_windows();
    down_.clear();
  } else {
    run_commands(keys);
  }
  if (view_.exhibit.tool_is_held) key_velocity_m_per_s_ = 0.0;
  drive_tool();
  // The next visitor starts with the initial view.
  const bool was_close = view_.exhibit.close_up;
  if (view_.exhibit.on && exhibit_.update(*session_, view_)) blocks_->camera().go_home();
  if (view_.exhibit.close_up != was_close) blocks_->camera().turn(view_.exhibit.close_up ? kCloseUp : CameraTurn{});
}

void DemoApp::run_commands(const std::vector<KeyPress>& keys) {
  const bool menu = ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
  const bool in_list = menu || view_.dialogs.any();
  run_held(keys, in_list);
  for (const KeyPress& press : keys) view_.exhibit.on ? handle_exhibit_key(press) : run_pressed(press, in_list);
}

void DemoApp::handle_exhibit_key(const KeyPress& press) {
  const bool control = (press.modifiers & GLFW_MOD_CONTROL) != 0;
  const bool chord = control && (press.modifiers & GLFW_MOD_SHIFT) != 0;
  if (chord && press.key == GLFW_KEY_Q) close();
  if (chord && press.key == GLFW_KEY_T) exhibit_.toggle_host();
  if (press.key == GLFW_KEY_Z && session_->newest().device.zeroing == Zeroing::needed) session_->start_zeroing();
  if (!control && !press.again) exhibit_.press_key(press.key, *session_);
}

// Whether the key runs the command; not if ImGui uses it to move through an open list or to choose in it.
bool DemoApp::runs(const WindowCommand& command, int key, bool in_list) const {
  constexpr int kOfLists[] = {GLFW_KEY_UP,    GLFW_KEY_DOWN,      GLFW_KEY_LEFT, GLFW_KEY_RIGHT, GLFW_KEY_PAGE_UP,
                              GLFW_KEY_SPACE, GLFW_KEY_PAGE_DOWN, GLFW_KEY_HOME, GLFW_KEY_END,   GLFW_KEY_ENTER};
  if (command.replay && session_->replay() == nullptr) return false;
  return !in_list || std::ranges::find(kOfLists, key) == std::end(kOfLists);
}

bool DemoApp::is_down(int key) const { return std::ranges::find(down_, key) != down_.end(); }

// The keys that were pressed and released since the last frame.
std::vector<int> DemoApp::tapped() const {
  std::vector<int> tapped;
  for (const KeyPress& press : keys_)
    if (!is_down(press.key)) tapped.push_back(press.key);
  return tapped;
}

// Runs the commands whose keys are held, or were pressed. A held command runs at least once for each press, even if the
// key was released within a slow frame.
void DemoApp::run_held(const std::vector<KeyPress>& pressed, bool in_list) const {
  for (const WindowCommand& command : commands_) {
    if (command.when != WindowCommand::When::held) continue;
    for (std::size_t i = 0; i < command.keys.size(); ++i) {
      const int key = command.keys[i];
      const bool down = is_down(key) || std::ranges::find(pressed, key, &KeyPress::key) != pressed.end();
      if (down && runs(command, key, in_list)) command.run(i);
    }
  }
}

void DemoApp::run_pressed(const KeyPress& press, bool in_list) const {
  const bool control = (press.modifiers & GLFW_MOD_CONTROL) != 0;
  for (const WindowCommand& command : commands_) {
    const auto key = std::ranges::find(command.keys, press.key);
    if (key == command.keys.end() || command.control != control || !runs(command, press.key, in_list)) continue;
    if (command.when == WindowCommand::When::repeated || (command.when == WindowCommand::When::pressed && !press.again))
      command.run(static_cast<std::size_t>(key - command.keys.begin()));
  }
}

// The loop moves the tool with the velocity of the held keys, inwards up to 8 % beyond the trained depth, outwards up
// to kHover_m.
void DemoApp::drive_tool() {
  ToolInput* tool = session_->tool_input();
  // Without a key, the simulated hand and the mouse are left alone.
  if (tool == nullptr || (key_velocity_m_per_s_ == 0.0 && !drives_)) return;
  // After a late frame the next one follows at once, so a tap of a key drives for at least three quarters of a frame.
  // With a whole frame, the jitter of the frames would make it last one frame or two.
  const double now_s = steady_now_s();
  if (key_velocity_m_per_s_ == 0.0 && now_s < driven_until_s_) return;
  if (!drives_) driven_until_s_ = now_s + 0.75 / 60.0;
  drives_ = key_velocity_m_per_s_ != 0.0;
  constexpr double kFar_m = 1.0;
  const double limit_m = key_velocity_m_per_s_ > 0.0 ? limited_depth_m(kFar_m) : kHover_m;
  tool->drive(key_velocity_m_per_s_, limit_m, now_s);
}

// Limits a depth smoothly to 8 % beyond the depth up to which the models were trained.
double DemoApp::limited_depth_m(double requested_m) const {
  constexpr double kMargin = 0.08;  // of the trained depth
  const double known_m = session_->models().trained_depth_m();
  if (requested_m <= known_m) return requested_m;
  const double margin_m = kMargin * known_m;
  return known_m + margin_m * (1.0 - std::exp((known_m - requested_m) / margin_m));
}

// Index in WindowView::blocks of the block nearest to `point`. With `aimed`: empty unless the point is on or near it.
std::optional<std::size_t> DemoApp::block_at(const ImVec2& point, bool aimed) const {
  const SceneArea& area = layout_.scene;
  const std::size_t count = std::max<std::size_t>(shown_.blocks.size(), 1);
  const glm::vec3 half_m = 0.5F * blocks_->size_m();
  const glm::vec2 size(area.size.x, area.size.y);
  float nearest_px = 1e9F;
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec2 middle = blocks_->on_screen(i, count, {0.0F, -half_m.y, 0.0F}, size);
    const glm::vec2 side = blocks_->on_screen(i, count, {half_m.x, 0.0F, 0.0F}, size);
    const float away = std::hypot(area.at.x + middle.x - point.x, area.at.y + middle.y - point.y);
    if ((aimed && away > 1.25F * glm::length(side - middle)) || away > nearest_px) continue;
    nearest_px = away;
    found = i;
  }
  return found;
}

// Once the mouse was over a block, it moves the tool in all of the picture, so that a fast move beyond the block still
// presses. The full trained depth is within reach above the lower edge.
void DemoApp::move_tool_to(const ImVec2& mouse) {
  ToolInput* tool = session_->tool_input();
  if (tool == nullptr || view_.exhibit.tool_is_held) return;
  const bool aimed = tool->hand_is_exploring() && !view_.exhibit.on;  // a visitor can begin anywhere
  const auto index = block_at(mouse, aimed);
  if (!index) return;
  const SceneArea& area = layout_.scene;
  const glm::vec2 size(area.size.x, area.size.y);
  const std::size_t count = std::max<std::size_t>(shown_.blocks.size(), 1);
  const float surface_px = blocks_->on_screen(*index, count, {0.0F, 0.0F, 0.0F}, size).y;
  const double below_px = mouse.y - area.at.y - surface_px;
  const double room_px = std::max(1.0, static_cast<double>(kReach * (area.size.y - surface_px)));
  double m_per_px = static_cast<double>(kMouseGain * blocks_->depth_per_pixel(*index, count, size));
  const double known_m = session_->models().trained_depth_m();
  if (std::isfinite(known_m)) m_per_px = std::max(m_per_px, known_m / room_px);
  tool->set_target(limited_depth_m(m_per_px * below_px), steady_now_s());
}

// Call it within a frame, because ImGui clears the motion of the wheel at its end.
void DemoApp::handle_mouse() {
  const ImGuiIO& io = ImGui::GetIO();
  const bool inside = layout_.scene.holds(io.MousePos);
  const bool over_scene = inside && !io.WantCaptureMouse;
  const bool left = over_scene_ && !inside;
  over_scene_ = over_scene || (over_scene_ && inside);
  if (ImGui::IsMouseClicked(ImGuiMouseButton_Right) && over_scene) orbiting_ = true;
  if (!ImGui::IsMouseDown(ImGuiMouseButton_Right)) orbiting_ = false;
  if (orbiting_)
    return blocks_->camera().orbit(-kOrbit_rad_per_px * io.MouseDelta.x, kOrbit_rad_per_px * io.MouseDelta.y);
  ToolInput* tool = session_->tool_input();
  if (left && tool != nullptr && !tool->hand_is_exploring() && session_->newest().tick.position_m > 0.0) {
    Exhibit::let_go(*session_);
    if (!view_.exhibit.on) notify("the mouse has left the picture: the probe is lifted", false);
    return;
  }
  // A finger that leaves the screen releases the tool.
  if (view_.exhibit.on && ImGui::IsMouseReleased(ImGuiMouseButton_Left)) Exhibit::let_go(*session_);
  if (!over_scene) return;
  if (io.KeyCtrl) {
    blocks_->camera().zoom(std::pow(kZoom_per_step, io.MouseWheel));
  } else if (io.MouseWheel != 0.0F && tool != nullptr) {
    const double at_m = session_->newest().tick.position_m, by_m = -kWheelStep_m * io.MouseWheel;
    if (by_m < 0.0 || limited_depth_m(at_m + by_m) > at_m) tool->nudge(by_m, steady_now_s());
  }
  if (!view_.exhibit.on && ImGui::IsMouseReleased(ImGuiMouseButton_Left) &&
      io.MouseDragMaxDistanceSqr[ImGuiMouseButton_Left] < kClick_px * kClick_px) {
    const auto block = block_at(io.MousePos, true);
    if (block && *block < shown_.blocks.size()) session_->models().select(shown_.blocks[*block]);
  }
  const bool touched = view_.exhibit.on && ImGui::IsMouseClicked(ImGuiMouseButton_Left);  // even without a move
  if (io.MouseDelta.x != 0.0F || io.MouseDelta.y != 0.0F || touched) move_tool_to(io.MousePos);
}

// The same for a frame without texts, while only the mouse moves. Returns false, without an effect, if that is not
// enough: a button or a key is held, or the mouse is not over the free part of the picture.
bool DemoApp::follow_mouse(const ImVec2& mouse) {
  if (!down_.empty() || !keys_.empty() || ImGui::IsAnyMouseDown()) return false;
  if (mouse.x == mouse_.x && mouse.y == mouse_.y) return true;
  mouse_ = mouse;
  if (!layout_.scene.holds(mouse) || !over_scene_ || ImGui::GetIO().WantCaptureMouse) return false;
  move_tool_to(mouse);
  return true;
}

}  // namespace palpate
