// A shader program from assets/shaders.
// Thread guarantee: the thread of the OpenGL context.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "engine/base/result.h"

namespace palpate {

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

}  // namespace palpate
