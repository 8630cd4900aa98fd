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

/// Vertex and fragment shader, linked. The uniform block `Frame` sits at binding 0.
class Program {
 public:
  /// `defines` goes before both sources. Throws RenderError with the compiler's words.
  Program(const std::string& defines, const std::string& vertex, const std::string& fragment);
  ~Program() { glDeleteProgram(id_); }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void use() const { glUseProgram(id_); }
  void set(const char* uniform, int value) const;
  void set(const char* uniform, int x, int y, int z) const;
  void set(const char* uniform, float value) const;
  void set(const char* uniform, const Float3& value) const;
  void set(const char* uniform, const Matrix4& value) const;

 private:
  GLint at(const char* uniform) const;

  GLuint id_ = 0;
  mutable std::map<std::string, GLint, std::less<>> places_;
};

}  // namespace render::gl
