#include "rendering/picture/block_view.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <iterator>
#include <numbers>
#include <utility>

#include "scenes/scene/folders.h"

namespace palpate {
namespace {

constexpr float kBetween = 1.32F;        // distance of neighbouring blocks, in widths
constexpr float kStrongestArrow = 0.3F;  // for the scene's strongest press, in sizes of a block
constexpr float kLongestArrow = 0.6F;
constexpr float kUsualSize_m = 0.1F;
constexpr float kArrowTip_m = 0.0085F, kArrowRadius_m = 0.0038F;
constexpr float kShortestArrow_N = 0.03F;
constexpr float kOutline = 0.0019F, kLeastOutline_px = 0.75F;  // width of outlines, in heights of the picture
constexpr float kFrameWidth_m = 0.0022F;                       // of the frame on the active block
// Rise and radius of a dome, in radii of the tool: the rise of the virtual button (scenes/material/button_block.h),
// exaggerated like a dent, and a visible width.
constexpr float kDomeRise = 0.5F * kDeeperDents, kDomeRadius = 2.0F;
// Share of transmitted light, gloss, pores and lines of the grid, in the order of Finish.
struct Material {
  float translucent, gloss, pores, grid;
};
constexpr Material kMaterials[] = {{0.75F, 0.55F, 0.0F, 0.20F}, {0.25F, 0.06F, 0.30F, 0.10F},
                                   {1.00F, 1.00F, 0.0F, 0.12F}, {0.05F, 0.45F, 0.0F, 0.25F},
                                   {0.90F, 0.20F, 0.0F, 0.12F}, {0.30F, 0.50F, 0.0F, 0.14F}};
// Only the parts of the block's shader that the material needs: a software renderer computes both sides of a branch.
std::string definitions_of(Finish finish) {
  std::string lines;
  if (kMaterials[static_cast<std::size_t>(finish)].pores > 0.0F) lines += "#define PORES\n";
  if (finish == Finish::dome) lines += "#define DOME\n";
  return lines;
}

const glm::vec3 kLight = glm::normalize(glm::vec3(-0.35F, 0.85F, 0.45F));

// The tool, in units of the ball's radius, with the tip at y = 0: a polished ball on a stem, the disc of a force
// sensor, and a dull handle.
constexpr float kToolLength = 15.2F, kToolWidth = 1.44F;
std::vector<glm::vec2> ball_profile(const Detail& detail) {
  std::vector<glm::vec2> profile;
  const int steps = 2 * detail.around / 3;
  for (int i = 0; i <= steps; ++i) {
    const float share = static_cast<float>(i) / static_cast<float>(steps);
    const float angle = std::numbers::pi_v<float> * (share * 0.89F - 0.5F);
    profile.emplace_back(std::max(1e-4F, std::cos(angle)), 1.0F + std::sin(angle));
  }
  for (const glm::vec2 point : {glm::vec2(0.30F, 2.02F), glm::vec2(0.30F, 5.0F), glm::vec2(0.33F, 5.2F),
                                glm::vec2(0.80F, 5.9F), glm::vec2(0.86F, 6.1F)}) {
    profile.push_back(point);
  }
  return profile;
}
std::vector<glm::vec2> handle_profile() {
  std::vector<glm::vec2> profile{{0.9F, 7.0F}, {1.02F, 7.3F}, {1.04F, 8.0F}, {0.98F, 9.4F}, {1.10F, 12.6F}};
  for (int i = 0; i <= 8; ++i) {
    const float angle = 0.5F * std::numbers::pi_v<float> * static_cast<float>(i) / 8.0F;
    profile.emplace_back(std::max(1e-4F, 1.12F * std::cos(angle)), kToolLength - 1.12F + 1.12F * std::sin(angle));
  }
  return profile;
}

}  // namespace

// The two points of a corner of a profile differ slightly, because equal points have no normal.

BlockView::Bodies::Bodies(const BlockGeometry& block, float dome_m, const Detail& detail)
    : top(block_top(glm::vec2(block.width_m, block.length_m), detail)),
      sides(block_sides(glm::vec2(block.width_m, block.length_m), static_cast<float>(block.height_m) - dome_m, detail)),
      ball(lathe_mesh(ball_profile(detail), detail.around)),
      sensor(lathe_mesh(
          {{0.80F, 6.0F}, {1.36F, 6.001F}, {kToolWidth, 6.1F}, {kToolWidth, 6.9F}, {1.36F, 7.0F}, {0.9F, 7.001F}},
          detail.around)),
      handle(lathe_mesh(handle_profile(), detail.around)),
      shaft(lathe_mesh({{1e-4F, 0.0F}, {0.0014F, 1e-5F}, {0.0014F, 1.0F}}, detail.around / 2)),
      tip(lathe_mesh({{1e-4F, 0.0F}, {kArrowRadius_m, 1e-5F}, {0.0037F, 2e-4F}, {1e-4F, kArrowTip_m}}, detail.around)) {
}

Result<std::unique_ptr<BlockView>> BlockView::create(const Scene& scene, std::optional<Smoothing> smoothing) {
  const auto assets = find_assets();
  if (!assets) return assets.error();
  if (!smoothing) smoothing = smoothing_for(reinterpret_cast<const char*>(glGetString(GL_RENDERER)));
  struct Program {
    const char *vertex, *fragment;
    std::vector<std::string> parts = {"common"};
    std::string definitions = {};
  };
  std::vector<Program> programs = {
      {"block", "block", {"common", "dent"}, definitions_of(scene.finish)}, {"solid", "solid"}, {"table", "table"}};
  if (*smoothing == Smoothing::filter) {
    programs.push_back({"whole_view", "find_edges"});
    programs.push_back({"whole_view", "edges"});
  }
  std::vector<Shader> shaders;
  for (const auto& [vertex, fragment, parts, definitions] : programs) {
    auto shader = Shader::load(*assets + "/shaders", vertex, fragment, parts, definitions);
    if (!shader) return shader.error();
    shaders.push_back(std::move(*shader));
  }
  return std::unique_ptr<BlockView>(new BlockView(scene, std::move(shaders)));
}

// `shaders`: of the blocks, of other bodies, of the table, and with the edge filter two for it.
BlockView::BlockView(const Scene& scene, std::vector<Shader> shaders)
    : geometry_(scene.block),
      dome_m_(scene.finish == Finish::dome ? kDomeRise * static_cast<float>(scene.block.tool_radius_m) : 0.0F),
      finish_(scene.finish),
      block_colour_(hex(scene.block_colour)),
      tool_colour_(hex(0x9BA1A7)),
      size_m_(std::max(static_cast<float>(scene.block.width_m),
                       1.3F * kToolLength * static_cast<float>(scene.block.tool_radius_m))),
      arrow_m_per_N_(kStrongestArrow * size_m_ / static_cast<float>(scene.strongest_press_N)),
      arrow_width_(size_m_ / kUsualSize_m),
      block_shader_(std::move(shaders[0])),
      solid_shader_(std::move(shaders[1])),
      table_shader_(std::move(shaders[2])),
      fine_(scene.block, dome_m_, kFine),
      coarse_(scene.block, dome_m_, kCoarse),
      square_(square_mesh()),
      smooth_(shaders.size() > 3 ? std::optional(EdgeFilter{std::move(shaders[3]), std::move(shaders[4])})
                                 : std::nullopt) {
  show(1, true);
}

void BlockView::show(std::size_t count, bool at_once) {
  // With several blocks the camera is nearer to the front, so that no block hides another.
  if (count == 1) {
    camera_.frame(0.92F * size_m_, 0.5F, at_once);
  } else {
    camera_.frame((count == 2 ? 1.42F : 1.78F) * size_m_, 0.3F, at_once);
  }
}

float BlockView::outline_px() const {
  return std::max(kLeastOutline_px, kOutline * static_cast<float>(smooth_.height()));
}

float BlockView::arrow_length_m(const BlockPose& pose) const {
  return std::min(arrow_m_per_N_ * pose.force_N, kLongestArrow * size_m_);
}

glm::vec3 BlockView::place(std::size_t index, std::size_t count) const {
  const auto step = kBetween * static_cast<float>(geometry_.width_m);
  const float column = count == 1 ? 0.0F : index % 2 == 0 ? -0.5F : 0.5F;
  const float row = count < 3 ? 0.0F : index < 2 ? -0.5F : 0.5F;
  return {column * step, 0.0F, row * step};
}

glm::vec2 BlockView::on_screen(std::size_t index, std::size_t count, const glm::vec3& point,
                               const glm::vec2& size) const {
  return project(camera_.view_projection(size.x / size.y), place(index, count) + point, size);
}

float BlockView::depth_per_pixel(std::size_t index, std::size_t count, const glm::vec2& size) const {
  constexpr float kProbe_m = 0.01F;
  const float pixels =
      on_screen(index, count, {0.0F, -kProbe_m, 0.0F}, size).y - on_screen(index, count, {0.0F, 0.0F, 0.0F}, size).y;
  return kProbe_m / std::max(pixels, 1.0F);
}

void BlockView::begin(const Shader& shader) const {
  shader.use();
  shader.set("view_projection", view_projection_);
  shader.set("eye", camera_.eye());
  shader.set("light", kLight);
  shader.set("outline_width", outline_px());
}

const BlockView::Bodies& BlockView::bodies(std::size_t count, const Viewport& viewport) const {
  constexpr float kFineFrom_px = 420.0F;
  const glm::vec2 size(viewport.width, viewport.height);
  const glm::vec3 side(0.5F * static_cast<float>(geometry_.width_m), 0.0F, 0.0F);
  const float width_px = glm::length(on_screen(0, count, side, size) - on_screen(0, count, -side, size));
  return width_px < kFineFrom_px ? coarse_ : fine_;
}

void BlockView::draw(const std::vector<BlockPose>& blocks, const Viewport& viewport, Theme theme, float scale) {
  if (viewport.width < 1 || viewport.height < 1) return;
  view_projection_ = camera_.view_projection(static_cast<float>(viewport.width) / static_cast<float>(viewport.height));
  const Bodies& shown = bodies(blocks.size(), viewport);
  glDisable(GL_BLEND);
  glEnable(GL_CULL_FACE);
  smooth_.begin(viewport, scale);
  if (smooth_.filters()) {
    // The picture of the static parts is kept until something changes that it depends on.
    const Still now{view_projection_, smooth_.width(), smooth_.height(), blocks.size(), theme};
    if (now != still_) {
      smooth_.begin_still();
      draw_still(blocks.size(), shown, theme);
      smooth_.end_still();
      still_ = now;
    }
    smooth_.use_still(moving_parts(blocks));
  } else {
    draw_still(blocks.size(), shown, theme);
  }
  glEnable(GL_DEPTH_TEST);
  for (std::size_t i = 0; i < blocks.size(); ++i) draw_tool(blocks[i], place(i, blocks.size()), shown, theme);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    draw_top(blocks[i], place(i, blocks.size()), shown, blocks[i].chosen && blocks.size() > 1);
  }
  glDisable(GL_CULL_FACE);
  glDisable(GL_DEPTH_TEST);
  glBindVertexArray(0);
  smooth_.end();
}

