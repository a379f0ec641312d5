// Triangles in memory and on the graphics card.
// Thread guarantee: building is pure; GpuMesh belongs to the thread of the
// OpenGL context.
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

// A block with rounded corners and edges, its flat top at y = 0, around the y
// axis. The top's rings lie denser towards the middle, where it is pressed.
Mesh block_mesh(float width_m, float length_m, float height_m);

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
