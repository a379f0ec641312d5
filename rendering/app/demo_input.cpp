#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "engine/live/pacer.h"
#include "rendering/app/demo_input.h"
#include "rendering/panels/exhibit.h"

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

// Whether the key runs the command; not if ImGui uses it to move through an open list or to choose in it.
bool runs(int key, const WindowCommand& command, const KeyContext& context) {
  constexpr int kOfLists[] = {GLFW_KEY_UP,    GLFW_KEY_DOWN,      GLFW_KEY_LEFT, GLFW_KEY_RIGHT, GLFW_KEY_PAGE_UP,
                              GLFW_KEY_SPACE, GLFW_KEY_PAGE_DOWN, GLFW_KEY_HOME, GLFW_KEY_END,   GLFW_KEY_ENTER};
  if (command.replay && !context.replays) return false;
  return !context.in_list || std::ranges::find(kOfLists, key) == std::end(kOfLists);
}

// Limits a depth smoothly to 8 % beyond the depth up to which the models were trained.
double limited_depth_m(const LiveSession& session, double requested_m) {
  constexpr double kMargin = 0.08;  // of the trained depth
  const double known_m = session.models().trained_depth_m();
  if (requested_m <= known_m) return requested_m;
  const double margin_m = kMargin * known_m;
  return known_m + margin_m * (1.0 - std::exp((known_m - requested_m) / margin_m));
}

// Index in WindowView::blocks of the block nearest to `point`. With `aimed`: empty unless the point is on or near it.
std::optional<std::size_t> block_at(const WindowView& shown, const BlockView& blocks, const SceneArea& area,
                                    const ImVec2& point, bool aimed) {
  const std::size_t count = std::max<std::size_t>(shown.blocks.size(), 1);
  const auto half_height = 0.5F * static_cast<float>(blocks.geometry().height_m);
  const auto half_width = 0.5F * static_cast<float>(blocks.geometry().width_m);
  const glm::vec2 size(area.size.x, area.size.y);
  float nearest_px = 1e9F;
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec2 middle = blocks.on_screen(i, count, {0.0F, -half_height, 0.0F}, size);
    const glm::vec2 side = blocks.on_screen(i, count, {half_width, 0.0F, 0.0F}, size);
    const float away = std::hypot(area.at.x + middle.x - point.x, area.at.y + middle.y - point.y);
    if ((aimed && away > 1.25F * glm::length(side - middle)) || away > nearest_px) continue;
    nearest_px = away;
    found = i;
  }
  return found;
}

// Once the mouse was over a block, it moves the tool in all of the picture, so that a fast move beyond the block still
// presses. The full trained depth is within reach above the lower edge.
void move_tool_to_mouse(LiveSession& session, const WindowView& shown, const BlockView& blocks, const ViewState& view,
                        const SceneArea& area, const ImVec2& mouse) {
  ToolInput* tool = session.tool_input();
  if (tool == nullptr || view.exhibit.tool_is_held) return;
  const bool aimed = tool->hand_is_exploring() && !view.exhibit.on;  // a visitor can begin anywhere
  const auto index = block_at(shown, blocks, area, mouse, aimed);
  if (!index) return;
  const glm::vec2 size(area.size.x, area.size.y);
  const std::size_t count = std::max<std::size_t>(shown.blocks.size(), 1);
  const float surface_px = blocks.on_screen(*index, count, {0.0F, 0.0F, 0.0F}, size).y;
  const double below_px = mouse.y - area.at.y - surface_px;
  const double room_px = std::max(1.0, static_cast<double>(kReach * (area.size.y - surface_px)));
  double m_per_px = static_cast<double>(kMouseGain * blocks.depth_per_pixel(*index, count, size));
  const double known_m = session.models().trained_depth_m();
  if (std::isfinite(known_m)) m_per_px = std::max(m_per_px, known_m / room_px);
  tool->set_target(limited_depth_m(session, m_per_px * below_px), steady_now_s());
}

}  // namespace

