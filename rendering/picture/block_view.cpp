#include "rendering/picture/block_view.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>
#include <utility>

#include "scenes/scene/folders.h"

namespace palpate {
namespace {

constexpr float kYaw_rad = 0.16F, kPitch_rad = 0.30F;
constexpr float kLift_m = 0.012F;         // room above the tool between presses
constexpr float kLabel = 0.075F;          // height of the text below a block, in heights of the picture
constexpr float kStrongestArrow = 0.85F;  // for the scene's strongest press, in lengths of the tool
constexpr float kLongestArrow = 1.3F;
constexpr float kShortestArrow_N = 0.03F;
// In radii of the tool as drawn: the places of the arrows of the truth and of the model, and their half widths.
constexpr float kTrueArrow = 1.75F, kModelArrow = 2.75F, kTrueArrowWidth = 0.13F, kModelArrowWidth = 0.25F;
constexpr float kOutline = 0.0019F, kLeastOutline_px = 0.75F;  // width of outlines, in heights of the picture
constexpr float kLine = 0.0055F, kLeastLine_px = 2.5F;         // of the surface in the cut
// The depth of a dent decreases to 0 up to this share of the distance to the nearest side (dent.glsl).
constexpr float kMoves = 0.9F;
// Rise and radius of a dome, in radii of the tool: the rise of the virtual button (scenes/material/button_block.h),
// and a visible width.
constexpr float kDomeRise = 0.5F, kDomeRadius = 2.0F;
// Share of transmitted light, gloss, pores and lines of the grid, in the order of Finish.
struct Material {
  float translucent, gloss, pores, grid;
};
constexpr Material kMaterials[] = {{0.75F, 0.55F, 0.0F, 0.16F}, {0.25F, 0.06F, 0.30F, 0.08F},
                                   {1.00F, 1.00F, 0.0F, 0.10F}, {0.05F, 0.45F, 0.0F, 0.22F},
                                   {0.90F, 0.20F, 0.0F, 0.10F}, {0.30F, 0.50F, 0.0F, 0.12F}};

const glm::vec3 kLight = glm::normalize(glm::vec3(-0.35F, 0.85F, 0.45F));

// The tool, in units of the ball's radius, with the tip at y = 0: a polished ball on a stem, the disc of a force
// sensor, and a dull handle. The two points of a corner of a profile differ slightly, because equal points have no
// normal.
constexpr float kToolLength = 6.4F, kToolWidth = 1.16F;
std::vector<glm::vec2> ball_profile() {
  constexpr int kSteps = 30;
  std::vector<glm::vec2> profile;
  for (int i = 0; i <= kSteps; ++i) {
    const float angle = std::numbers::pi_v<float> * (static_cast<float>(i) / static_cast<float>(kSteps) * 0.88F - 0.5F);
    profile.emplace_back(std::max(1e-4F, std::cos(angle)), 1.0F + std::sin(angle));
  }
  for (const glm::vec2 point : {glm::vec2(0.36F, 2.03F), glm::vec2(0.36F, 2.7F), glm::vec2(0.42F, 2.8F),
                                glm::vec2(0.80F, 3.1F), glm::vec2(0.84F, 3.2F)}) {
    profile.push_back(point);
  }
  return profile;
}
const std::vector<glm::vec2> kSensor{{0.80F, 3.2F},       {1.10F, 3.201F}, {kToolWidth, 3.27F},
                                     {kToolWidth, 3.72F}, {1.10F, 3.8F},   {0.8F, 3.801F}};
std::vector<glm::vec2> handle_profile() {
  std::vector<glm::vec2> profile{{0.78F, 3.8F}, {0.84F, 4.0F}, {0.80F, 4.5F}, {0.86F, 5.6F}};
  for (int i = 0; i <= 8; ++i) {
    const float angle = 0.5F * std::numbers::pi_v<float> * static_cast<float>(i) / 8.0F;
    profile.emplace_back(std::max(1e-4F, 0.86F * std::cos(angle)), kToolLength - 0.7F + 0.7F * std::sin(angle));
  }
  return profile;
}

glm::vec2 size_of(const BlockGeometry& block) { return {block.width_m, block.length_m}; }
float rim_of(const BlockGeometry& block) { return 0.5F * static_cast<float>(std::min(block.width_m, block.length_m)); }

Viewport grown(const glm::vec2& low, const glm::vec2& high, const glm::vec2& most) {
  constexpr float kMargin_px = 2.0F;  // of antialiasing
  const glm::vec2 from = glm::clamp(glm::floor(low - kMargin_px), glm::vec2(0.0F), most);
  const glm::vec2 to = glm::clamp(glm::ceil(high + kMargin_px), from, most);
  return {static_cast<int>(from.x), static_cast<int>(from.y), static_cast<int>(to.x - from.x),
          static_cast<int>(to.y - from.y)};
}

}  // namespace

Result<std::unique_ptr<BlockView>> BlockView::create(const Scene& scene, float magnified) {
  const auto assets = find_assets();
  if (!assets) return assets.error();
  // Only the parts of the block's shader that the material needs: a software renderer computes both sides of a branch.
  std::string material;
  if (kMaterials[static_cast<std::size_t>(scene.finish)].pores > 0.0F) material += "#define PORES\n";
  if (scene.finish == Finish::dome) material += "#define DOME\n";
  const std::vector<std::string> body{"common"}, surface{"common", "dent"}, soft{"common", "dent", "material"};
  struct Program {
    const char *vertex, *fragment;
    std::vector<std::string> parts;
    std::string definitions = {};
  };
  const std::vector<Program> programs = {{"block", "block", soft, material + "#define TOP\n"},
                                         {"section", "section", soft, material},
                                         {"block", "block", soft, material},
                                         {"solid", "solid", body},
                                         {"table", "table", body},
                                         {"line", "line", surface, material},
                                         {"flat", "arrow", {}},
                                         {"flat", "halo", {}},
                                         {"flat", "sprite", {}}};
  std::vector<Shader> made;
  for (const auto& [vertex, fragment, parts, definitions] : programs) {
    auto shader = Shader::load(*assets + "/shaders", vertex, fragment, parts, definitions);
    if (!shader) return shader.error();
    made.push_back(std::move(*shader));
  }
  Shaders shaders{std::move(made[0]), std::move(made[1]), std::move(made[2]), std::move(made[3]), std::move(made[4]),
                  std::move(made[5]), std::move(made[6]), std::move(made[7]), std::move(made[8])};
  return std::unique_ptr<BlockView>(new BlockView(scene, magnified, std::move(shaders)));
}

BlockView::BlockView(const Scene& scene, float magnified, Shaders shaders)
    : geometry_(scene.block),
      magnified_(magnified),
      radius_m_(magnified * static_cast<float>(scene.block.tool_radius_m)),
      dome_m_(scene.finish == Finish::dome ? kDomeRise * radius_m_ : 0.0F),
      middle_m_(std::min(kMoves * rim_of(geometry_), rim_of(geometry_) - kEdge_m)),
      finish_(scene.finish),
      block_colour_(hex(scene.block_colour)),
      arrow_m_per_N_(kStrongestArrow * kToolLength * radius_m_ / static_cast<float>(scene.strongest_press_N)),
      shaders_(std::move(shaders)),
      top_(block_top(size_of(geometry_), 96, finish_ == Finish::dome ? 48 : 24)),
      sides_(block_sides(size_of(geometry_), static_cast<float>(geometry_.height_m), -dome_m_, 96)),
      section_(block_section(0.5F * size_of(geometry_).x, 0.5F * size_of(geometry_).x,
                             static_cast<float>(geometry_.height_m), 0.0F, 160)),
      square_(square_mesh()),
      ball_(lathe_mesh(ball_profile(), 40)),
      sensor_(lathe_mesh(kSensor, 40)),
      handle_(lathe_mesh(handle_profile(), 40)),
      middle_(block_middle(middle_m_, 14, finish_ == Finish::dome ? 16 : 11)),
      moving_section_(block_section(middle_m_, 0.5F * size_of(geometry_).x,
                                    0.97F * static_cast<float>(geometry_.height_m), 0.0F, 40)),
      line_(line_mesh(middle_m_, 40)) {
  show(1, glm::vec2(1.0F), true);
}

// The arrangement in which the blocks are largest.
BlockView::Cells BlockView::cells(std::size_t count, const glm::vec2& size) const {
  const float height = size.y * (1.0F - above_ - below_);
  const float high_m = kToolLength * radius_m_ + kLift_m + static_cast<float>(geometry_.height_m);
  Cells best;
  float largest = 0.0F;
  for (std::size_t columns = 1; columns <= count; ++columns) {
    const std::size_t rows = (count + columns - 1) / columns;
    const glm::vec2 one =
        glm::floor(glm::vec2(size.x / static_cast<float>(columns), height / static_cast<float>(rows)));
    const float label = kLabel * size.y;
    const float scale = std::min(one.x / static_cast<float>(geometry_.width_m), (one.y - label) / high_m);
    if (scale <= largest) continue;
    largest = scale;
    best = {columns, rows, one, std::round(size.y * above_), label};
  }
  return best;
}

// The upper left corner of a cell. A row with fewer blocks is in the middle.
glm::vec2 BlockView::corner(std::size_t index, std::size_t count, const Cells& cells, const glm::vec2& size) const {
  const std::size_t row = index / cells.columns;
  const std::size_t in_row = std::min(cells.columns, count - row * cells.columns);
  const float left = 0.5F * (size.x - static_cast<float>(in_row) * cells.size.x);
  return glm::floor(glm::vec2(left + static_cast<float>(index % cells.columns) * cells.size.x,
                              cells.top + static_cast<float>(row) * cells.size.y));
}

void BlockView::show(std::size_t count, const glm::vec2& size, bool at_once) {
  const Cells grid = cells(count, size);
  const auto half_x = 0.5F * static_cast<float>(geometry_.width_m),
             half_z = 0.5F * static_cast<float>(geometry_.length_m);
  // The extent seen from the camera, without perspective; the margins are for it.
  const float high =
      std::max((kToolLength * radius_m_ + kLift_m) * std::cos(kPitch_rad), half_z * std::sin(kPitch_rad));
  const float low = -static_cast<float>(geometry_.height_m) * std::cos(kPitch_rad);
  const float wide = 2.0F * (half_x * std::cos(kYaw_rad) + 0.5F * half_z * std::sin(kYaw_rad));
  const float px_per_m = std::min((grid.size.y - grid.label) / (1.06F * (high - low)), grid.size.x / (1.12F * wide));
  const float radius_m = 0.5F * std::min(grid.size.x, grid.size.y) / px_per_m;
  const float height_m = (0.5F * (high + low) - 0.5F * grid.label / px_per_m) / std::cos(kPitch_rad);
  camera_.frame(radius_m, height_m, kYaw_rad, kPitch_rad, at_once);
}

glm::vec2 BlockView::on_screen(std::size_t index, std::size_t count, const glm::vec3& point,
                               const glm::vec2& size) const {
  const Cells grid = cells(count, size);
  return corner(index, count, grid, size) +
         project(camera_.view_projection(grid.size.x / grid.size.y), point, grid.size);
}

glm::vec2 BlockView::foot(std::size_t index, std::size_t count, const glm::vec2& size) const {
  return on_screen(index, count, {0.0F, -static_cast<float>(geometry_.height_m), 0.0F}, size);
}

float BlockView::width_of_one(std::size_t count, const glm::vec2& size) const { return cells(count, size).size.x; }

float BlockView::depth_per_pixel(std::size_t index, std::size_t count, const glm::vec2& size) const {
  constexpr float kProbe_m = 0.01F;
  const float pixels =
      on_screen(index, count, {0.0F, -kProbe_m, 0.0F}, size).y - on_screen(index, count, {0.0F, 0.0F, 0.0F}, size).y;
  return kProbe_m / std::max(pixels, 1.0F);
}

// A depth as drawn. It ends above the bottom of the block.
float BlockView::drawn_m(float depth_m) const {
  const float deepest_m = 0.7F * static_cast<float>(geometry_.height_m);
  return depth_m > 0.0F ? std::min(magnified_ * depth_m, std::max(depth_m, deepest_m)) : depth_m;
}

float BlockView::outline_px() const { return std::max(kLeastOutline_px, kOutline * static_cast<float>(still_.height)); }

float BlockView::arrow_px(float force_N) const {
  return px_per_m_ * std::min(arrow_m_per_N_ * force_N, kLongestArrow * kToolLength * radius_m_);
}

float BlockView::opacity_of_error(const BlockPose& pose) const {
  // Shallow dents have no colour, because there is no error to show.
  return pose.shows_error ? 0.92F * glm::smoothstep(0.0001F, 0.0009F, drawn_m(pose.dent_m)) : 0.0F;
}

// Radius of the halo in pixels, which grows with the error; 0: none.
float BlockView::halo_px(const BlockPose& pose) const {
  if (!(pose.error_over_jnd > 1.0F) || opacity_of_error(pose) <= 0.0F) return 0.0F;
  return radius_m_ * px_per_m_ * (1.45F + 0.8F * std::min(pose.error_over_jnd - 1.0F, 2.5F));
}

glm::vec2 BlockView::in_cell(const glm::vec3& point) const {
  const glm::vec2 flipped = project(view_projection_, point, cell_);
  return {flipped.x, cell_.y - flipped.y};
}

// The part of a cell that contains a box.
Viewport BlockView::part_around(const glm::vec3& low, const glm::vec3& high) const {
  glm::vec2 least = cell_, most(0.0F);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec2 pixel = in_cell(
        {(corner & 1) != 0 ? high.x : low.x, (corner & 2) != 0 ? high.y : low.y, (corner & 4) != 0 ? high.z : low.z});
    least = glm::min(least, pixel);
    most = glm::max(most, pixel);
  }
  return grown(least, most, cell_);
}

