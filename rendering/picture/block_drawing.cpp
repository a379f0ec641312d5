#include <epoxy/gl.h>

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <optional>

#include "rendering/picture/block_view.h"

namespace palpate {
namespace {

// In radii of the tool as drawn.
constexpr float kTrueArrow = 1.75F, kTrueArrowWidth = 0.13F;
constexpr float kDomeRadius = 2.0F;    // a visible width
constexpr float kLongestArrow = 1.3F;  // in lengths of the tool
constexpr float kLine = 0.0055F;       // in heights of the picture
// Share of transmitted light, gloss, pores and lines of the grid, in the order of Finish.
struct Material {
  float translucent, gloss, pores, grid;
};
constexpr Material kMaterials[] = {{0.75F, 0.55F, 0.0F, 0.16F}, {0.25F, 0.06F, 0.30F, 0.08F},
                                   {1.00F, 1.00F, 0.0F, 0.10F}, {0.05F, 0.45F, 0.0F, 0.22F},
                                   {0.90F, 0.20F, 0.0F, 0.10F}, {0.30F, 0.50F, 0.0F, 0.12F}};

const glm::vec3 kLight = glm::normalize(glm::vec3(-0.35F, 0.85F, 0.45F));

}  // namespace

void BlockView::begin(const Shader& shader) const {
  shader.use();
  shader.set("view_projection", view_projection_);
  shader.set("eye", camera_.eye());
  shader.set("light", kLight);
}

// Sets the common values of the shaders for the parts of a block.
void BlockView::begin_block(const Shader& shader) const {
  const Material& material = kMaterials[static_cast<std::size_t>(finish_)];
  begin(shader);
  shader.set("half_size", glm::vec3(0.5F * size_m_.x, size_m_.y, 0.5F * size_m_.z));
  shader.set("colour", block_colour_);
  shader.set("translucent", material.translucent);
  shader.set("gloss", material.gloss);
  shader.set("pores", material.pores);
  shader.set("grid", material.grid);
  shader.set("mark", 0.0F);
  shader.set("tip", -1.0F);                  // the tip is far above
  shader.set("px_per_m", 2.0F * px_per_m_);  // of the static parts
  set_dent(shader, 0.0F);
}

void BlockView::set_dent(const Shader& shader, float depth_m) const {
  const DentShape dent = dent_under_ball(drawn_m(depth_m), radius_m_);
  shader.set("dent", dent.depth_m);
  shader.set("contact", dent.contact_m);
  shader.set("edge", dent.edge_m);
  shader.set("tool_radius", radius_m_);
  shader.set("rim", rim_m_);
  shader.set("dome", dome_m_);
  shader.set("dome_radius", kDomeRadius * radius_m_);
}

void BlockView::set_error(const Shader& shader, const BlockPose& pose) const {
  begin_block(shader);
  set_dent(shader, pose.dent_m);
  shader.set("mark_colour", error_colour(static_cast<double>(pose.error_over_jnd)));
  shader.set("mark", opacity_of_error(pose));
  shader.set("mark_radius", 1.5F * radius_m_ + 2.4F * drawn_m(std::max(0.0F, pose.dent_m)));
  shader.set("tip", drawn_m(pose.tool_m));
  shader.set("outline_colour", outline_on(block_colour_));
  shader.set("outline_width", outline_px());
  shader.set("px_per_m", px_per_m_);
}

void BlockView::draw_still(std::size_t count, Theme theme) {
  const Rgb& background = palette(theme).background;
  const auto clear = [&] {
    glClearColor(background.r, background.g, background.b, 1.0F);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  };
  const int width = static_cast<int>(cell_.x), height = static_cast<int>(cell_.y);
  fine_.draw_into(2 * width, 2 * height);
  clear();
  draw_cell(theme);
  draw_tool(theme);
  still_pixels_.draw_into(still_.width, still_.height);
  clear();
  const glm::vec2 size(still_.width, still_.height);
  const Cells grid = cells(count, size);
  std::optional<Viewport> first;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec2 at = corner(i, count, grid, size);
    const Viewport part{static_cast<int>(at.x), static_cast<int>(at.y), width, height};
    if (first) {
      still_pixels_.copy_to(&still_pixels_, *first, part);
    } else {
      fine_.copy_to(&still_pixels_, {0, 0, 2 * width, 2 * height}, part);
      first = part;
    }
  }
}

// The static parts of a block, with its surface at rest.
void BlockView::draw_cell(Theme theme) {
  // The table is behind and below everything else, so it needs no depth test.
  begin(shaders_.table);
  shaders_.table.set("table_y", -size_m_.y);
  shaders_.table.set("reach", std::min(0.8F * std::max(size_m_.x, size_m_.z), 0.5F * cell_.x / px_per_m_));
  shaders_.table.set("table_colour", palette(theme).table);
  shaders_.table.set("background", palette(theme).background);
  shaders_.table.set("half_size", 0.5F * glm::vec2(size_m_.x, size_m_.z));
  square_.draw();
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_CULL_FACE);
  begin_block(shaders_.sides);
  sides_.draw();
  begin_block(shaders_.top);
  top_.draw();
  begin_block(shaders_.section);
  section_.draw();
  glDisable(GL_CULL_FACE);
  glDisable(GL_DEPTH_TEST);
}

