// A pair of shaders from assets/shaders, compiled and linked.
// Thread guarantee: the thread of the OpenGL context.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <string>
#include <vector>

#include "engine/base/result.h"

namespace palpate {

class Shader {
 public:
  // Reads `vertex`.vert and `fragment`.frag in `folder`, each behind the text of `parts`, of which the first begins
  // every shader. Errors: no such file; what the driver says against it.
  static Result<Shader> load(const std::string& folder, const std::string& vertex, const std::string& fragment,
                             const std::vector<std::string>& parts = {"common"});
  Shader(Shader&& other) noexcept;
  Shader& operator=(Shader&&) = delete;
  ~Shader();

  void use() const;
  // Of the shader in use; a uniform that does not exist is ignored, as OpenGL has it.
  void set(const char* name, float value) const;
  void set(const char* name, int value) const;
  void set(const char* name, const glm::vec2& value) const;
  void set(const char* name, const glm::vec3& value) const;
  void set(const char* name, const glm::vec4& value) const;
  void set(const char* name, const glm::mat4& value) const;
  void set(const char* name, const glm::vec2* values, int count) const;

 private:
  explicit Shader(unsigned program) : program_(program) {}
  int place(const char* name) const;
  unsigned program_;
};

}  // namespace palpate