// The parts of a cell that are drawn in each frame: the block without its rim, and the tool with arrows and halo.
std::vector<Viewport> BlockView::moving_parts(const BlockPose& pose) const {
  const glm::vec2 tip = in_cell({0.0F, -drawn_m(pose.tool_m), 0.0F});
  const float arrows = std::max(pose.force_N, pose.shows_truth ? pose.true_force_N : 0.0F);
  const glm::vec2 surface = in_cell({0.0F, 0.0F, 0.0F});
  const float line = 0.5F * kLine * cell_.y + kLeastLine_px;
  glm::vec2 low = tip + tool_low_, high = tip + tool_high_;
  if (arrows > kShortestArrow_N) {
    low = glm::min(low, surface - glm::vec2(0.0F, arrow_px(arrows) + line));
    high = glm::max(high, surface + glm::vec2(radius_m_ * px_per_m_ * (kModelArrow + 3.0F * kModelArrowWidth), line));
  }
  const float halo = halo_px(pose);
  const glm::vec2 ball = in_cell({0.0F, radius_m_ - drawn_m(pose.dent_m), 0.0F});
  Viewport block =
      part_around({-middle_m_, -static_cast<float>(geometry_.height_m), -middle_m_}, {middle_m_, 0.0F, 0.0F});
  block = around_both(block, grown(surface - line, surface + line, cell_));
  std::vector<Viewport> parts{block, grown(low, high, cell_)};
  if (halo > 0.0F) parts.push_back(grown(ball - halo - line, ball + halo + line, cell_));
  return parts;
}

