#include "rendering/picture/gpu.h"

#include <gtest/gtest.h>

#include <cmath>
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

// Width, length, height.
glm::vec3 extent(const std::vector<Mesh>& parts) {
  glm::vec3 low(1.0F), high(-1.0F);
  for (const Mesh& mesh : parts) {
    expect_consistent(mesh);
    for (const Vertex& vertex : mesh.vertices) {
      low = glm::min(low, vertex.position);
      high = glm::max(high, vertex.position);
    }
  }
  EXPECT_NEAR(high.y, 0.0F, 1e-7F);
  EXPECT_NEAR(high.z, 0.0F, 1e-6F) << "the front half is taken away";
  return high - low;
}

TEST(Mesh, TheBlockHasItsSizeAndFacesOutwards) {
  const glm::vec2 size(0.10F, 0.08F);
  const glm::vec3 all =
      extent({block_top(size, 96, 6), block_sides(size, 0.04F, 0.0F, 96), block_section(0.05F, 0.05F, 0.04F, 80)});
  EXPECT_LT(glm::distance(all, glm::vec3(0.10F, 0.04F, 0.04F)), 1e-5F);
}

TEST(Mesh, TopAndSidesMeetWithoutAGap) {
  const Mesh top = block_top({0.10F, 0.08F}, 40, 6), sides = block_sides({0.10F, 0.08F}, 0.04F, 0.0F, 40);
  for (std::size_t i = 0; i <= 40; ++i) {
    const glm::vec3 rim = top.vertices[top.vertices.size() - 41 + i].position;
    EXPECT_LT(glm::distance(rim, sides.vertices[i].position), 1e-6F) << i;
  }
}

// What moves is drawn in each frame, and a triangle costs a software renderer as much as a hundred pixels.
TEST(Mesh, WhatMovesHasFewTriangles) {
  const Mesh middle = block_middle(0.045F, 12, 9), section = block_section(0.045F, 0.05F, 0.04F, 28);
  extent({middle, section});
  EXPECT_LT(middle.triangles.size() + section.triangles.size(), 3u * 280u);
  const Mesh line = line_mesh(0.045F, 28);
  expect_consistent(line);
  EXPECT_EQ(line.vertices.front().position, glm::vec3(0.045F, 1.0F, 0.0F));
  EXPECT_EQ(line.vertices.back().position, glm::vec3(-0.045F, -1.0F, 0.0F));
}

TEST(Mesh, ALatheFacesOutwards) {
  expect_consistent(lathe_mesh({{1e-4F, 0.0F}, {0.7F, 0.3F}, {1.0F, 1.0F}, {0.7F, 1.7F}, {1e-4F, 2.0F}}, 24));
}

TEST(Mesh, TheSquareFacesUp) { expect_consistent(square_mesh()); }

constexpr float kRadius_m = 0.005F;

// Sneddon (1965): the depth of a rigid sphere with the contact radius a, exact for a half-space.
double sneddon_depth_m(double a, double radius) { return 0.5 * a * std::log((radius + a) / (radius - a)); }

TEST(Dent, AShallowOneIsHertzs) {
  for (const float depth_m : {1e-6F, 1e-5F, 1e-4F}) {
    const DentShape dent = dent_under_ball(depth_m, kRadius_m);
    EXPECT_NEAR(dent.contact_m, std::sqrt(kRadius_m * depth_m), 0.02F * dent.contact_m) << depth_m;
    EXPECT_NEAR(dent.edge_m, 0.5F * depth_m, 0.02F * depth_m) << depth_m;
  }
}

TEST(Dent, ADeepOneIsNearlySneddons) {
  for (const double share : {0.2, 0.4, 0.6, 0.8, 0.9, 0.95}) {
    const double a = share * static_cast<double>(kRadius_m);
    const auto depth_m = static_cast<float>(sneddon_depth_m(a, static_cast<double>(kRadius_m)));
    EXPECT_NEAR(static_cast<double>(dent_under_ball(depth_m, kRadius_m).contact_m), a, 0.03 * a) << share;
  }
}

TEST(Dent, TheBallAndTheSurfaceBesideItMeetWithTheSameSlope) {
  for (const float depth_m : {1e-5F, 1e-3F, 5e-3F, 2e-2F}) {
    const DentShape dent = dent_under_ball(depth_m, kRadius_m);
    const float q = std::sqrt(kRadius_m * kRadius_m - dent.contact_m * dent.contact_m);
    EXPECT_NEAR(dent.contact_m / q, 2.0F * dent.edge_m / dent.contact_m, 0.02F * dent.contact_m / q) << depth_m;
    EXPECT_LE(dent.contact_m, kRadius_m);
    EXPECT_LT(dent.edge_m, dent.depth_m);
  }
}

TEST(Dent, WithoutAPressThereIsNone) {
  for (const float depth_m : {0.0F, -0.01F, std::nanf("")}) {
    EXPECT_EQ(dent_under_ball(depth_m, kRadius_m).depth_m, 0.0F);
    EXPECT_GT(dent_under_ball(depth_m, kRadius_m).contact_m, 0.0F) << "the shader divides by it";
  }
}

}  // namespace
}  // namespace palpate
