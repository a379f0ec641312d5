#include "rendering/picture/gpu.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

namespace palpate {
namespace {

constexpr float kCorner_m = 0.012F;

constexpr float kHalfTurn = std::numbers::pi_v<float>;

using Outline = std::vector<Vertex>;  // position on the rim, normal outward, both at y = 0

// Distance of a point from the rim of a rectangle with rounded corners; negative inside.
float rim_distance(const glm::vec2& point, const glm::vec2& half) {
  const glm::vec2 q = glm::abs(point) - (half - kCorner_m);
  return glm::length(glm::max(q, 0.0F)) + std::min(std::max(q.x, q.y), 0.0F) - kCorner_m;
}

// The direction of step `i` of `around` behind the cut, from -x over -z to +x.
glm::vec2 direction(int i, int around) {
  const float angle = kHalfTurn * (1.0F + static_cast<float>(i) / static_cast<float>(around));
  return {std::cos(angle), std::sin(angle)};
}

// The rim behind the cut, at equal angles as seen from the middle.
Outline outline(const glm::vec2& half, int around) {
  constexpr float kStep_m = 1e-4F;  // of the slope, which is the normal
  Outline points;
  for (int i = 0; i <= around; ++i) {
    const glm::vec2 onward = direction(i, around);
    float low = 0.0F, high = half.x + half.y;
    for (int k = 0; k < 30; ++k) {
      const float middle = 0.5F * (low + high);
      (rim_distance(middle * onward, half) < 0.0F ? low : high) = middle;
    }
    const glm::vec2 at = low * onward;
    const glm::vec2 normal = glm::normalize(glm::vec2(
        rim_distance(at + glm::vec2(kStep_m, 0.0F), half) - rim_distance(at - glm::vec2(kStep_m, 0.0F), half),
        rim_distance(at + glm::vec2(0.0F, kStep_m), half) - rim_distance(at - glm::vec2(0.0F, kStep_m), half)));
    points.push_back({{at.x, 0.0F, at.y}, {normal.x, 0.0F, normal.y}});
  }
  return points;
}

// Joins the last row of `row` points with the one before it. The last row is outside or below; a closed row ends at its
// first point.
void join_rows(Mesh& mesh, std::size_t row, bool closed) {
  const auto points = static_cast<std::uint32_t>(row);
  const auto outer = static_cast<std::uint32_t>(mesh.vertices.size()) - points;
  const std::uint32_t inner = outer - points;
  for (std::uint32_t i = 0; i + (closed ? 0 : 1) < points; ++i) {
    const std::uint32_t next = (i + 1) % points;
    for (const std::uint32_t index : {inner + i, inner + next, outer + i, outer + i, inner + next, outer + next})
      mesh.triangles.push_back(index);
  }
}

void add_shifted(Mesh& mesh, const Outline& rim, float outward_m, float y_m, float tilt_rad) {
  for (const Vertex& point : rim) {
    const glm::vec3 place = point.position + outward_m * point.normal + glm::vec3(0.0F, y_m, 0.0F);
    const glm::vec3 normal = std::cos(tilt_rad) * point.normal + glm::vec3(0.0F, std::sin(tilt_rad), 0.0F);
    mesh.vertices.push_back({place, normal});
  }
  join_rows(mesh, rim.size(), false);
}

// Rings from the middle outward. `dense`: share by which they are closer together in the middle.
Mesh rings_to(const Outline& rim, int rings, float dense) {
  Mesh mesh;
  for (int k = 0; k <= rings; ++k) {
    const float t = static_cast<float>(k) / static_cast<float>(rings);
    const float size = std::max(1e-4F, t * (1.0F - dense + dense * t));
    for (const Vertex& point : rim) mesh.vertices.push_back({size * point.position, {0.0F, 1.0F, 0.0F}});
    if (k > 0) join_rows(mesh, rim.size(), false);
  }
  return mesh;
}

// Depth of the rounded edge at a distance from the middle, for a half width of `half_m`.
float edge_depth_m(float from_m, float half_m) {
  const float over_m = std::clamp(from_m - (half_m - kEdge_m), 0.0F, kEdge_m);
  return kEdge_m - std::sqrt(kEdge_m * kEdge_m - over_m * over_m);
}

// The area at z = 0 from `upper` of x down to `lower`, in columns from half_m to -half_m that are denser in the middle.
template <typename Upper>
Mesh strip(float half_m, int columns, const Upper& upper, float lower) {
  Mesh mesh;
  for (const bool low : {false, true}) {
    for (int i = 0; i <= columns; ++i) {
      const float t = 1.0F - 2.0F * static_cast<float>(i) / static_cast<float>(columns);
      const float x_m = half_m * t * (0.25F + 0.75F * std::abs(t));
      mesh.vertices.push_back({{x_m, low ? lower : upper(x_m), 0.0F}, {0.0F, 0.0F, 1.0F}});
    }
  }
  join_rows(mesh, static_cast<std::size_t>(columns) + 1, false);
  return mesh;
}

}  // namespace

Mesh block_top(const glm::vec2& size_m, int around, int rings) {
  return rings_to(outline(0.5F * size_m - kEdge_m, around), rings, 0.0F);
}

Mesh block_middle(float radius_m, int around, int rings) {
  Outline rim;
  for (int i = 0; i <= around; ++i) {
    const glm::vec2 onward = radius_m * direction(i, around);
    rim.push_back({{onward.x, 0.0F, onward.y}, {}});
  }
  return rings_to(rim, rings, 0.65F);
}

Mesh block_sides(const glm::vec2& size_m, float height_m, float top_m, int around) {
  constexpr int kFillet = 6;
  Mesh mesh;
  const Outline rim = outline(0.5F * size_m - kEdge_m, around);
  for (const Vertex& point : rim) mesh.vertices.push_back({point.position + glm::vec3(0, top_m, 0), {0, 1, 0}});
  for (int i = 1; i <= kFillet; ++i) {
    const float angle = 0.5F * kHalfTurn * static_cast<float>(i) / static_cast<float>(kFillet);
    add_shifted(mesh, rim, kEdge_m * std::sin(angle), top_m - kEdge_m * (1.0F - std::cos(angle)),
                0.5F * kHalfTurn - angle);
  }
  add_shifted(mesh, rim, kEdge_m, -height_m, 0.0F);
  return mesh;
}

Mesh block_section(float half_m, float block_half_m, float height_m, int columns) {
  return strip(
      half_m, columns, [&](float x_m) { return -edge_depth_m(std::abs(x_m), block_half_m); }, -height_m);
}

Mesh line_mesh(float half_m, int columns) {
  return strip(
      half_m, columns, [](float) { return 1.0F; }, -1.0F);
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
    if (k + 1 < profile.size()) join_rows(mesh, static_cast<std::size_t>(sides), true);
  }
  return mesh;
}

Mesh square_mesh() {
  const glm::vec3 up(0.0F, 1.0F, 0.0F);
  return {{{{-1, 0, -1}, up}, {{-1, 0, 1}, up}, {{1, 0, 1}, up}, {{1, 0, -1}, up}}, {0, 1, 2, 0, 2, 3}};
}

DentShape dent_under_ball(float depth_m, float radius_m) noexcept {
  DentShape dent;
  if (!(depth_m > 0.0F)) return dent;
  const float below = depth_m - radius_m;
  const float q = (std::sqrt(below * below + 3.0F * radius_m * radius_m) - below) / 3.0F;
  dent.depth_m = depth_m;
  dent.contact_m = std::max(dent.contact_m, std::sqrt(std::max(0.0F, radius_m * radius_m - q * q)));
  dent.edge_m = below + q;
  return dent;
}

}  // namespace palpate
