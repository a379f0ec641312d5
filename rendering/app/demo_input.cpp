// Keys and mouse: keys run commands, the mouse moves the tool and the camera.
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <iterator>
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
// The share of the distance from the beginning of a stroke to the lower edge at which the tool is at the largest
// trained depth.
constexpr float kReach = 0.8F, kLeastReach = 0.35F;  // the second: in heights of the picture
constexpr CameraTurn kCloseUp{0.0F, 0.0F, 0.85F};    // of the reveal of an exhibit

}  // namespace

void DemoApp::handle_key_event(int key, int action, int modifiers) {
  if (view_.exhibit.on && action == GLFW_RELEASE && key == GLFW_KEY_DOWN) lift_tool();
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
  if (view_.exhibit.on && exhibit_.update(shown_, view_, actions_)) blocks_->camera().go_home();
  if (view_.exhibit.close_up != was_close) blocks_->camera().turn(view_.exhibit.close_up ? kCloseUp : CameraTurn{});
}

void DemoApp::run_commands(const std::vector<KeyPress>& keys) {
  const bool menu = ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
  const bool in_list = menu || view_.dialogs.any();
  run_held(keys, in_list);
  for (const KeyPress& press : keys) {
    if (view_.exhibit.on) {
      handle_exhibit_key(press);
    } else if (in_list || !press_focused(press)) {
      run_pressed(press, in_list);
    }
  }
}

// Tab moves a focus through the buttons; Enter or Space presses the one that has it. Returns whether it did.
bool DemoApp::press_focused(const KeyPress& press) {
  std::vector<const WindowCommand*> buttons;
  for (const WindowCommand& command : commands_)
    if (command.bar) buttons.push_back(&command);
  const int count = static_cast<int>(buttons.size()) + 1;  // with that of the menu
  if (press.key == GLFW_KEY_TAB) {
    const bool back = (press.modifiers & GLFW_MOD_SHIFT) != 0;
    view_.focus = back ? (view_.focus <= 0 ? count : view_.focus) - 1 : (view_.focus + 1) % count;
    return true;
  }
  if (view_.focus < 0 || (press.key != GLFW_KEY_ENTER && press.key != GLFW_KEY_SPACE)) return false;
  const auto focused = static_cast<std::size_t>(view_.focus);
  focused < buttons.size() ? buttons[focused]->run(0) : void(view_.opens_menu = true);
  return true;
}