// The parts of the picture that are drawn in each frame: the top of each block, and each tool with its arrow.
std::vector<Viewport> BlockView::moving_parts(const std::vector<BlockPose>& blocks) const {
  const auto half_x = 0.5F * static_cast<float>(geometry_.width_m),
             half_z = 0.5F * static_cast<float>(geometry_.length_m);
  const auto radius = static_cast<float>(geometry_.tool_radius_m);
  std::vector<Viewport> parts;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const BlockPose& pose = blocks[i];
    const glm::vec3 at = place(i, blocks.size());
    const float lowest = std::min(-pose.dent_m, -dome_m_);
    parts.push_back(part_around(at + glm::vec3(-half_x, lowest, -half_z), at + glm::vec3(half_x, 0.0F, half_z)));
    const float thick = kToolWidth * radius;
    parts.push_back(part_around(at + glm::vec3(-thick, -pose.tool_m, -thick),
                                at + glm::vec3(thick, kToolLength * radius - pose.tool_m, thick)));
    if (pose.force_N < kShortestArrow_N) continue;
    const glm::vec3 foot = at + arrow_foot(), head(arrow_width_ * kArrowRadius_m, 0.0F, arrow_width_ * kArrowRadius_m);
    parts.push_back(
        part_around(foot - head - glm::vec3(0.0F, dome_m_, 0.0F),
                    foot + head + glm::vec3(0.0F, arrow_length_m(pose) + arrow_width_ * kArrowTip_m, 0.0F)));
  }
  return parts;
}

