// The picture: one to four blocks on a table, each under the same probe.
// Draws what it is told and knows no model and no session.
//
// Thread guarantee: the thread of the OpenGL context.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "engine/base/result.h"
#include "rendering/picture/backdrop.h"
#include "rendering/picture/camera.h"
#include "rendering/picture/mesh.h"
#include "rendering/picture/shader.h"
#include "rendering/picture/smooth_target.h"
#include "rendering/ui/colours.h"
#include "scenes/scene/scene.h"

namespace palpate {

// One block as it is now.
struct BlockPose {
  float tool_m = 0.0F;  // position of the tip, positive inside
  float dent_m = 0.0F;
  float error_over_jnd = 0.0F;
  float force_N = 0.0F;
  Rgb arrow{0.0F};
  bool chosen = false;      // the active model
  bool shows_error = true;  // the dent shows the error's colour
};
// How much deeper than they are presses are drawn where several blocks make each small; who
// shows the picture says so.
inline constexpr float kDeeperDents = 2.0F;

class BlockView {
 public:
  // Errors: a shader is missing or is not taken by the driver.
  static Result<std::unique_ptr<BlockView>> create(const Scene& scene);

  // `blocks`: 1 to 4. Fills the viewport.
  void draw(const std::vector<BlockPose>& blocks, const Viewport& viewport, Theme theme);

  Camera& camera() noexcept { return camera_; }
  // Frames so many blocks; eases there unless `at_once`.
  void show(std::size_t count, bool at_once);

  // Middle of block `index` of `count` on the table, top at y = 0.
  glm::vec3 place(std::size_t index, std::size_t count) const;
  // A point of block `index`, relative to the middle of its top, in the
  // viewport's pixels, y down.
  glm::vec2 on_screen(std::size_t index, std::size_t count, const glm::vec3& point, const glm::vec2& size) const;
  // How far the tool moves inwards for a pixel downwards, metres.
  float depth_per_pixel(std::size_t index, std::size_t count, const glm::vec2& size) const;
  const BlockGeometry& geometry() const noexcept { return geometry_; }

 private:
  float arrow_length_m(const BlockPose& pose) const;
  BlockView(const Scene& scene, Shader block, Shader solid, Shader table);
  // All that the table's picture depends on.
  struct TableState {
    glm::mat4 view_projection{0.0F};
    Viewport viewport;
    Theme theme = Theme::light;
    std::size_t count = 0;
    glm::vec4 chosen{0.0F};  // colour of the ring; alpha 0: none
    glm::vec2 chosen_at{0.0F};
    bool operator==(const TableState&) const = default;
  };
  TableState table_state(const std::vector<BlockPose>& blocks, const Viewport& viewport, Theme theme) const;
  // As finely as it is seen.
  struct Meshes {
    Meshes(const BlockGeometry& block, float detail);
    GpuMesh block, ball, sensor, handle, shaft, tip;
  };
  const Meshes& meshes(const Viewport& viewport, std::size_t count) const;
  void draw_backdrop(const TableState& state);
  void draw_table(const TableState& state) const;
  void add_resting_blocks(const TableState& state);
  // Adds the part of the viewport that a box lies in, if any of it does.
  void add_part(const glm::vec3& low_m, const glm::vec3& high_m, const Viewport& viewport,
                std::vector<Viewport>& parts) const;
  // Where blocks are, down to `lowest_m` below their tops; where tools and arrows are.
  void add_block_parts(std::size_t count, float lowest_m, const Viewport& viewport, std::vector<Viewport>& parts) const;
  void add_tool_parts(const std::vector<BlockPose>& blocks, const Viewport& viewport,
                      std::vector<Viewport>& parts) const;
  void draw_blocks(const std::vector<BlockPose>& blocks) const;
  void draw_block(const BlockPose& pose, const glm::vec3& place) const;
  void draw_tool(const BlockPose& pose, const glm::vec3& place) const;
  void draw_arrow(const BlockPose& pose, const glm::vec3& place) const;
  void begin(const Shader& shader) const;

  BlockGeometry geometry_;
  Rgb block_colour_;
  Rgb tool_colour_;
  float size_m_;  // of what the camera frames for one block
  float arrow_m_per_N_;
  float arrow_width_;  // times the usual
  Shader block_shader_, solid_shader_, table_shader_;
  Meshes fine_, coarse_;
  const Meshes* shown_ = &fine_;
  GpuMesh square_;
  Camera camera_;
  Backdrop backdrop_;
  SmoothTarget smooth_;
  TableState backdrop_state_;
  bool resting_ = false;  // the backdrop has the blocks as nobody presses them
  glm::mat4 view_projection_{1.0F};
};

}  // namespace palpate