void DemoApp::handle_exhibit_key(const KeyPress& press) {
  const bool control = (press.modifiers & GLFW_MOD_CONTROL) != 0;
  const bool chord = control && (press.modifiers & GLFW_MOD_SHIFT) != 0;
  if (chord && press.key == GLFW_KEY_Q) close();
  if (chord && press.key == GLFW_KEY_T) exhibit_.toggle_host();
  if (press.key == GLFW_KEY_Z && session_->newest().device.zeroing == Zeroing::needed) session_->start_zeroing();
  if (!control && !press.again) exhibit_.press_key(press.key, shown_);
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

// Index in WindowView::blocks of the block in whose cell `point` is; empty outside of the picture.
std::optional<std::size_t> DemoApp::block_at(const ImVec2& point) const {
  const SceneArea& area = layout_.scene;
  if (!area.holds(point)) return std::nullopt;
  return blocks_->cell_at({point.x - area.at.x, point.y - area.at.y}, block_count(), {area.size.x, area.size.y});
}

void DemoApp::lift_tool() {
  constexpr double kLifted_m = -0.008;
  if (session_->tool_input() != nullptr) session_->tool_input()->set_target(kLifted_m, steady_now_s());
}

// The tool is at the surface where the stroke begins; a finger or a visitor presses as deep as the block that it points
// at.
void DemoApp::begin_stroke(const ImVec2& mouse) {
  const auto block = block_at(mouse);
  if (!block || session_->tool_input() == nullptr || view_.exhibit.tool_is_held) return;
  stroke_ = Stroke{*block, mouse.y, false};
  if (!view_.exhibit.on) return;
  const SceneArea& area = layout_.scene;
  stroke_->from_px =
      area.at.y + blocks_->on_screen(*block, block_count(), {0.0F, 0.0F, 0.0F}, {area.size.x, area.size.y}).y;
}

// Moves the tool with the pointer, in every frame. The depth that the hand aims at is the way down from the beginning
// of the stroke; the full trained depth is within reach.
void DemoApp::follow_stroke() {
  ToolInput* tool = session_->tool_input();
  if (!stroke_ || tool == nullptr) return;
  if (view_.exhibit.tool_is_held) return stroke_.reset();
  const bool down = ImGui::IsMouseDown(ImGuiMouseButton_Left);
  const SceneArea& area = layout_.scene;
  if (stroke_->hovers ? !area.holds(mouse_) : !down) {
    stroke_.reset();
    lift_tool();
    return;
  }
  const std::size_t block = std::min(stroke_->block, block_count() - 1);
  const float y = std::clamp(mouse_.y, area.at.y, area.at.y + area.size.y);
  const float room_px = std::max(kReach * (area.at.y + area.size.y - stroke_->from_px), kLeastReach * area.size.y);
  double m_per_px =
      static_cast<double>(kMouseGain * blocks_->depth_per_pixel(block, block_count(), {area.size.x, area.size.y}));
  const double known_m = session_->models().trained_depth_m();
  if (std::isfinite(known_m)) m_per_px = std::max(m_per_px, known_m / static_cast<double>(room_px));
  tool->set_target(limited_depth_m(m_per_px * static_cast<double>(y - stroke_->from_px)), steady_now_s());
}

// A visitor's pointer presses without a button, too; above the surface it may change the block.
void DemoApp::hover_block(const ImVec2& mouse) {
  const bool above = stroke_ && stroke_->hovers && mouse.y < stroke_->from_px;
  if (stroke_ && !above) return;
  begin_stroke(mouse);
  if (stroke_) stroke_->hovers = true;
}

// Call it within a frame, because ImGui clears the motion of the wheel at its end.
void DemoApp::handle_mouse() {
  const ImGuiIO& io = ImGui::GetIO();
  const bool over_scene = layout_.scene.holds(io.MousePos) && !io.WantCaptureMouse;
  if (ImGui::IsMouseClicked(ImGuiMouseButton_Right) && over_scene) orbiting_ = true;
  if (!ImGui::IsMouseDown(ImGuiMouseButton_Right)) orbiting_ = false;
  if (orbiting_)
    return blocks_->camera().orbit(-kOrbit_rad_per_px * io.MouseDelta.x, kOrbit_rad_per_px * io.MouseDelta.y);
  if (!over_scene) return;
  if (ImGui::IsMouseClicked(ImGuiMouseButton_Left)) begin_stroke(io.MousePos);
  const bool moved = io.MouseDelta.x != 0.0F || io.MouseDelta.y != 0.0F;
  if (view_.exhibit.on && moved && !ImGui::IsAnyMouseDown()) hover_block(io.MousePos);
  ToolInput* tool = session_->tool_input();
  if (io.KeyCtrl) {
    blocks_->camera().zoom(std::pow(kZoom_per_step, io.MouseWheel));
  } else if (io.MouseWheel != 0.0F && tool != nullptr) {
    const double at_m = session_->newest().tick.position_m, by_m = -kWheelStep_m * io.MouseWheel;
    if (by_m < 0.0 || limited_depth_m(at_m + by_m) > at_m) tool->nudge(by_m, steady_now_s());
  }
  if (!view_.exhibit.on && ImGui::IsMouseReleased(ImGuiMouseButton_Left) &&
      io.MouseDragMaxDistanceSqr[ImGuiMouseButton_Left] < kClick_px * kClick_px) {
    const auto block = block_at(io.MousePos);
    if (block && *block < shown_.blocks.size() && shown_.blocks[*block] != kReferenceBlock)
      actions_.select(shown_.blocks[*block]);
  }
}

}  // namespace palpate