void DemoInput::drive_tool(const LiveSession& session, double velocity_m_per_s) {
  ToolInput* tool = session.tool_input();
  // Without a key, the simulated hand and the mouse are left alone.
  if (tool == nullptr || (velocity_m_per_s == 0.0 && !drives_)) return;
  drives_ = velocity_m_per_s != 0.0;
  constexpr double kFar_m = 1.0;
  const double limit_m = velocity_m_per_s > 0.0 ? limited_depth_m(session, kFar_m) : kHover_m;
  tool->drive(velocity_m_per_s, limit_m, steady_now_s());
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

bool DemoInput::is_down(int key) const { return std::find(down_.begin(), down_.end(), key) != down_.end(); }

std::vector<int> DemoInput::tapped() const {
  std::vector<int> tapped;
  for (const KeyPress& press : keys_)
    if (!is_down(press.key)) tapped.push_back(press.key);
  return tapped;
}

void DemoInput::run_held(const std::vector<KeyPress>& pressed, const std::vector<WindowCommand>& commands,
                         const KeyContext& context) const {
  for (const WindowCommand& command : commands) {
    if (command.when != WindowCommand::When::held) continue;
    for (std::size_t i = 0; i < command.keys.size(); ++i) {
      const int key = command.keys[i];
      const bool down = is_down(key) || std::ranges::find(pressed, key, &KeyPress::key) != pressed.end();
      if (down && runs(key, command, context)) command.run(i);
    }
  }
}

void DemoInput::run(const KeyPress& press, const std::vector<WindowCommand>& commands, const KeyContext& context) {
  const bool control = (press.modifiers & GLFW_MOD_CONTROL) != 0;
  for (const WindowCommand& command : commands) {
    const auto key = std::ranges::find(command.keys, press.key);
    if (key == command.keys.end() || command.control != control || !runs(press.key, command, context)) continue;
    if (command.when == WindowCommand::When::repeated || (command.when == WindowCommand::When::pressed && !press.again))
      command.run(static_cast<std::size_t>(key - command.keys.begin()));
  }
}

bool DemoInput::handle_mouse(LiveSession& session, const WindowView& shown, BlockView& blocks, const ViewState& view,
                             const SceneArea& area) {
  const ImGuiIO& io = ImGui::GetIO();
  const bool inside = area.holds(io.MousePos);
  const bool over_scene = inside && !io.WantCaptureMouse;
  const bool left = over_scene_ && !inside;
  over_scene_ = over_scene || (over_scene_ && inside);
  if (ImGui::IsMouseClicked(ImGuiMouseButton_Right) && over_scene) orbiting_ = true;
  if (!ImGui::IsMouseDown(ImGuiMouseButton_Right)) orbiting_ = false;
  if (orbiting_) {
    blocks.camera().orbit(-kOrbit_rad_per_px * io.MouseDelta.x, kOrbit_rad_per_px * io.MouseDelta.y);
    return false;
  }
  ToolInput* tool = session.tool_input();
  if (left && tool != nullptr && !tool->hand_is_exploring() && session.newest().tick.position_m > 0.0) {
    Exhibit::let_go(session);
    return true;
  }
  // A finger that leaves the screen releases the tool.
  if (view.exhibit.on && ImGui::IsMouseReleased(ImGuiMouseButton_Left)) Exhibit::let_go(session);
  if (!over_scene) return false;
  if (io.KeyCtrl) {
    blocks.camera().zoom(std::pow(kZoom_per_step, io.MouseWheel));
  } else if (io.MouseWheel != 0.0F && tool != nullptr) {
    const double at_m = session.newest().tick.position_m, by_m = -kWheelStep_m * io.MouseWheel;
    if (by_m < 0.0 || limited_depth_m(session, at_m + by_m) > at_m) tool->nudge(by_m, steady_now_s());
  }
  if (!view.exhibit.on && ImGui::IsMouseReleased(ImGuiMouseButton_Left) &&
      io.MouseDragMaxDistanceSqr[ImGuiMouseButton_Left] < kClick_px * kClick_px) {
    const auto block = block_at(shown, blocks, area, io.MousePos, true);
    if (block && *block < shown.blocks.size()) session.models().select(shown.blocks[*block]);
  }
  const bool touched = view.exhibit.on && ImGui::IsMouseClicked(ImGuiMouseButton_Left);  // even without a move
  if (io.MouseDelta.x != 0.0F || io.MouseDelta.y != 0.0F || touched)
    move_tool_to_mouse(session, shown, blocks, view, area, io.MousePos);
  return false;
}

bool DemoInput::follow_mouse(LiveSession& session, const WindowView& shown, const BlockView& blocks,
                             const ViewState& view, const SceneArea& area, const ImVec2& mouse) {
  const ImGuiIO& io = ImGui::GetIO();
  if (!down_.empty() || !keys_.empty() || ImGui::IsAnyMouseDown()) return false;
  if (mouse.x == mouse_.x && mouse.y == mouse_.y) return true;
  mouse_ = mouse;
  if (!area.holds(mouse) || !over_scene_ || io.WantCaptureMouse) return false;
  move_tool_to_mouse(session, shown, blocks, view, area, mouse);
  return true;
}

}  // namespace palpate
