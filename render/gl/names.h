// Owners for GL names. All need a current context, also when they die.
#pragma once

#include "render/gl/gl.h"

namespace render::gl {

/// Owns one GL name; the context must be current when it dies.
template <void (*make)(GLsizei, GLuint*), void (*remove)(GLsizei, const GLuint*)>
class Name {
 public:
  Name() { make(1, &id_); }
  ~Name() { remove(1, &id_); }
  Name(const Name&) = delete;
  Name& operator=(const Name&) = delete;
  GLuint operator*() const { return id_; }

 private:
  GLuint id_ = 0;
};

using Buffer = Name<glGenBuffers, glDeleteBuffers>;
using VertexArray = Name<glGenVertexArrays, glDeleteVertexArrays>;
using Texture = Name<glGenTextures, glDeleteTextures>;
using Renderbuffer = Name<glGenRenderbuffers, glDeleteRenderbuffers>;
using Framebuffer = Name<glGenFramebuffers, glDeleteFramebuffers>;

}  // namespace render::gl
