// Shapes of block and tool (pure functions): triangle meshes, and the dent that the shaders press into them. Objects of
// OpenGL: shader programs, framebuffers, meshes.
// Thread guarantee: the thread of the OpenGL context.
#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "rendering/ui/ui.h"

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
// The cut face from -half_m to half_m, from the surface down to -height_m. The edges are rounded at block_half_m from
// the middle.
Mesh block_section(float half_m, float block_half_m, float height_m, int columns);
inline constexpr float kEdge_m = 0.004F;  // radius of the rounded edges
// Pairs of points at the same x, from -half_m to half_m, whose y is -1 and 1.
Mesh line_mesh(float half_m, int columns);

// A body of revolution around y: `profile` has (radius, y) from bottom to top.
Mesh lathe_mesh(const std::vector<glm::vec2>& profile, int sides);

// A square of half side 1 at y = 0.
Mesh square_mesh();

// The surface of a soft half-space under a rigid ball.
// The depth u of the surface at the distance r from the middle. Inside the contact it follows the ball of radius R,
// u = d - R + sqrt(R^2 - r^2). Outside it has the shape beside a Hertzian contact,
// u = u_a (2 / pi) ((2 - x^2) asin(1 / x) + sqrt(x^2 - 1)) with x = r / a (Johnson 1985, eq. 3.42a).
// An incompressible material moves along the normal only.
struct DentShape {
  float depth_m = 0.0F;     // d, in the middle
  float contact_m = 1e-6F;  // a, radius of the contact
  float edge_m = 0.0F;      // u_a, depth at the edge of the contact
};

// At the edge of the contact both shapes have the same slope: with q = sqrt(R^2 - a^2), 3 q^2 + 2 (d - R) q - R^2 = 0.
// A shallow dent has Hertz's a^2 = R d, a deep one nearly Sneddon's (1965).
// `depth_m`: any; there is no dent at 0 or below. `radius_m`: R > 0.
DentShape dent_under_ball(float depth_m, float radius_m) noexcept;

class Shader {
 public:
  // Compiles and links `vertex`.vert and `fragment`.frag in `folder`, each preceded by `definitions`, which are lines
  // of the preprocessor, and the text of the files `parts`.glsl. Errors: a file cannot be read; the driver does not
  // compile or link it, with its message.
  static Result<Shader> load(const std::string& folder, const std::string& vertex, const std::string& fragment,
                             const std::vector<std::string>& parts = {"common"}, const std::string& definitions = {});
  Shader(Shader&& other) noexcept;
  Shader& operator=(Shader&&) = delete;
  ~Shader();

  void use() const;
  // Set a uniform of the shader in use. A uniform that does not exist is ignored.
  void set(const char* name, float value) const;
  void set(const char* name, const glm::vec2& value) const;
  void set(const char* name, const glm::vec3& value) const;
  void set(const char* name, const glm::mat4& value) const;

 private:
  explicit Shader(unsigned program) : program_(program) {}
  int uniform(const char* name) const;
  unsigned program_;
};

// A framebuffer object whose colours are a texture. Its first row is the upper one, as in a window in memory, so that a
// software renderer copies it to the window as it is.
class Pixels {
 public:
  explicit Pixels(bool with_depth) : with_depth_(with_depth) {}
  Pixels(const Pixels&) = delete;
  Pixels& operator=(const Pixels&) = delete;
  ~Pixels() { release(); }

  // Makes it the target of drawing. The contents are kept unless the size changes.
  void draw_into(int width, int height);
  // Copies `from` to `to` of another one, or to `to` of the window (`other` null) with the origin at the lower left
  // corner of the window. Interpolates if the sizes differ. The target of drawing is undefined afterwards.
  void copy_to(const Pixels* other, const Viewport& from, const Viewport& to) const;
  unsigned colour() const noexcept { return colour_; }

 private:
  void make();
  void release();

  bool with_depth_;
  int width_ = 0, height_ = 0;
  unsigned framebuffer_ = 0, colour_ = 0, depth_ = 0;
};

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
