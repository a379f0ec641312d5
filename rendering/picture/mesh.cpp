#include "rendering/picture/mesh.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

namespace palpate {
namespace {

constexpr float kCorner_m = 0.012F;
constexpr float kEdge_m = 0.004F;

using Outline = std::vector<Vertex>;  // position on the rim, normal outward, both at y = 0

// The outline from the corner at +x, +z on. Round corners have many points, straight sides few. The points of a side
// have equal angles as seen from the middle.
Outline outline(const glm::vec2& half, const Detail& detail) {
  constexpr float kQuarter = 0.5F * std::numbers::pi_v<float>;
  const glm::vec2 core = half - kCorner_m;
  Outline points;
  for (int corner = 0; corner < 4; ++corner) {
    const float sign_x = corner == 0 || corner == 3 ? 1.0F : -1.0F;
    const float sign_z = corner < 2 ? 1.0F : -1.0F;
    for (int i = 0; i <= detail.corner; ++i) {
      const float angle =
          kQuarter * (static_cast<float>(corner) + static_cast<float>(i) / static_cast<float>(detail.corner));
      const glm::vec3 normal(std::cos(angle), 0.0F, std::sin(angle));
      points.push_back({glm::vec3(sign_x * core.x, 0.0F, sign_z * core.y) + kCorner_m * normal, normal});
    }
    // The side after the corner: +z, -x, -z, +x.
    const bool along_x = corner % 2 == 0;
    const float away = along_x ? half.y : half.x;
    const float reach = std::atan2(along_x ? core.x : core.y, away);
    const float turn = kQuarter * static_cast<float>(corner + 1);
    const glm::vec3 normal(std::cos(turn), 0.0F, std::sin(turn));
    const glm::vec3 onward(-std::sin(turn), 0.0F, std::cos(turn));
    for (int i = 1; i <= detail.side; ++i) {
      const float angle = reach * (2.0F * static_cast<float>(i) / static_cast<float>(detail.side + 1) - 1.0F);
      points.push_back({away * normal + away * std::tan(angle) * onward, normal});
    }
  }
  return points;
}

// Joins the last ring with the one before it. The last ring is outside or below.
void join_rings(Mesh& mesh, std::size_t around) {
  const auto points = static_cast<std::uint32_t>(around);
  const auto outer = static_cast<std::uint32_t>(mesh.vertices.size()) - points;
  const std::uint32_t inner = outer - points;
  for (std::uint32_t i = 0; i < points; ++i) {
    const std::uint32_t next = (i + 1) % points;
    for (const std::uint32_t index : {inner + i, inner + next, outer + i, outer + i, inner + next, outer + next}) {
      mesh.triangles.push_back(index);
    }
  }
}

void add_shifted(Mesh& mesh, const Outline& rim, float outward_m, float down_m, float tilt_rad) {
  for (const Vertex& point : rim) {
    const glm::vec3 place = point.position + outward_m * point.normal - glm::vec3(0.0F, down_m, 0.0F);
    const glm::vec3 normal = std::cos(tilt_rad) * point.normal + glm::vec3(0.0F, std::sin(tilt_rad), 0.0F);
    mesh.vertices.push_back({place, normal});
  }
  join_rings(mesh, rim.size());
}

}  // namespace

// Rings from the middle outward, whose shape changes from a circle to that of the rim.
Mesh block_top(const glm::vec2& size_m, const Detail& detail) {
  Mesh mesh;
  const Outline rim = outline(0.5F * size_m - kEdge_m, detail);
  const glm::vec3 up(0.0F, 1.0F, 0.0F);
  float nearest = 1e9F;
  for (const Vertex& point : rim) nearest = std::min(nearest, glm::length(point.position));
  for (int k = 0; k <= detail.rings; ++k) {
    const float t = static_cast<float>(k) / static_cast<float>(detail.rings);
    const float size = 1e-4F + (1.0F - 1e-4F) * t * (0.22F + 0.78F * t * t);
    const float square = glm::smoothstep(0.4F, 1.0F, size);
    for (const Vertex& point : rim) {
      const glm::vec3 round = nearest * glm::normalize(point.position);
      mesh.vertices.push_back({size * glm::mix(round, point.position, square), up});
    }
    if (k > 0) join_rings(mesh, rim.size());
  }
  return mesh;
}

Mesh block_sides(const glm::vec2& size_m, float height_m, const Detail& detail) {
  Mesh mesh;
  const Outline rim = outline(0.5F * size_m - kEdge_m, detail);
  for (const Vertex& point : rim) mesh.vertices.push_back({point.position, {0.0F, 1.0F, 0.0F}});
  for (int i = 1; i <= detail.fillet; ++i) {
    const float angle = 0.5F * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(detail.fillet);
    add_shifted(mesh, rim, kEdge_m * std::sin(angle), kEdge_m * (1.0F - std::cos(angle)),
                0.5F * std::numbers::pi_v<float> - angle);
  }
  add_shifted(mesh, rim, kEdge_m, height_m, 0.0F);
  return mesh;
}

Mesh lathe_mesh(const std::vector<glm::vec2>& profile, int sides) {
  Mesh mesh;
  for (std::size_t k = profile.size(); k-- > 0;) {
    const glm::vec2 before = profile[k == 0 ? 0 : k - 1];
    const glm::vec2 after = profile[std::min(k + 1, profile.size() - 1)];
    const glm::vec2 along = glm::normalize(after - before);
    for (int i = 0; i < sides; ++i) {
      const float angle = 2.0F * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(sides);
      const float c = std::cos(angle);
      const float s = std::sin(angle);
      mesh.vertices.push_back(
          {{profile[k].x * c, profile[k].y, profile[k].x * s}, {along.y * c, -along.x, along.y * s}});
    }
    if (k + 1 < profile.size()) join_rings(mesh, static_cast<std::size_t>(sides));
  }
  return mesh;
}

Mesh square_mesh() {
  const glm::vec3 up(0.0F, 1.0F, 0.0F);
  return {{{{-1, 0, -1}, up}, {{-1, 0, 1}, up}, {{1, 0, 1}, up}, {{1, 0, -1}, up}}, {0, 1, 2, 0, 2, 3}};
}

GpuMesh::GpuMesh(const Mesh& mesh) : index_count_(static_cast<int>(mesh.triangles.size())) {
  glGenVertexArrays(1, &array_);
  glBindVertexArray(array_);
  glGenBuffers(2, buffers_);
  glBindBuffer(GL_ARRAY_BUFFER, buffers_[0]);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.vertices.size() * sizeof(Vertex)), mesh.vertices.data(),
               GL_STATIC_DRAW);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers_[1]);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.triangles.size() * sizeof(std::uint32_t)),
               mesh.triangles.data(), GL_STATIC_DRAW);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex), nullptr);
  glEnableVertexAttribArray(1);
  glVertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex),
                        reinterpret_cast<const void*>(offsetof(Vertex, normal)));
  glBindVertexArray(0);
}

GpuMesh::~GpuMesh() {
  glDeleteBuffers(2, buffers_);
  glDeleteVertexArrays(1, &array_);
}

void GpuMesh::draw() const {
  glBindVertexArray(array_);
  glDrawElements(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr);
}

}  // namespace palpate
