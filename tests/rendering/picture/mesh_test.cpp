#include "rendering/picture/mesh.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace palpate {
namespace {

// The orientation of triangles agrees with the normals of their vertices.
void expect_consistent(const Mesh& mesh) {
  ASSERT_EQ(mesh.triangles.size() % 3, 0u);
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
    const Vertex& a = mesh.vertices.at(mesh.triangles[i]);
    const Vertex& b = mesh.vertices.at(mesh.triangles[i + 1]);
    const Vertex& c = mesh.vertices.at(mesh.triangles[i + 2]);
    const glm::vec3 face = glm::cross(b.position - a.position, c.position - a.position);
    if (glm::length(face) < 1e-12F) continue;  // at a pole
    ASSERT_GT(glm::dot(glm::normalize(face), a.normal + b.normal + c.normal), 0.0F) << "triangle " << i / 3;
  }
  for (const Vertex& vertex : mesh.vertices) ASSERT_NEAR(glm::length(vertex.normal), 1.0F, 1e-4F);
}

TEST(Mesh, TheBlockHasItsSizeAndFacesOutwards) {
  for (const Detail& detail : {kFine, kCoarse}) {
    const Mesh top = block_top({0.10F, 0.08F}, detail);
    const Mesh sides = block_sides({0.10F, 0.08F}, 0.04F, detail);
    glm::vec3 low(1.0F);
    glm::vec3 high(-1.0F);
    for (const Mesh* mesh : {&top, &sides}) {
      expect_consistent(*mesh);
      for (const Vertex& vertex : mesh->vertices) {
        low = glm::min(low, vertex.position);
        high = glm::max(high, vertex.position);
      }
    }
    EXPECT_NEAR(high.x - low.x, 0.10F, 1e-5F);
    EXPECT_NEAR(high.z - low.z, 0.08F, 1e-5F);
    EXPECT_NEAR(high.y, 0.0F, 1e-7F);
    EXPECT_NEAR(low.y, -0.04F, 1e-6F);
  }
}

TEST(Mesh, TopAndSidesMeetWithoutAGap) {
  const Mesh top = block_top({0.10F, 0.08F}, kCoarse);
  const Mesh sides = block_sides({0.10F, 0.08F}, 0.04F, kCoarse);
  for (std::size_t i = 0; i < 40; ++i) {
    const glm::vec3 rim = top.vertices[top.vertices.size() - 40 + i].position;
    EXPECT_LT(glm::distance(rim, sides.vertices[i].position), 1e-6F) << i;
  }
}

// A slow computer draws the coarse block.
TEST(Mesh, ACoarseBlockHasFarFewerTriangles) {
  const auto count = [](const Detail& detail) {
    return block_top({0.1F, 0.1F}, detail).triangles.size() + block_sides({0.1F, 0.1F}, 0.04F, detail).triangles.size();
  };
  EXPECT_LT(5 * count(kCoarse), 2 * count(kFine));
}

TEST(Mesh, ALatheFacesOutwards) {
  expect_consistent(lathe_mesh({{1e-4F, 0.0F}, {0.7F, 0.3F}, {1.0F, 1.0F}, {0.7F, 1.7F}, {1e-4F, 2.0F}}, 24));
}

TEST(Mesh, TheSquareFacesUp) { expect_consistent(square_mesh()); }

}  // namespace
}  // namespace palpate
