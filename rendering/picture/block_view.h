// The 3-D view: one to four blocks on a table, each with a probe. It depends on neither models nor session.
// Thread guarantee: the thread of the OpenGL context.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "engine/base/result.h"
#include "rendering/picture/camera.h"
#include "rendering/picture/dent.h"
#include "rendering/picture/mesh.h"
#include "rendering/picture/shader.h"
#include "rendering/picture/smooth_target.h"
#include "rendering/ui/colours.h"
#include "scenes/scene/scene.h"

namespace palpate {

// The state of one block and its probe.
struct BlockPose {
  float tool_m = 0.0F;  // position of the tip, positive inside
  float dent_m = 0.0F;  // depth of the dent
  float error_over_jnd = 0.0F;
  float force_N = 0.0F;     // length of the arrow
  Rgb arrow{0.0F};          // its colour
  bool chosen = false;      // the active model, marked by a frame on the block
  bool shows_error = true;  // the dent has the colour of the error
};
// Factor by which depths are exaggerated; the title over the picture says so unless the force is scaled.
inline constexpr float kDeeperDents = 2.0F;

class BlockView {
 public:
  // `smoothing` empty: as suits the renderer of the OpenGL context. Errors: a shader is missing or does not compile.
  static Result<std::unique_ptr<BlockView>> create(const Scene& scene, std::optional<Smoothing> smoothing = {});

  // Draws 1 to 4 blocks into the viewport. `scale`: see SmoothTarget::begin.
  void draw(const std::vector<BlockPose>& blocks, const Viewport& viewport, Theme theme, float scale = 1.0F);
  bool filters_edges() const noexcept { return smooth_.filters(); }

  Camera& camera() noexcept { return camera_; }
  // Turns the camera to `count` blocks, with a transition unless `at_once`.
  void show(std::size_t count, bool at_once);

  // Middle of the top of block `index` of `count`, at y = 0.
  glm::vec3 place(std::size_t index, std::size_t count) const;
  // Pixel position (y down) in a viewport of `size` of a point relative to the middle of the top of block `index`.
  glm::vec2 on_screen(std::size_t index, std::size_t count, const glm::vec3& point, const glm::vec2& size) const;
  // Motion of the tool inwards per pixel downwards, m.
  float depth_per_pixel(std::size_t index, std::size_t count, const glm::vec2& size) const;
  const BlockGeometry& geometry() const noexcept { return geometry_; }

 private:
  // The meshes of one block and its probe, at one level of detail.
  struct Bodies {
    Bodies(const BlockGeometry& block, float dome_m, const Detail& detail);
    GpuMesh top, sides, ball, sensor, handle, shaft, tip;
  };
  // The picture of the static parts is drawn again when one of these changes.
  struct Still {
    glm::mat4 view_projection{0.0F};
    int width = 0, height = 0;
    std::size_t blocks = 0;
    Theme theme = Theme::light;
    bool operator==(const Still&) const = default;
  };

  BlockView(const Scene& scene, std::vector<Shader> shaders);
  float outline_px() const;
  float arrow_length_m(const BlockPose& pose) const;
  glm::vec3 arrow_foot() const;  // relative to the middle of a block's top
  const Bodies& bodies(std::size_t count, const Viewport& viewport) const;
  std::vector<Viewport> moving_parts(const std::vector<BlockPose>& blocks) const;
  Viewport part_around(const glm::vec3& low, const glm::vec3& high) const;
  void draw_still(std::size_t count, const Bodies& bodies, Theme theme) const;
  void draw_outline(const glm::vec3& place, const Bodies& bodies, Theme theme) const;
  void draw_table(std::size_t count, Theme theme) const;
  void draw_top(const BlockPose& pose, const glm::vec3& place, const Bodies& bodies, bool framed) const;
  void draw_tool(const BlockPose& pose, const glm::vec3& place, const Bodies& bodies, Theme theme) const;
  void begin(const Shader& shader) const;
  void begin_block(const DentShape& dent, const glm::vec3& place) const;

  BlockGeometry geometry_;
  float dome_m_;  // height of a dome over its block, whose flat top is lower by it
  Finish finish_;
  Rgb block_colour_;
  Rgb tool_colour_;
  float size_m_;  // size of one block with its probe, for the camera
  float arrow_m_per_N_;
  float arrow_width_;  // factor
  Shader block_shader_, solid_shader_, table_shader_;
  Bodies fine_, coarse_;
  GpuMesh square_;
  Camera camera_;
  SmoothTarget smooth_;
  Still still_;
  glm::mat4 view_projection_{1.0F};
};

}  // namespace palpate
