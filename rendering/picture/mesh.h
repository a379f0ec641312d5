// Triangle meshes in memory and on the graphics card.
// Thread guarantee: functions are pure; GpuMesh belongs to the thread of the OpenGL context.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

namespace palpate {

struct Vertex {
  glm::vec3 position;  // metres
  glm::vec3 normal;    // length 1
};

struct Mesh {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> triangles;  // three indices each, counter-clockwise from outside
};

// A block with rounded corners and edges around the y axis is cut open at z = 0, and its front half is taken away. Its
// flat top is at y = 0.
// The top. `around`: steps along its rim.
Mesh block_top(const glm::vec2& size_m, int around, int rings);
// The part of the top within `radius_m` of the middle, with more rings in the middle, where it is pressed. It has few
// triangles, because one costs a software renderer as much as a hundred pixels.
Mesh block_middle(float radius_m, int around, int rings);
// The rounded edge and the sides, whose upper end is at `top_m`.
Mesh block_sides(const glm::vec2& size_m, float height_m, float top_m, int around);
// The cut face from -half_m to half_m, from the surface at `top_m` down to -height_m. The edges are rounded at
// block_half_m from the middle.
Mesh block_section(float half_m, float block_half_m, float height_m, float top_m, int columns);
inline constexpr float kEdge_m = 0.004F;  // radius of the rounded edges
// Pairs of points at the same x, from -half_m to half_m, whose y is -1 and 1.
Mesh line_mesh(float half_m, int columns);

// A body of revolution around y: `profile` has (radius, y) from bottom to top.
Mesh lathe_mesh(const std::vector<glm::vec2>& profile, int sides);

// A square of half side 1 at y = 0.
Mesh square_mesh();

class GpuMesh {
 public:
  explicit GpuMesh(const Mesh& mesh);
  GpuMesh(const GpuMesh&) = delete;
  GpuMesh& operator=(const GpuMesh&) = delete;
  ~GpuMesh();
  void draw() const;

 private:
  unsigned array_ = 0;
  unsigned buffers_[2] = {0, 0};
  int index_count_ = 0;
};

}  // namespace palpate
