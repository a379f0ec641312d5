#include "rendering/picture/gpu.h"

#include <epoxy/gl.h>

#include <cstdint>
#include <glm/gtc/type_ptr.hpp>
#include <initializer_list>
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

}  // namespace palpate