// The part of the picture that contains a box and the pixels around it that the edge filter changes with it.
Viewport BlockView::part_around(const glm::vec3& low, const glm::vec3& high) const {
  const glm::vec2 size(smooth_.width(), smooth_.height());
  glm::vec2 least = size, most(0.0F);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 point((corner & 1) != 0 ? high.x : low.x, (corner & 2) != 0 ? high.y : low.y,
                          (corner & 4) != 0 ? high.z : low.z);
    const glm::vec2 pixel = project(view_projection_, point, size);
    least = glm::min(least, pixel);
    most = glm::max(most, pixel);
  }
  least = glm::clamp(glm::floor(least) - SmoothTarget::kReach_px, glm::vec2(0.0F), size);
  most = glm::clamp(glm::ceil(most) + SmoothTarget::kReach_px, least, size);
  return {static_cast<int>(least.x), static_cast<int>(size.y - most.y), static_cast<int>(most.x - least.x),
          static_cast<int>(most.y - least.y)};
}

void BlockView::draw_still(std::size_t count, const Bodies& bodies, Theme theme) const {
  const Rgb& background = palette(theme).background;
  glClearColor(background.r, background.g, background.b, 1.0F);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  draw_table(count, theme);
  glEnable(GL_DEPTH_TEST);
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec3 at = place(i, count) - glm::vec3(0.0F, dome_m_, 0.0F);
    begin_block({}, at);
    bodies.sides.draw();
    draw_outline(at, bodies, theme);
  }
  glDisable(GL_DEPTH_TEST);
}