// From pixels of the picture to the window, whose origin is at the lower left.
Viewport BlockView::in_window(const Viewport& part) const {
  const int wide = viewport_.width, high = viewport_.height, width = pixels_.width(), height = pixels_.height();
  const int left = part.x * wide / width, right = ((part.x + part.width) * wide + width - 1) / width;
  const int top = part.y * high / height, low = ((part.y + part.height) * high + height - 1) / height;
  // With a margin of the pixels into which the outermost ones are interpolated.
  const int margin = width != wide || height != high ? 2 : 0;
  return common_part(viewport_, {viewport_.x + left - margin, viewport_.y + high - low - margin,
                                 right - left + 2 * margin, low - top + 2 * margin});
}

void BlockView::copy_to_window(const Viewport& part) const {
  const int wide = viewport_.width, high = viewport_.height;
  if (wide < 1 || high < 1) return;
  const Viewport whole{0, 0, pixels_.width(), pixels_.height()};
  glEnable(GL_SCISSOR_TEST);
  glScissor(part.x, part.y, part.width, part.height);
  if (whole.width == wide && whole.height == high) {
    const Viewport from{part.x - viewport_.x, high - (part.y - viewport_.y) - part.height, part.width, part.height};
    pixels_.copy_to(nullptr, from, part);
  } else {
    pixels_.copy_to(nullptr, whole, viewport_);
  }
  glDisable(GL_SCISSOR_TEST);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

std::vector<Viewport> BlockView::draw(const std::vector<BlockPose>& blocks, const Viewport& viewport, Theme theme,
                                      float scale, bool all) {
  if (viewport.width < 1 || viewport.height < 1 || blocks.empty()) return {};
  const auto scaled = [scale](int size) {
    return std::max(1, static_cast<int>(std::round(scale * static_cast<float>(size))));
  };
  const int width = scaled(viewport.width), height = scaled(viewport.height);
  all = all || viewport != viewport_;
  viewport_ = viewport;
  const glm::vec2 size(width, height);
  const Cells grid = cells(blocks.size(), size);
  cell_ = grid.size;
  view_projection_ =
      glm::scale(glm::mat4(1.0F), glm::vec3(1.0F, -1.0F, 1.0F)) * camera_.view_projection(cell_.x / cell_.y);
  px_per_m_ = glm::length(in_cell({0.0F, 0.01F, 0.0F}) - in_cell(glm::vec3(0.0F))) / 0.01F;
  glFrontFace(GL_CW);  // the first row is the upper one
  const Still now{view_projection_, width, height, blocks.size(), theme, above_, below_};
  if (now != still_) {
    still_ = now;
    all = true;
    pixels_.draw_into(width, height);
    draw_still(blocks.size(), theme);
  }
  pixels_.draw_into(width, height);
  std::vector<Viewport> changed;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (i < drawn_.size() && drawn_[i] == blocks[i]) continue;
    const glm::vec2 at = corner(i, blocks.size(), grid, size);
    const int x = static_cast<int>(at.x), y = static_cast<int>(at.y);
    const std::vector<Viewport> parts = moving_parts(blocks[i]);
    std::vector<Viewport> drawn = parts;
    if (i < drawn_parts_.size()) {
      for (std::size_t k = 0; k < drawn_parts_[i].size(); ++k) {
        if (k < drawn.size()) {
          drawn[k] = around_both(drawn[k], drawn_parts_[i][k]);
        } else {
          drawn.push_back(drawn_parts_[i][k]);
        }
      }
    }
    drawn_parts_.resize(blocks.size());
    drawn_parts_[i] = parts;
    for (Viewport& part : drawn) {
      part.x += x;
      part.y += y;
      still_pixels_.copy_to(&pixels_, part, part);
      changed.push_back(in_window(part));
    }
    pixels_.draw_into(width, height);
    glViewport(x, y, static_cast<int>(cell_.x), static_cast<int>(cell_.y));
    draw_moving(blocks[i]);
  }
  drawn_ = blocks;
  glFrontFace(GL_CCW);
  glBindVertexArray(0);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  if (all) changed = {viewport};
  for (const Viewport& part : changed) copy_to_window(part);
  return changed;
}

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
  shader.set("half_size", glm::vec3(0.5 * geometry_.width_m, geometry_.height_m, 0.5 * geometry_.length_m));
  shader.set("colour", block_colour_);
  shader.set("translucent", material.translucent);
  shader.set("gloss", material.gloss);
  shader.set("pores", material.pores);
  shader.set("grid", material.grid);
  shader.set("mark", 0.0F);
  shader.set("tip", -1.0F);  // the tip is far above
  set_dent(shader, 0.0F);
}

