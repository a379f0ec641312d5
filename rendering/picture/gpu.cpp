#include "rendering/picture/gpu.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <initializer_list>
#include <numbers>
#include <utility>

#include "engine/base/files.h"

namespace palpate {
namespace {

using Id = Result<unsigned>;

constexpr const char* kElsewhere = ", and set PALPATE_ASSETS to the assets folder";

Id compile(const std::string& path, const std::string& text, unsigned kind) {
  const unsigned shader = glCreateShader(kind);
  const char* source = text.c_str();
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  int good = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (good != 0) return Id(shader);
  char log[1024] = "";
  glGetShaderInfoLog(shader, sizeof log, nullptr, log);
  glDeleteShader(shader);
  return Error{path + ": the graphics driver does not compile it: " + log};
}

}  // namespace

Result<Shader> Shader::load(const std::string& folder, const std::string& vertex, const std::string& fragment,
                            const std::vector<std::string>& parts, const std::string& definitions) {
  std::string before = "#version 330 core\n" + definitions;
  for (const std::string& part : parts) {
    const auto text = read_plain_file(folder + "/" + part + ".glsl", "a shader", kElsewhere);
    if (!text) return text.error();
    before += *text;
  }
  Shader shader(glCreateProgram());
  for (const auto& [name, kind] :
       {std::pair{vertex + ".vert", GL_VERTEX_SHADER}, std::pair{fragment + ".frag", GL_FRAGMENT_SHADER}}) {
    const auto text = read_plain_file(folder + "/" + name, "a shader", kElsewhere);
    if (!text) return text.error();
    const Id part = compile(folder + "/" + name, before + *text, static_cast<unsigned>(kind));
    if (!part) return part.error();
    glAttachShader(shader.program_, *part);
    glDeleteShader(*part);  // deleted with the program
  }
  glLinkProgram(shader.program_);
  int good = 0;
  glGetProgramiv(shader.program_, GL_LINK_STATUS, &good);
  if (good == 0)
    return Error{folder + ": the graphics driver does not link " + vertex + ".vert and " + fragment + ".frag"};
  return shader;
}

Shader::Shader(Shader&& other) noexcept : program_(std::exchange(other.program_, 0)) {}

Shader::~Shader() {
  if (program_ != 0) glDeleteProgram(program_);
}

void Shader::use() const { glUseProgram(program_); }
int Shader::uniform(const char* name) const { return glGetUniformLocation(program_, name); }
void Shader::set(const char* name, float value) const { glUniform1f(uniform(name), value); }
void Shader::set(const char* name, const glm::vec2& value) const {
  glUniform2fv(uniform(name), 1, glm::value_ptr(value));
}
void Shader::set(const char* name, const glm::vec3& value) const {
  glUniform3fv(uniform(name), 1, glm::value_ptr(value));
}
void Shader::set(const char* name, const glm::mat4& value) const {
  glUniformMatrix4fv(uniform(name), 1, GL_FALSE, glm::value_ptr(value));
}

void Pixels::release() {
  if (framebuffer_ == 0) return;
  glDeleteFramebuffers(1, &framebuffer_);
  glDeleteTextures(1, &colour_);
  glDeleteRenderbuffers(1, &depth_);
  framebuffer_ = 0;
}

void Pixels::make() {
  release();
  glGenFramebuffers(1, &framebuffer_);
  glGenTextures(1, &colour_);
  glGenRenderbuffers(1, &depth_);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glBindTexture(GL_TEXTURE_2D, colour_);
  // The order of colours of a window, so that a software renderer copies memory: it takes a tenth of the time of a
  // conversion. With the format GL_RGBA8, Mesa would choose an order of its own.
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, width_, height_, 0, GL_BGRA, GL_UNSIGNED_BYTE, nullptr);
  for (const GLenum filter : std::initializer_list<GLenum>{GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    glTexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
  for (const GLenum wrap : std::initializer_list<GLenum>{GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    glTexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour_, 0);
  if (!with_depth_) return;
  glBindRenderbuffer(GL_RENDERBUFFER, depth_);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, width_, height_);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);
}

void Pixels::draw_into(int width, int height) {
  const bool same = framebuffer_ != 0 && width == width_ && height == height_;
  width_ = width;
  height_ = height;
  if (!same) make();
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glViewport(0, 0, width, height);
}

void Pixels::copy_to(const Pixels* other, const Viewport& from, const Viewport& to) const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, other != nullptr ? other->framebuffer_ : 0);
  const bool same = from.width == to.width && from.height == to.height;
  const int low = other != nullptr ? to.y : to.y + to.height, high = other != nullptr ? to.y + to.height : to.y;
  glBlitFramebuffer(from.x, from.y, from.x + from.width, from.y + from.height, to.x, low, to.x + to.width, high,
                    GL_COLOR_BUFFER_BIT, same ? GL_NEAREST : GL_LINEAR);
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
