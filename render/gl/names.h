// Owners for GL names, and what fills them. All need a current context, also when they die.
#pragma once

#include <cstddef>
#include <initializer_list>

#include "render/gl/gl.h"

namespace render::gl {

/// Owns one GL name; the context must be current when it dies.
template <auto& make, auto& remove>
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

/// The buffer's vertices are attributes of so many floats each, one behind the other, numbered from `first` on.
inline void lay_out(const VertexArray& array, const Buffer& buffer, std::initializer_list<int> floats, GLuint first = 0) {
  glBindVertexArray(*array);
  glBindBuffer(GL_ARRAY_BUFFER, *buffer);
  int stride = 0, offset = 0;
  for (const int size : floats) stride += size;
  for (const int size : floats) {
    glEnableVertexAttribArray(first);
    glVertexAttribPointer(first++, size, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(sizeof(float)) * stride,
                          reinterpret_cast<const void*>(sizeof(float) * static_cast<std::size_t>(offset)));
    offset += size;
  }
}

/// For the next draw call.
template <class List>
void upload(const Buffer& buffer, const List& list) {
  glBindBuffer(GL_ARRAY_BUFFER, *buffer);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(list.size() * sizeof list[0]), list.data(), GL_STREAM_DRAW);
}

}  // namespace render::gl
