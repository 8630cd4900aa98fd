#include "render/gl/program.h"

#include <fmt/format.h>

#include <array>

#include "render/error.h"

namespace render::gl {
namespace {

/// Throws with the driver's words unless the shader or program `id` came out well.
template <class Status, class Words>
void check(const char* what, GLuint id, GLenum asked, Status status, Words words) {
  GLint good = 0;
  status(id, asked, &good);
  if (good) return;
  std::array<char, 2000> log{};
  words(id, static_cast<GLsizei>(log.size()), nullptr, log.data());
  throw RenderError(fmt::format("{}: {}", what, log.data()));
}

GLuint compile(GLenum kind, const std::string& source) {
  const GLuint id = glCreateShader(kind);
  const char* text = source.c_str();
  glShaderSource(id, 1, &text, nullptr);
  glCompileShader(id);
  check(kind == GL_VERTEX_SHADER ? "compiling a vertex shader" : "compiling a fragment shader", id, GL_COMPILE_STATUS,
        glGetShaderiv, glGetShaderInfoLog);
  return id;
}

}  // namespace

Program::Program(const std::string& defines, const std::string& vertex, const std::string& fragment) {
  const std::string head = "#version 330 core\n" + defines;
  const GLuint v = compile(GL_VERTEX_SHADER, head + vertex);
  const GLuint f = compile(GL_FRAGMENT_SHADER, head + fragment);
  id_ = glCreateProgram();
  glAttachShader(id_, v);
  glAttachShader(id_, f);
  glLinkProgram(id_);
  glDeleteShader(v);
  glDeleteShader(f);
  check("linking shaders", id_, GL_LINK_STATUS, glGetProgramiv, glGetProgramInfoLog);
  glUseProgram(id_);
  int unit = 0;
  for (const char* sampler : kSamplers) glUniform1i(at(sampler), unit++);
}

GLint Program::at(const char* uniform) const {
  const auto known = places_.find(uniform);
  if (known != places_.end()) return known->second;
  return places_.emplace(uniform, glGetUniformLocation(id_, uniform)).first->second;
}

}  // namespace render::gl
