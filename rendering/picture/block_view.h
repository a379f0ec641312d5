// The 3-D view: blocks, each in a picture of its own and cut open at the front, with a probe in the cut. All are seen
// by the same camera, so that equal presses look equal. It depends on neither models nor session. Thread guarantee: the
// thread of the OpenGL context.
#pragma once

#include <functional>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <vector>

#include "engine/base/result.h"
#include "rendering/picture/gpu.h"
#include "rendering/ui/colours.h"
#include "scenes/scene/scene.h"

namespace palpate {

// The user's rotation and zoom relative to the basic view. They are kept when the basic view changes.
struct CameraTurn {
  float yaw_rad = 0.0F;
  float pitch_rad = 0.0F;
  float distance = 1.0F;  // factor
};

// A camera that orbits a point above the table within limits and moves smoothly to its target.
class Camera {
 public:
  static constexpr float kFieldOfView_rad = 0.55F;  // of the smaller side of the picture

  // Sets the basic view: what is within `radius_m` of the point at `height_m` above the middle fills the picture, seen
  // from `yaw_rad` to the right of the front and `pitch_rad` above it. `at_once`: without a transition.
  void frame(float radius_m, float height_m, float yaw_rad, float pitch_rad, bool at_once);
  void orbit(float yaw_rad, float pitch_rad);
  void zoom(float factor);
  void go_home() { turn({}); }
  void turn(const CameraTurn& turn);
  // Moves towards the target, with a time constant of 0.12 s.
  void advance(float seconds);

  glm::vec3 eye() const;
  glm::mat4 view_projection(float aspect) const;

 private:
  // Yaw and pitch, rad; distance, and height of the point, m.
  using Pose = glm::vec4;
  void aim();  // computes `target_` from `framed_` and `turn_`
  Pose now_{0.0F, 0.3F, 0.4F, 0.0F}, target_ = now_, framed_ = now_;
  CameraTurn turn_;
  float radius_m_ = 0.1F;
};

// The position of `world` in a viewport of `size` pixels, y down; far outside when it is behind the camera.
glm::vec2 project(const glm::mat4& view_projection, const glm::vec3& world, const glm::vec2& size);

// The state of one block and its probe.
struct BlockPose {
  float tool_m = 0.0F;  // position of the tip, positive inside
  float dent_m = 0.0F;  // depth of the dent
  float error_over_jnd = 0.0F;
  float force_N = 0.0F;       // length of the arrow
  Rgb arrow{0.0F};            // its colour
  bool shows_error = true;    // the dent has the colour of the error
  bool shows_truth = false;   // the two below are shown
  float true_dent_m = 0.0F;   // of the true material, a line in the cut
  float true_force_N = 0.0F;  // a second arrow
  Rgb truth{0.0F};            // colour of both
  bool operator==(const BlockPose&) const = default;
};
// Factor by which the contact is magnified: the depth, and the tool with it, so that the dent keeps its shape. The
// title over the picture says so.
inline constexpr float kDeeperDents = 2.0F;

class BlockView {
 public:
  static constexpr std::size_t kMostBlocks = 6;

  // `magnified`: see kDeeperDents. Errors: a shader is missing or does not compile.
  static Result<std::unique_ptr<BlockView>> create(const Scene& scene, float magnified = kDeeperDents);

  // All blocks are in one row, so that one stroke of the pointer passes beside none of them.
  void in_one_row(bool one_row) noexcept { one_row_ = one_row; }
  // Leaves these shares of the height of the picture free at its upper and lower edge.
  void leave_free(float above, float below) noexcept { above_ = above, below_ = below; }
  // Arranges `count` blocks in a picture of `size` and turns the camera to them, with a transition unless `at_once`.
  void show(std::size_t count, const glm::vec2& size, bool at_once);
  // Draws 1 to kMostBlocks blocks into a part of the window, with the origin at its lower left corner. `texts` draws
  // over the parts at rest and under those that move; it is called only where they change or if `new_texts`.
  void draw(const std::vector<BlockPose>& blocks, const Viewport& viewport, Theme theme, bool new_texts = false,
            const std::function<void()>& texts = {});

  Camera& camera() noexcept { return camera_; }

