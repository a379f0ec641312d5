// Objects of OpenGL: shader programs, framebuffers, meshes.
// Thread guarantee: the thread of the OpenGL context.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "rendering/picture/shapes.h"
#include "rendering/ui/viewport.h"

namespace palpate {

// A shader program from assets/shaders.
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

  // Makes it the target of drawing. The contents are kept unless the size changes; returns whether it has.
  bool draw_into(int width, int height);
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

// A mesh in the memory of the graphics card.
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
