// Draws a frame of the window.
#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>

#include "engine/live/pacer.h"
#include "rendering/app/demo_app.h"
#include "rendering/panels/panel_parts.h"
#include "rendering/panels/window_view.h"

namespace palpate {
namespace {

constexpr float kExaggeration = 10.0F;

// Converts from ImGui, whose y points down from the top, to OpenGL, whose y points up from the bottom.
Viewport pixels_of(const SceneArea& area) {
  const ImGuiIO& io = ImGui::GetIO();
  const ImVec2 scale = io.DisplayFramebufferScale;
  const auto whole = [](float value) { return static_cast<int>(std::round(value)); };
  Viewport part;
  part.x = whole(area.at.x * scale.x);
  part.y = whole((io.DisplaySize.y - area.at.y - area.size.y) * scale.y);
  part.width = whole((area.at.x + area.size.x) * scale.x) - part.x;
  part.height = whole((io.DisplaySize.y - area.at.y) * scale.y) - part.y;
  return part;
}

}  // namespace

void DemoApp::draw() {
  const bool exhibit = view_.exhibit.on;
  style_.update(window_->size(), exhibit ? kExhibitText : view_.settings.text_size, view_.settings.theme,
                exhibit ? kExhibitBody_px : kBody_px);
  ui_->begin_frame(input_.tapped());
  const WindowLayout layout = lay_out(ImGui::GetIO().DisplaySize);
  if (input_.handle_mouse(*session_, shown_, *blocks_, view_, layout.scene) && !exhibit)
    notify("the mouse has left the picture: the probe is lifted", false);
  // With a software renderer, clearing is faster than filling a rectangle.
  window_->clear(style_.colours().panel);
  draw_blocks(layout.scene);
  const OverlayActions actions{&commands_,
                               [this] { return choices(); },
                               [this](const std::string& scene) { use_material(scene, {}, first_device_); },
                               [this](const std::string& path) { drop_files({path}); },
                               [this](const std::string& device) {
                                 first_device_ = device;
                                 use_device(device);
                               },
                               [this] { use_recording_roles(); }};
  draw_overlay(*session_, shown_, *blocks_, view_, style_, layout.scene, actions);
  if (exhibit) {
    exhibit_.draw(*session_, shown_, *blocks_, style_, layout);
  } else {
    draw_panel(curves_, *session_, shown_, view_, style_, layout.panel);
  }
  ui_->end_frame();
  if (!blocks_->filters_edges()) return;
  // With a software renderer, waits for the drawing here instead of in the buffer swap, to measure its time.
  glFinish();
  resolution_.add(steady_now_s() - frame_began_s_);
}

void DemoApp::draw_blocks(const SceneArea& area) {
  const std::vector<BlockPose> poses = block_poses();
  blocks_->show(poses.size(), false);  // their number changes when models become ready
  blocks_->draw(poses, pixels_of(area), view_.settings.theme, resolution_.scale());
  view_.frames.picture_scale = resolution_.scale();
}

std::vector<BlockPose> DemoApp::block_poses() const {
  if (view_.exhibit.on) {
    const std::vector<BlockPose> revealed = exhibit_.shown_poses(*session_, shown_, view_.settings.theme);
    return revealed.empty() ? true_poses() : revealed;
  }
  std::vector<BlockPose> poses = true_poses();
  const float deepest_m = 0.7F * static_cast<float>(blocks_->geometry().height_m);
  const auto deeper = [&](float depth_m) {
    return depth_m > 0.0F ? std::min(kDeeperDents * depth_m, std::max(depth_m, deepest_m)) : depth_m;
  };
  for (BlockPose& pose : poses) {
    pose.tool_m = deeper(pose.tool_m);
    pose.dent_m = deeper(pose.dent_m);
  }
  return poses;
}

// The poses at the last tick that the curves show.
std::vector<BlockPose> DemoApp::true_poses() const {
  BlockPose pose;
  pose.tool_m = shown_.models.now.position_m;
  pose.dent_m = std::max(0.0F, pose.tool_m);
  std::vector<BlockPose> poses;
  for (const std::size_t slot : shown_.blocks)
    poses.push_back(slot == kReferenceBlock ? reference_pose(pose) : model_pose(slot, pose));
  // Before the first model is ready, there is one block without an error.
  if (poses.empty()) {
    pose.shows_error = false;
    poses.push_back(pose);
  }
  return poses;
}

BlockPose DemoApp::model_pose(std::size_t slot, BlockPose pose) const {
  const ModelsView& models = shown_.models;
  const ModelView& model = models.slots[slot];
  const float force_N = models.now.force_N[slot], reference_N = models.now.reference_N;
  if (view_.time.paused) {
    pose.error_over_jnd = std::abs(models.now.sustained_over_jnd[slot]);
    if (std::isnan(pose.error_over_jnd)) pose.error_over_jnd = 0.0F;
  } else {
    pose.dent_m = static_cast<float>(model.dent_m);
    pose.error_over_jnd = static_cast<float>(model.recent_error_over_jnd);
  }
  const bool exaggerated = view_.exaggerated && !view_.exhibit.on && std::isfinite(reference_N);
  const float shown_N = exaggerated ? reference_N + kExaggeration * (force_N - reference_N) : force_N;
  pose.force_N = std::isfinite(shown_N) ? std::max(0.0F, shown_N) : 0.0F;
  pose.arrow = slot_colour(models, slot, view_.settings.theme);
  pose.chosen = slot == models.selected;
  if (view_.exhibit.blind) pose.arrow = palette(view_.settings.theme).text;
  pose.shows_error = !view_.exhibit.blind;
  return pose;
}

// The pose of the reference block; it has the dent of the active model.
BlockPose DemoApp::reference_pose(BlockPose pose) const {
  const ModelView* active = shown_.models.active();
  const float reference_N = shown_.models.now.reference_N;
  if (active != nullptr && !view_.time.paused) pose.dent_m = static_cast<float>(active->dent_m);
  pose.force_N = std::isfinite(reference_N) ? reference_N : 0.0F;
  pose.arrow = reference_colour(view_.settings.theme);
  pose.chosen = pose.shows_error = false;
  return pose;
}

}  // namespace palpate