void BlockView::set_dent(const Shader& shader, float depth_m) const {
  const DentShape dent = dent_under_ball(drawn_m(depth_m), radius_m_);
  shader.set("dent", dent.depth_m);
  shader.set("contact", dent.contact_m);
  shader.set("edge", dent.edge_m);
  shader.set("tool_radius", radius_m_);
  shader.set("rim", rim_of(geometry_));
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
  const Viewport whole{0, 0, still_.width, still_.height};
  still_pixels_.copy_to(&pixels_, whole, whole);
  drawn_.clear();
  drawn_parts_.clear();
}

// The static parts of a block, with its surface at rest.
void BlockView::draw_cell(Theme theme) {
  // The table is behind and below everything else, so it needs no depth test.
  const auto width = static_cast<float>(geometry_.width_m), length = static_cast<float>(geometry_.length_m);
  begin(shaders_.table);
  shaders_.table.set("table_y", -static_cast<float>(geometry_.height_m));
  shaders_.table.set("reach", std::min(0.8F * std::max(width, length), 0.5F * cell_.x / px_per_m_));
  shaders_.table.set("table_colour", palette(theme).table);
  shaders_.table.set("background", palette(theme).background);
  shaders_.table.set("half_size", 0.5F * glm::vec2(width, length));
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
  set_error(shaders_.section, pose);
  moving_section_.draw();
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
  const auto height = static_cast<float>(still_.height);
  const float width = std::max(kLeastLine_px, kLine * height), rim = std::max(0.8F, 0.25F * width);
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
  const float radius = radius_m_ * px_per_m_, height = arrow_px(force_N);
  const float outline = outline_px();
  const float half = std::max(1.2F, half_width * radius);
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
