#include "rendering/picture/block_view.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <numbers>
#include <utility>

namespace palpate {
namespace {

constexpr float kYaw_rad = 0.16F, kPitch_rad = 0.30F;
constexpr float kLift_m = 0.012F;         // room above the tool between presses
constexpr float kLabel = 0.075F;          // height of the text below a block, in heights of the picture
constexpr float kStrongestArrow = 0.85F;  // for the scene's strongest press, in lengths of the tool
constexpr float kOutline = 0.0019F, kLeastOutline_px = 0.75F;  // width of outlines, in heights of the picture
// The depth of a dent decreases to 0 up to this share of the distance to the nearest side (dent.glsl).
constexpr float kMoves = 0.9F;
// Rise of a dome, in radii of the tool: that of the virtual button (scenes/material/material_laws.h).
constexpr float kDomeRise = 0.5F;
// The tool, in units of the ball's radius, with the tip at y = 0: a polished ball on a stem, the disc of a force
// sensor, and a dull handle. The two points of a corner of a profile differ slightly, because equal points have no
// normal.
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
const std::vector<glm::vec2> kSensor{{0.80F, 3.2F},  {1.10F, 3.201F}, {1.16F, 3.27F},
                                     {1.16F, 3.72F}, {1.10F, 3.8F},   {0.8F, 3.801F}};
std::vector<glm::vec2> handle_profile(float top) {
  std::vector<glm::vec2> profile{{0.78F, 3.8F}, {0.84F, 4.0F}, {0.80F, 4.5F}, {0.86F, 5.6F}};
  for (int i = 0; i <= 8; ++i) {
    const float angle = 0.5F * std::numbers::pi_v<float> * static_cast<float>(i) / 8.0F;
    profile.emplace_back(std::max(1e-4F, 0.86F * std::cos(angle)), top - 0.7F + 0.7F * std::sin(angle));
  }
  return profile;
}

}  // namespace

Result<std::unique_ptr<BlockView>> BlockView::create(const Scene& scene, float magnified) {
  const auto assets = find_assets();
  if (!assets) return assets.error();
  // Only the parts of the block's shader that the material needs: a software renderer computes both sides of a branch.
  std::string material;
  if (scene.finish == Finish::foam) material += "#define PORES\n";
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
    : size_m_(scene.block.width_m, scene.block.height_m, scene.block.length_m),
      magnified_(magnified),
      radius_m_(magnified * static_cast<float>(scene.block.tool_radius_m)),
      dome_m_(scene.finish == Finish::dome ? kDomeRise * radius_m_ : 0.0F),
      rim_m_(0.5F * std::min(size_m_.x, size_m_.z)),
      middle_m_(std::min(kMoves * rim_m_, rim_m_ - kEdge_m)),
      low_m_(-size_m_.y * std::cos(kPitch_rad)),
      high_m_(std::max((kToolLength * radius_m_ + kLift_m) * std::cos(kPitch_rad),
                       0.5F * size_m_.z * std::sin(kPitch_rad))),
      wide_m_(size_m_.x * std::cos(kYaw_rad) + 0.5F * size_m_.z * std::sin(kYaw_rad)),
      finish_(scene.finish),
      block_colour_(hex(scene.block_colour)),
      arrow_m_per_N_(kStrongestArrow * kToolLength * radius_m_ / static_cast<float>(scene.strongest_press_N)),
      shaders_(std::move(shaders)),
      top_(block_top({size_m_.x, size_m_.z}, 96, finish_ == Finish::dome ? 48 : 24)),
      sides_(block_sides({size_m_.x, size_m_.z}, size_m_.y, -dome_m_, 96)),
      section_(block_section(0.5F * size_m_.x, 0.5F * size_m_.x, size_m_.y, 160)),
      square_(square_mesh()),
      ball_(lathe_mesh(ball_profile(), 40)),
      sensor_(lathe_mesh(kSensor, 40)),
      handle_(lathe_mesh(handle_profile(kToolLength), 40)),
      middle_(block_middle(middle_m_, 12, finish_ == Finish::dome ? 14 : 9)),
      moving_section_(block_section(middle_m_, 0.5F * size_m_.x, 0.97F * size_m_.y, 28)),
      line_(line_mesh(middle_m_, 28)) {
  show(1, glm::vec2(1.0F), true);
}

// The arrangement in which the blocks are largest.
BlockView::Cells BlockView::cells(std::size_t count, const glm::vec2& size) const {
  const float height = size.y * (1.0F - above_ - below_);
  Cells best;
  float largest = 0.0F;
  for (std::size_t columns = one_row_ ? count : 1; columns <= count; ++columns) {
    const std::size_t rows = (count + columns - 1) / columns;
    const glm::vec2 one =
        glm::floor(glm::vec2(size.x / static_cast<float>(columns), height / static_cast<float>(rows)));
    const Cells now{columns, rows, one, std::round(size.y * above_), kLabel * size.y};
    if (scale(now) <= largest) continue;
    largest = scale(now);
    best = now;
  }
  return best;
}

// Pixels per metre with which a block and its tool fill a cell; the margins are for perspective.
float BlockView::scale(const Cells& cells) const {
  return std::min((cells.size.y - cells.label) / (1.06F * (high_m_ - low_m_)), cells.size.x / (1.12F * wide_m_));
}

// The upper left corner of a cell. A row with fewer blocks is in the middle.
glm::vec2 BlockView::corner(std::size_t index, std::size_t count, const Cells& cells, const glm::vec2& size) const {
  const std::size_t row = index / cells.columns;
  const std::size_t in_row = std::min(cells.columns, count - row * cells.columns);
  const float left = 0.5F * (size.x - static_cast<float>(in_row) * cells.size.x);
  return glm::floor(glm::vec2(left + static_cast<float>(index % cells.columns) * cells.size.x,
                              cells.top + static_cast<float>(row) * cells.size.y));
}

std::size_t BlockView::cell_at(const glm::vec2& point, std::size_t count, const glm::vec2& size) const {
  const Cells grid = cells(count, size);
  const float row = std::max(0.0F, (point.y - grid.top) / std::max(grid.size.y, 1.0F));
  const std::size_t first = std::min(static_cast<std::size_t>(row), grid.rows - 1) * grid.columns;
  const std::size_t end = std::min(first + grid.columns, count);
  const float left = corner(first, count, grid, size).x;
  const float column = std::max(0.0F, (point.x - left) / std::max(grid.size.x, 1.0F));
  return std::min(first + static_cast<std::size_t>(column), end - 1);
}

void BlockView::show(std::size_t count, const glm::vec2& size, bool at_once) {
  const Cells grid = cells(count, size);
  const float px_per_m = scale(grid);
  const float radius_m = 0.5F * std::min(grid.size.x, grid.size.y) / px_per_m;
  const float height_m = (0.5F * (high_m_ + low_m_) - 0.5F * grid.label / px_per_m) / std::cos(kPitch_rad);
  camera_.frame(radius_m, height_m, kYaw_rad, kPitch_rad, at_once);
}

glm::vec2 BlockView::on_screen(std::size_t index, std::size_t count, const glm::vec3& point,
                               const glm::vec2& size) const {
  const Cells grid = cells(count, size);
  return corner(index, count, grid, size) +
         project(camera_.view_projection(grid.size.x / grid.size.y), point, grid.size);
}

glm::vec2 BlockView::foot(std::size_t index, std::size_t count, const glm::vec2& size) const {
  return on_screen(index, count, {0.0F, -size_m_.y, 0.0F}, size);
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
  const float deepest_m = 0.7F * size_m_.y;
  return depth_m > 0.0F ? std::min(magnified_ * depth_m, std::max(depth_m, deepest_m)) : depth_m;
}

float BlockView::outline_px() const { return std::max(kLeastOutline_px, kOutline * static_cast<float>(still_.height)); }

float BlockView::opacity_of_error(const BlockPose& pose) const {
  // Shallow dents have no colour, because there is no error to show.
  return pose.shows_error ? 0.92F * glm::smoothstep(0.0003F, 0.0012F, drawn_m(pose.dent_m)) : 0.0F;
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
  constexpr float kMargin_px = 2.0F;  // of antialiasing
  const glm::vec2 from = glm::clamp(glm::floor(least - kMargin_px), glm::vec2(0.0F), cell_);
  const glm::vec2 to = glm::clamp(glm::ceil(most + kMargin_px), from, cell_);
  return {static_cast<int>(from.x), static_cast<int>(from.y), static_cast<int>(to.x - from.x),
          static_cast<int>(to.y - from.y)};
}

void BlockView::draw(const std::vector<BlockPose>& blocks, const Viewport& viewport, Theme theme, bool new_texts,
                     const std::function<void()>& texts) {
  if (viewport.width < 1 || viewport.height < 1 || blocks.empty()) return;
  const int width = viewport.width, height = viewport.height;
  const glm::vec2 size(width, height);
  const Cells grid = cells(blocks.size(), size);
  cell_ = glm::max(grid.size, 1.0F);
  view_projection_ =
      glm::scale(glm::mat4(1.0F), glm::vec3(1.0F, -1.0F, 1.0F)) * camera_.view_projection(cell_.x / cell_.y);
  px_per_m_ = glm::length(in_cell({0.0F, 0.01F, 0.0F}) - in_cell(glm::vec3(0.0F))) / 0.01F;
  glFrontFace(GL_CW);  // the first row is the upper one
  const Still now{view_projection_, width, height, blocks.size(), theme, above_, below_};
  const Viewport whole{0, 0, width, height};
  const bool moved = now != still_;
  if (moved) {
    still_ = now;
    draw_still(blocks.size(), theme);
  }
  if (moved || new_texts) {
    lettered_.draw_into(width, height);
    still_pixels_.copy_to(&lettered_, whole, whole);
    lettered_.draw_into(width, height);
    if (texts) texts();
  }
  pixels_.draw_into(width, height);
  lettered_.copy_to(&pixels_, whole, whole);
  pixels_.draw_into(width, height);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const glm::vec2 at = corner(i, blocks.size(), grid, size);
    glViewport(static_cast<int>(at.x), static_cast<int>(at.y), static_cast<int>(cell_.x), static_cast<int>(cell_.y));
    draw_moving(blocks[i]);
  }
  glFrontFace(GL_CCW);
  glBindVertexArray(0);
  pixels_.copy_to(nullptr, whole, viewport);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

namespace {

// The camera is never below the table, and stays before the front of the blocks, where they are cut open.
constexpr float kLowest_rad = 0.06F;
constexpr float kHighest_rad = 0.95F;
constexpr float kWidest_rad = 0.7F;
constexpr float kEasing_s = 0.12F;
constexpr float kNear_m = 0.02F;
constexpr float kFar_m = 6.0F;

}  // namespace

void Camera::frame(float radius_m, float height_m, float yaw_rad, float pitch_rad, bool at_once) {
  radius_m_ = radius_m;
  framed_ = {yaw_rad, pitch_rad, radius_m / std::tan(0.5F * kFieldOfView_rad), height_m};
  aim();
  if (at_once) now_ = target_;
}

void Camera::turn(const CameraTurn& turn) {
  turn_ = turn;
  aim();
}

// Limits the turn as well, so that a turn back has an effect at once.
void Camera::aim() {
  target_ = {std::clamp(framed_[0] + turn_.yaw_rad, -kWidest_rad, kWidest_rad),
             std::clamp(framed_[1] + turn_.pitch_rad, kLowest_rad, kHighest_rad),
             std::clamp(framed_[2] * turn_.distance, 1.6F * radius_m_, 12.0F * radius_m_), framed_[3]};
  turn_ = {target_[0] - framed_[0], target_[1] - framed_[1], target_[2] / framed_[2]};
}

void Camera::orbit(float yaw_rad, float pitch_rad) {
  turn({turn_.yaw_rad + yaw_rad, turn_.pitch_rad + pitch_rad, turn_.distance});
}

void Camera::zoom(float factor) { turn({turn_.yaw_rad, turn_.pitch_rad, turn_.distance * factor}); }

void Camera::advance(float seconds) {
  // Less than a tenth of a pixel in a picture of 1080 lines; the parts at rest are drawn until it ends.
  constexpr float kEnd = 1e-4F;
  now_ += (1.0F - std::exp(-std::max(0.0F, seconds) / kEasing_s)) * (target_ - now_);
  const glm::vec4 near = kEnd * glm::vec4(1.0F, 1.0F, target_[2], target_[2]);
  if (glm::all(glm::lessThan(glm::abs(target_ - now_), near))) now_ = target_;
}

glm::vec3 Camera::eye() const {
  const float flat_m = now_[2] * std::cos(now_[1]);
  return {flat_m * std::sin(now_[0]), now_[3] + now_[2] * std::sin(now_[1]), flat_m * std::cos(now_[0])};
}

glm::mat4 Camera::view_projection(float aspect) const {
  // In a tall viewport the field of view is that of the width.
  const float vertical =
      aspect >= 1.0F ? kFieldOfView_rad : 2.0F * std::atan(std::tan(0.5F * kFieldOfView_rad) / aspect);
  return glm::perspective(vertical, aspect, kNear_m, kFar_m) *
         glm::lookAt(eye(), glm::vec3(0.0F, now_[3], 0.0F), glm::vec3(0.0F, 1.0F, 0.0F));
}

glm::vec2 project(const glm::mat4& view_projection, const glm::vec3& world, const glm::vec2& size) {
  const glm::vec4 clip = view_projection * glm::vec4(world, 1.0F);
  if (clip.w <= 0.0F) return {-1e6F, -1e6F};
  return {(0.5F + 0.5F * clip.x / clip.w) * size.x, (0.5F - 0.5F * clip.y / clip.w) * size.y};
}

}  // namespace palpate
