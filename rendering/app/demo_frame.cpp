// What the window draws in a frame, and when.
#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>

#include "engine/live/pacer.h"
#include "rendering/app/demo_app.h"
#include "rendering/panels/panel_parts.h"
#include "rendering/panels/panel_views.h"

namespace palpate {
namespace {

constexpr double kNsPerS = 1e9;
constexpr double kExaggeration = 10.0;

// ImGui counts down from the top, OpenGL up from the bottom.
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
  style_.update(window_->ui_size(), view_.exhibit ? kExhibitText : view_.text_size, view_.theme);
  ui_->begin_frame();
  input_.keep_wheel();
  // Clearing costs less than filling a rectangle, where the processor draws.
  const Rgb& panel_colour = palette(view_.theme).panel;
  glClearColor(panel_colour.r, panel_colour.g, panel_colour.b, 1.0F);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  draw_blocks();
  const SceneArea area = scene_area();
  const WindowLayout layout = lay_out(ImGui::GetIO().DisplaySize);
  const SceneArea& panel = layout.panel;
  overlay_.draw(*session_, *blocks_, view_, style_, area, toasts_,
                {&commands_, [this](const std::string& scene) { switch_to(scene, "", first_device_); },
                 [this](const std::string& path) { switch_to(request_.scene, "", "replay:" + path); },
                 [this](const std::string& path) { switch_to(request_.scene, path, first_device_); },
                 [this](const std::string& path) { drop_files({path}); },
                 [this](const std::string& device) {
                   first_device_ = device;
                   next_ = request_;
                   next_->recording = session_->scene().recording;
                   next_->device = device;
                 }});
  if (view_.exhibit) {
    exhibit_.draw(*session_, *blocks_, style_, layout);
  } else {
    panel_.draw(*session_, view_, style_, frames_, panel.at, panel.size);
  }
  ui_->end_frame();
  if (!blocks_->filters_edges()) return;
  // The processor draws: this waits for what showing the frame would wait for.
  glFinish();
  resolution_.add(steady_now_s() - frame_began_s_);
}

void DemoApp::draw_blocks() {
  const SceneArea area = scene_area();
  const Viewport viewport = pixels_of(area);
  const std::vector<BlockPose> poses = block_poses();
  // More models become ready: more blocks.
  if (poses.size() != blocks_framed_) blocks_->show(poses.size(), false);
  blocks_framed_ = poses.size();
  blocks_->draw(poses, viewport, view_.theme, resolution_.scale());
  frames_.picture_scale = resolution_.scale();
}

std::vector<BlockPose> DemoApp::block_poses() const {
  std::vector<BlockPose> poses = true_poses();
  const float deepest_m = 0.7F * static_cast<float>(blocks_->geometry().height_m);
  const auto deeper = [&](float depth_m) {
    return depth_m > 0.0F ? std::min(kDeeperDents * depth_m, std::max(depth_m, deepest_m)) : depth_m;
  };
  if (view_.exhibit) return poses;
  for (BlockPose& pose : poses) {
    pose.tool_m = deeper(pose.tool_m);
    pose.dent_m = deeper(pose.dent_m);
  }
  return poses;
}

std::vector<BlockPose> DemoApp::true_poses() const {
  const LoopSnapshot& newest = session_->newest();
  BlockPose pose;
  pose.tool_m = static_cast<float>(newest.tick.position_m);
  const ModelsView models = models_view(*session_);
  const double reference_N = session_->comparison().reference_N();
  std::vector<BlockPose> poses;
  for (const std::size_t slot : shown_slots(*session_, view_.block_count)) {
    if (slot == kReferenceBlock) {
      poses.push_back(reference_pose(pose));
      continue;
    }
    const SlotView& model = *models.slots[slot];
    pose.dent_m = static_cast<float>(model.dent_m);
    pose.error_over_jnd = static_cast<float>(model.recent_peak_error_over_jnd);
    const bool exaggerated = view_.exaggerated && !view_.exhibit && std::isfinite(reference_N);
    const double shown_N = exaggerated ? reference_N + kExaggeration * (model.force_N - reference_N) : model.force_N;
    pose.force_N = static_cast<float>(std::max(0.0, shown_N));
    pose.arrow = view_.exhibit ? method_colour(model.method, view_.theme) : slot_colour(models, slot, view_.theme);
    pose.chosen = slot == models.selected;
    if (view_.blind) pose.arrow = palette(view_.theme).text;
    pose.shows_error = !view_.blind;
    poses.push_back(pose);
  }
  // Before the first model is ready: a block nobody has a model of yet.
  if (poses.empty()) {
    pose.dent_m = std::max(0.0F, pose.tool_m);
    pose.shows_error = false;
    poses.push_back(pose);
  }
  return poses;
}

// What the others are compared with; it gives way as the active model does.
BlockPose DemoApp::reference_pose(BlockPose pose) const {
  const SlotView* active = models_view(*session_).active();
  const double reference_N = session_->comparison().reference_N();
  pose.dent_m = active != nullptr ? static_cast<float>(active->dent_m) : std::max(0.0F, pose.tool_m);
  pose.force_N = std::isfinite(reference_N) ? static_cast<float>(reference_N) : 0.0F;
  pose.arrow = kReferenceColour;
  pose.chosen = pose.shows_error = false;
  return pose;
}

void DemoApp::count_frame(double now_s) {
  frames_.times.add(static_cast<std::int64_t>((now_s - last_frame_s_) * kNsPerS));
  frames_.seconds += now_s - last_frame_s_;
  ++frames_.frames;
  ++frames_this_second_;
  last_frame_s_ = now_s;
  if (now_s - second_began_s_ < 1.0) return;
  frames_.recent_fps = static_cast<double>(frames_this_second_) / (now_s - second_began_s_);
  frames_this_second_ = 0;
  second_began_s_ = now_s;
}

}  // namespace palpate
