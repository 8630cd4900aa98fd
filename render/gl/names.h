// Owners for GL names. All need a current context, also when they die.
#pragma once

#include "render/gl/gl.h"

namespace render::gl {

enum class Kind { buffer, vertex_array, texture, renderbuffer, framebuffer };

/// Owns one GL name; the context must be current when it dies.
template <Kind kind>
class Name {
 public:
  Name() {
    if constexpr (kind == Kind::buffer) glGenBuffers(1, &id_);
    if constexpr (kind == Kind::vertex_array) glGenVertexArrays(1, &id_);
    if constexpr (kind == Kind::texture) glGenTextures(1, &id_);
    if constexpr (kind == Kind::renderbuffer) glGenRenderbuffers(1, &id_);
    if constexpr (kind == Kind::framebuffer) glGenFramebuffers(1, &id_);
  }
  ~Name() {
    if constexpr (kind == Kind::buffer) glDeleteBuffers(1, &id_);
    if constexpr (kind == Kind::vertex_array) glDeleteVertexArrays(1, &id_);
    if constexpr (kind == Kind::texture) glDeleteTextures(1, &id_);
    if constexpr (kind == Kind::renderbuffer) glDeleteRenderbuffers(1, &id_);
    if constexpr (kind == Kind::framebuffer) glDeleteFramebuffers(1, &id_);
  }
  Name(const Name&) = delete;
  Name& operator=(const Name&) = delete;
  GLuint operator*() const { return id_; }

 private:
  GLuint id_ = 0;
};

using Buffer = Name<Kind::buffer>;
using VertexArray = Name<Kind::vertex_array>;
using Texture = Name<Kind::texture>;
using Renderbuffer = Name<Kind::renderbuffer>;
using Framebuffer = Name<Kind::framebuffer>;

}  // namespace render::gl