// The inner faces of a slightly larger block, which are visible around the block.
void BlockView::draw_outline(const glm::vec3& at, const Bodies& bodies, Theme theme) const {
  const float pixel_m = 2.0F * glm::length(camera_.eye() - at) * std::tan(0.5F * Camera::kFieldOfView_rad) /
                        static_cast<float>(std::min(smooth_.width(), smooth_.height()));
  begin(solid_shader_);
  solid_shader_.set("offset", at);
  solid_shader_.set("stretch", glm::vec3(1.0F));
  solid_shader_.set("grown", outline_px() * pixel_m);
  solid_shader_.set("colour", palette(theme).edge);
  solid_shader_.set("shininess", 0.0F);
  solid_shader_.set("shaded", 0.0F);
  solid_shader_.set("outline_width", -1.0F);
  glCullFace(GL_FRONT);
  bodies.sides.draw();
  glCullFace(GL_BACK);
}

// The table is behind and below everything else, so it needs no depth test.
void BlockView::draw_table(std::size_t count, Theme theme) const {
  begin(table_shader_);
  table_shader_.set("table_y", -static_cast<float>(geometry_.height_m));
  table_shader_.set("reach", static_cast<float>(geometry_.width_m) * (count <= 1 ? 2.3F : 3.2F));
  table_shader_.set("table_colour", palette(theme).table);
  table_shader_.set("background", palette(theme).background);
  table_shader_.set("half_size", 0.5F * glm::vec2(geometry_.width_m, geometry_.length_m));
  glm::vec2 places[4];
  const std::size_t drawn = std::min<std::size_t>(count, std::size(places));
  for (std::size_t i = 0; i < drawn; ++i) places[i] = {place(i, count).x, place(i, count).z};
  table_shader_.set("block_count", static_cast<int>(drawn));
  table_shader_.set("blocks", places, static_cast<int>(drawn));
  square_.draw();
}

