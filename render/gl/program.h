// A linked shader pair; uniforms are set by name.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "render/draw_list.h"
#include "render/gl/names.h"

namespace render::gl {

/// The samplers of all shaders, in the order of their texture units.
constexpr const char* kSamplers[] = {"noise_map", "depth_map"};

/// Vertex and fragment shader, linked.
class Program {
 public:
  /// `defines` goes before both sources. Throws RenderError with the compiler's words.
  Program(const std::string& defines, const std::string& vertex, const std::string& fragment);
  ~Program() { glDeleteProgram(id_); }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void use() const { glUseProgram(id_); }
  void set(const char* uniform, int value) const { glUniform1i(at(uniform), value); }
  void set(const char* uniform, int x, int y, int z) const { glUniform3i(at(uniform), x, y, z); }
  void set(const char* uniform, float value) const { glUniform1f(at(uniform), value); }
  void set(const char* uniform, const Float3& v) const { glUniform3f(at(uniform), v[0], v[1], v[2]); }
  void set(const char* uniform, const Matrix4& m) const { glUniformMatrix4fv(at(uniform), 1, GL_FALSE, m.data()); }

 private:
  GLint at(const char* uniform) const;

  GLuint id_ = 0;
  mutable std::map<std::string, GLint, std::less<>> places_;
};

}  // namespace render::gl
