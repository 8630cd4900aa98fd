#include "render/gl/target.h"

#include <fmt/format.h>

#include "render/error.h"

namespace render::gl {

void attach(const Texture& t, GLenum attachment, const TexelFormat& f, int width, int height) {
  glBindTexture(GL_TEXTURE_2D, *t);
  glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(f.internal), width, height, 0, f.format, f.type, nullptr);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) glTexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) glTexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
  glFramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, *t, 0);
}

void check_target(const char* name, int width, int height) {
  const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER), error = glGetError();
  if (status == GL_FRAMEBUFFER_COMPLETE && error == GL_NO_ERROR) return;
  GLint largest = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
  throw RenderError(
      fmt::format("creating the {}: OpenGL refuses {} x {} samples (status 0x{:x}, error 0x{:x}; it allows {} a side)", name, width,
                  height, status, error, largest));
}

}  // namespace render::gl