// Sets the common values of the shader for the top and the sides of a block.
void BlockView::begin_block(const DentShape& dent, const glm::vec3& at) const {
  const Material& material = kMaterials[static_cast<std::size_t>(finish_)];
  begin(block_shader_);
  block_shader_.set("offset", at);
  block_shader_.set("dent", dent.depth_m);
  block_shader_.set("contact", dent.contact_m);
  block_shader_.set("edge", dent.edge_m);
  block_shader_.set("tool_radius", static_cast<float>(geometry_.tool_radius_m));
  block_shader_.set("rim", 0.5F * static_cast<float>(std::min(geometry_.width_m, geometry_.length_m)));
  block_shader_.set("dome", 0.0F);
  block_shader_.set("dome_radius", kDomeRadius * static_cast<float>(geometry_.tool_radius_m));
  block_shader_.set("half_size", glm::vec3(0.5 * geometry_.width_m, geometry_.height_m, 0.5 * geometry_.length_m));
  block_shader_.set("colour", block_colour_);
  block_shader_.set("translucent", material.translucent);
  block_shader_.set("gloss", material.gloss);
  block_shader_.set("pores", material.pores);
  block_shader_.set("grid", material.grid);
  block_shader_.set("outline_colour", outline_on(block_colour_));
  block_shader_.set("mark", 0.0F);
  block_shader_.set("frame", 0.0F);
  block_shader_.set("tip", -1.0F);  // the tip is far above
  block_shader_.set("arrow", glm::vec3(0.0F));
}

void BlockView::draw_top(const BlockPose& pose, const glm::vec3& at, const Bodies& bodies, bool framed) const {
  begin_block(dent_under_ball(pose.dent_m, static_cast<float>(geometry_.tool_radius_m)), at);
  block_shader_.set("mark_colour", error_colour(static_cast<double>(pose.error_over_jnd)));
  // Shallow dents have no colour, because there is no error to show.
  block_shader_.set("mark", pose.shows_error ? 0.92F * glm::smoothstep(0.0001F, 0.0009F, pose.dent_m) : 0.0F);
  block_shader_.set("frame", framed ? kFrameWidth_m : 0.0F);
  block_shader_.set("frame_colour", pose.arrow);
  block_shader_.set("dome", dome_m_);
  block_shader_.set("tip", pose.tool_m);
  const glm::vec3 foot = arrow_foot();
  block_shader_.set("arrow", glm::vec3(foot.x, pose.force_N < kShortestArrow_N ? 0.0F : arrow_length_m(pose), foot.z));
  bodies.top.draw();
}

void BlockView::draw_tool(const BlockPose& pose, const glm::vec3& at, const Bodies& bodies, Theme theme) const {
  begin(solid_shader_);
  solid_shader_.set("offset", at - glm::vec3(0.0F, pose.tool_m, 0.0F));
  solid_shader_.set("stretch", glm::vec3(static_cast<float>(geometry_.tool_radius_m)));
  solid_shader_.set("grown", 0.0F);
  solid_shader_.set("outline_colour", outline_on(block_colour_));
  solid_shader_.set("glow", palette(theme).glow);
  solid_shader_.set("shaded", 1.0F);
  const auto part = [&](const GpuMesh& mesh, const Rgb& colour, float shininess) {
    solid_shader_.set("colour", colour);
    solid_shader_.set("shininess", shininess);
    mesh.draw();
  };
  part(bodies.ball, tool_colour_, 1.0F);
  part(bodies.sensor, glm::mix(tool_colour_, palette(theme).rubber, 0.5F), 0.6F);
  part(bodies.handle, palette(theme).rubber, 0.25F);
  if (pose.force_N < kShortestArrow_N) return;
  const glm::vec3 foot = at + arrow_foot() + glm::vec3(0.0F, 0.001F - dome_m_, 0.0F);
  const float length_m = arrow_length_m(pose);
  solid_shader_.set("colour", pose.arrow);
  solid_shader_.set("shininess", 0.0F);
  solid_shader_.set("shaded", 0.35F);
  solid_shader_.set("offset", foot);
  solid_shader_.set("stretch", glm::vec3(arrow_width_, length_m, arrow_width_));
  bodies.shaft.draw();
  solid_shader_.set("offset", foot + glm::vec3(0.0F, length_m, 0.0F));
  solid_shader_.set("stretch", glm::vec3(arrow_width_));
  bodies.tip.draw();
}

// The arrow is beside the tool in the view of the camera, so that neither hides the other.
glm::vec3 BlockView::arrow_foot() const {
  const glm::vec3 eye = camera_.eye();
  const glm::vec3 right = glm::normalize(glm::vec3(eye.z, 0.0F, -eye.x));
  return 3.2F * static_cast<float>(geometry_.tool_radius_m) * right;
}

}  // namespace palpate
