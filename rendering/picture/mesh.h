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

// Level of detail. Small bodies have few triangles, because a triangle costs a software renderer as much as a hundred
// pixels.
struct Detail {
  int corner;  // steps around each corner of a block
  int side;    // points on each of its sides, between the corners
  int rings;   // on its top
  int fillet;  // steps over its rounded edge
  int around;  // sides of a body of revolution
};
inline constexpr Detail kFine{10, 6, 24, 6, 28};
inline constexpr Detail kCoarse{5, 4, 14, 3, 16};

// The flat top of a block with rounded corners and edges, at y = 0 around the y axis. Its rings are denser towards the
// middle, where it is pressed.
Mesh block_top(const glm::vec2& size_m, const Detail& detail);
// The rounded edge and the sides of that block.
Mesh block_sides(const glm::vec2& size_m, float height_m, const Detail& detail);

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