  // The block whose cell, with the air above it, has this point of a picture of `size`; the nearest cell of its row.
  std::size_t cell_at(const glm::vec2& point, std::size_t count, const glm::vec2& size) const;
  // Pixel position (y down) in a picture of `size` of a point relative to the middle of the top of block `index`.
  glm::vec2 on_screen(std::size_t index, std::size_t count, const glm::vec3& point, const glm::vec2& size) const;
  // The point below the middle of the block, and the width of the picture of a block.
  glm::vec2 foot(std::size_t index, std::size_t count, const glm::vec2& size) const;
  float width_of_one(std::size_t count, const glm::vec2& size) const;
  // Motion of the tool inwards per pixel downwards, m.
  float depth_per_pixel(std::size_t index, std::size_t count, const glm::vec2& size) const;

 private:
  // What the picture of the static parts depends on.
  struct Still {
    glm::mat4 view_projection{0.0F};
    int width = 0, height = 0;
    std::size_t blocks = 0;
    Theme theme = Theme::light;
    float above = 0.0F, below = 0.0F;
    bool operator==(const Still&) const = default;
  };
  struct Cells {
    std::size_t columns = 1, rows = 1;
    glm::vec2 size{1.0F};  // of one
    float top = 0.0F;      // of the first row
    float label = 0.0F;    // height of the text below a block
  };
  struct Shaders {
    Shader top, section, sides, solid, table, line, arrow, halo, sprite;
  };

  // The tool, in radii of its ball; the place of the arrow of the model and the half width of its shaft.
  static constexpr float kToolLength = 6.4F, kToolWidth = 1.16F;
  static constexpr float kModelArrow = 2.75F, kModelArrowWidth = 0.25F;
  static constexpr float kShortestArrow_N = 0.03F;
  static constexpr float kLeastLine_px = 2.5F;

  BlockView(const Scene& scene, float magnified, Shaders shaders);
  Cells cells(std::size_t count, const glm::vec2& size) const;
  float scale(const Cells& cells) const;
  glm::vec2 corner(std::size_t index, std::size_t count, const Cells& cells, const glm::vec2& size) const;
  float drawn_m(float depth_m) const;
  float outline_px() const;
  // block_view.cpp arranges, block_drawing.cpp draws.
  glm::vec2 in_cell(const glm::vec3& point) const;
  float halo_px(const BlockPose& pose) const;
  float opacity_of_error(const BlockPose& pose) const;
  Viewport part_around(const glm::vec3& low, const glm::vec3& high) const;
  void begin(const Shader& shader) const;
  void begin_block(const Shader& shader) const;
  void set_dent(const Shader& shader, float depth_m) const;
  void set_error(const Shader& shader, const BlockPose& pose) const;
  void draw_still(std::size_t count, Theme theme);
  void draw_cell(Theme theme);
  void draw_tool(Theme theme);
  void draw_moving(const BlockPose& pose) const;
  void draw_line(const BlockPose& pose) const;
  void draw_arrow(float from_middle, float force_N, float half_width, const Rgb& colour) const;
  void draw_flat(const Shader& shader, const glm::vec2& origin, const glm::vec2& low, const glm::vec2& high) const;

  glm::vec3 size_m_;  // width, height, length
  float magnified_;
  float radius_m_;  // of the tool as drawn
  float dome_m_;    // height of a dome over its block, whose flat top is lower by it
  float rim_m_;     // from the middle to the nearest side
  float middle_m_;  // radius of what moves of the top
  // Extent of a block and its tool seen from the camera, without perspective, relative to the middle of the top.
  float low_m_, high_m_, wide_m_;
  Finish finish_;
  Rgb block_colour_;
  float arrow_m_per_N_;
  float above_ = 0.0F, below_ = 0.0F;
  bool one_row_ = false;
  Shaders shaders_;
  // Static parts.
  GpuMesh top_, sides_, section_, square_, ball_, sensor_, handle_;
  // Moving parts.
  GpuMesh middle_, moving_section_, line_;
  Camera camera_;
  // A cell with twice the pixels per side; the static parts of all cells, without and with texts; the picture; the
  // tool, also twice.
  Pixels fine_{true}, still_pixels_{false}, lettered_{false}, pixels_{false}, tool_{true};
  Still still_;
  glm::mat4 view_projection_{1.0F};
  glm::vec2 cell_{1.0F};  // pixels
  float px_per_m_ = 1.0F;
  glm::vec2 tool_low_{0.0F}, tool_high_{0.0F};  // of the picture of the tool, relative to the tip's, pixels
};

}  // namespace palpate
