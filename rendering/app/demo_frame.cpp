#include <GLFW/glfw3.h>
#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "rendering/app/demo_app.h"

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

// Texts, plots and controls are drawn less often than the picture, because nobody reads faster; and at once when the
// user does something to them.
bool DemoApp::needs_texts(double now_s) {
  constexpr double kTexts_s = 1.0 / 15.0;
  double x = 0.0, y = 0.0;
  glfwGetCursorPos(window_->handle(), &x, &y);
  const ImVec2 mouse(static_cast<float>(x), static_cast<float>(y));
  // A stroke moves the blocks only.
  if ((mouse.x != mouse_.x || mouse.y != mouse_.y) && !stroke_) note_input();
  mouse_ = mouse;
  follow_stroke();
  // The screens of an exhibit and lists move.
  const bool lively =
      now_s < lively_until_s_ || view_.exhibit.on || view_.dialogs.any() || view_.time.dragging || next_;
  const UiSize size = window_->size();
  const ImVec2 drawn = ImGui::GetIO().DisplaySize;
  if (!lively && now_s < texts_due_s_ && size.width == drawn.x && size.height == drawn.y) return false;
  // A quarter of a frame of tolerance, so that it is every fourth frame at 60 Hz.
  texts_due_s_ = now_s + kTexts_s - 0.25 / 60.0;
  // The panel follows in the next frame unless the user waits for it, so that no frame has all of the work.
  panel_waits_ = !lively && !panel_waits_;
  return true;
}

void DemoApp::draw_texts() {
  const bool exhibit = view_.exhibit.on;
  style_.update(window_->size(), exhibit ? kExhibitText : view_.settings.text_size, view_.settings.theme,
                exhibit ? kExhibitBody_px : kBody_px);
  ui_->begin_frame(tapped());
  layout_ = lay_out(ImGui::GetIO().DisplaySize);
  handle_mouse();
  draw_overlay(shown_, *blocks_, view_, style_, layout_.scene, actions_);
  if (exhibit) {
    exhibit_.draw(shown_, *blocks_, style_, layout_);
  } else {
    draw_panel(curves_, shown_, view_, style_, layout_.panel, actions_);
  }
  ImGui::Render();
}

void DemoApp::draw(bool texts) {
  if (texts) draw_texts();
  draw_blocks(texts);
  const Viewport panel = pixels_of(layout_.panel);
  if (!panel.empty()) {
    if (texts ? !panel_waits_ : std::exchange(panel_waits_, false)) {
      const Rgb& colour = style_.colours().panel;
      panel_.draw_into(panel.width, panel.height);
      glClearColor(colour.r, colour.g, colour.b, 1.0F);
      glClear(GL_COLOR_BUFFER_BIT);
      UiContext::draw_layer(UiLayer::panel, layout_.panel.at, layout_.panel.size);
    }
    panel_.copy_to(nullptr, {0, 0, panel.width, panel.height}, panel);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  UiContext::draw_front();
}

void DemoApp::draw_blocks(bool new_texts) {
  const SceneArea& area = layout_.scene;
  const std::vector<BlockPose> poses = block_poses();
  const SceneArea stage = stage_of(shown_, view_, style_, area);
  blocks_->leave_free((stage.at.y - area.at.y) / area.size.y,
                      1.0F - (stage.at.y - area.at.y + stage.size.y) / area.size.y);
  // Their number changes when models become ready; the camera jumps to the first ones.
  blocks_->show(poses.size(), {area.size.x, area.size.y}, std::exchange(no_model_, shown_.blocks.empty()));
  blocks_->draw(poses, pixels_of(area), view_.settings.theme, new_texts,
                [&] { UiContext::draw_layer(UiLayer::over_picture, area.at, area.size); });
}

std::vector<BlockPose> DemoApp::block_poses() const {
  if (view_.exhibit.on) {
    const std::vector<BlockPose> revealed = exhibit_.shown_poses(shown_, view_.settings.theme);
    if (!revealed.empty()) return revealed;
  }
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
  if (models.stands) {
    pose.error_over_jnd = std::abs(models.now.sustained_over_jnd[slot]);
    if (std::isnan(pose.error_over_jnd)) pose.error_over_jnd = 0.0F;
  } else {
    pose.dent_m = static_cast<float>(model.dent_m);
    pose.error_over_jnd = static_cast<float>(model.recent_error_over_jnd);
  }
  const bool exaggerated = view_.exaggerated && std::isfinite(reference_N);
  const float shown_N = exaggerated ? reference_N + kExaggeration * (force_N - reference_N) : force_N;
  pose.force_N = std::isfinite(shown_N) ? std::max(0.0F, shown_N) : 0.0F;
  pose.arrow = slot_colour(models, slot, view_.settings.theme);
  // A visitor who compares by hand sees nothing that gives the answer away.
  pose.shows_truth = !view_.exhibit.on && std::isfinite(reference_N);
  if (pose.shows_truth) {
    pose.true_dent_m = reference_pose(pose).dent_m;
    pose.true_force_N = std::max(0.0F, reference_N);
    const bool is_model = models.reference != kReferenceBlock;
    pose.truth =
        is_model ? slot_colour(models, models.reference, view_.settings.theme) : reference_colour(view_.settings.theme);
  }
  pose.shows_error = models.now.in_contact;  // what is not pressed has no error
  return pose;
}

// The pose of the reference block; it has the dent of the active model.
BlockPose DemoApp::reference_pose(BlockPose pose) const {
  const ModelView* active = shown_.models.active();
  const float reference_N = shown_.models.now.reference_N;
  if (active != nullptr && !shown_.models.stands) pose.dent_m = static_cast<float>(active->dent_m);
  pose.force_N = std::isfinite(reference_N) ? reference_N : 0.0F;
  pose.arrow = reference_colour(view_.settings.theme);
  pose.shows_error = false;
  return pose;
}

}  // namespace palpate