// Draws the tool, with its tip at the undisturbed surface, into a picture of its own: it moves up and down only.
void BlockView::draw_tool(Theme theme) {
  const float wide = kToolWidth * radius_m_;
  const Viewport part = part_around({-wide, 0.0F, -wide}, {wide, kToolLength * radius_m_, wide});
  const glm::vec2 tip = in_cell(glm::vec3(0.0F));
  tool_low_ = glm::vec2(part.x, part.y) - tip;
  tool_high_ = tool_low_ + glm::vec2(part.width, part.height);
  tool_.draw_into(2 * part.width, 2 * part.height);
  glViewport(-2 * part.x, -2 * part.y, 2 * static_cast<int>(cell_.x), 2 * static_cast<int>(cell_.y));
  glClearColor(0.0F, 0.0F, 0.0F, 0.0F);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glEnable(GL_DEPTH_TEST);
  const Shader& shader = shaders_.solid;
  begin(shader);
  shader.set("stretch", radius_m_);
  shader.set("outline_colour", outline_on(block_colour_));
  shader.set("outline_width", 2.0F * outline_px());
  shader.set("glow", palette(theme).glow);
  const Rgb steel = hex(0xB4BAC0);
  const auto body = [&](const GpuMesh& mesh, const Rgb& colour, float shininess) {
    shader.set("colour", colour);
    shader.set("shininess", shininess);
    mesh.draw();
  };
  body(ball_, steel, 1.0F);
  body(sensor_, glm::mix(steel, palette(theme).rubber, 0.4F), 0.8F);
  body(handle_, palette(theme).rubber, 0.1F);
  glDisable(GL_DEPTH_TEST);
}

// From behind to the front: the top, the cut face, the line, the halo, the arrows, the tool.
void BlockView::draw_moving(const BlockPose& pose) const {
  glEnable(GL_CULL_FACE);
  set_error(shaders_.top, pose);
  middle_.draw();
  if (pose.dent_m > 0.0F) {
    set_error(shaders_.section, pose);
    moving_section_.draw();
  }
  glDisable(GL_CULL_FACE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  draw_line(pose);
  const glm::vec2 tip = in_cell({0.0F, -drawn_m(pose.tool_m), 0.0F});
  if (const float radius = halo_px(pose); radius > 0.0F) {
    const float rim = std::max(2.0F, 0.12F * radius_m_ * px_per_m_);
    shaders_.halo.use();
    shaders_.halo.set("colour", kAboveJndColour);
    shaders_.halo.set("opacity", opacity_of_error(pose));
    shaders_.halo.set("radius", radius);
    shaders_.halo.set("rim_width", rim);
    shaders_.halo.set("outline_colour", outline_on(block_colour_));
    shaders_.halo.set("outline_width", outline_px());
    const glm::vec2 half(radius + rim + outline_px());
    draw_flat(shaders_.halo, in_cell({0.0F, radius_m_ - drawn_m(pose.dent_m), 0.0F}), -half, half);
  }
  if (pose.shows_truth) draw_arrow(kTrueArrow, pose.true_force_N, kTrueArrowWidth, pose.truth);
  draw_arrow(kModelArrow, pose.force_N, kModelArrowWidth, pose.arrow);
  glBindTexture(GL_TEXTURE_2D, tool_.colour());
  shaders_.sprite.use();
  draw_flat(shaders_.sprite, tip, tool_low_, tool_high_);
  glDisable(GL_BLEND);
}

// The surface in the cut: that of the true material where it is known, else the bright edge of this one.
void BlockView::draw_line(const BlockPose& pose) const {
  const float width = std::max(kLeastLine_px, kLine * static_cast<float>(still_.height));
  const float rim = std::max(0.8F, 0.25F * width);
  const Shader& shader = shaders_.line;
  begin(shader);
  set_dent(shader, pose.shows_truth ? pose.true_dent_m : pose.dent_m);
  shader.set("cell", cell_);
  shader.set("width", pose.shows_truth ? width + 2.0F * rim : kLeastLine_px);
  shader.set("outline_width", pose.shows_truth ? rim : 0.0F);
  shader.set("outline_colour", Rgb(1.0F));
  shader.set("colour", pose.shows_truth ? pose.truth : glm::mix(block_colour_, Rgb(1.0F), 0.55F));
  line_.draw();
}

void BlockView::draw_arrow(float from_middle, float force_N, float half_width, const Rgb& colour) const {
  if (force_N < kShortestArrow_N) return;
  const float radius = radius_m_ * px_per_m_;
  const float height = px_per_m_ * std::min(arrow_m_per_N_ * force_N, kLongestArrow * kToolLength * radius_m_);
  const float outline = outline_px();
  const float half = std::min(std::max(1.2F, half_width * radius), height / 5.0F);
  const Shader& shader = shaders_.arrow;
  shader.use();
  shader.set("colour", colour);
  shader.set("outline_colour", outline_on(block_colour_));
  shader.set("outline_width", outline);
  shader.set("half_width", half);
  shader.set("height", height);
  const float wide = 2.6F * half + outline + 1.0F;
  draw_flat(shader, in_cell({0.0F, -dome_m_, 0.0F}) + glm::vec2(from_middle * radius, 0.0F),
            {-wide, -height - outline - 2.0F}, {wide, outline + 1.0F});
}

void BlockView::draw_flat(const Shader& shader, const glm::vec2& origin, const glm::vec2& low,
                          const glm::vec2& high) const {
  shader.set("cell", cell_);
  shader.set("origin", origin);
  shader.set("low", low);
  shader.set("high", high);
  square_.draw();
}

}  // namespace palpate
