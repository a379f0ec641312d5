#include "rendering/picture/shader.h"

#include <epoxy/gl.h>

#include <glm/gtc/type_ptr.hpp>
#include <utility>
#include <vector>

#include "engine/base/whole_file.h"

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

}  // namespace palpate
