#include "render/gl/target.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "render/error.h"

namespace render::gl {
namespace {

constexpr TexelFormat kDepth{GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, 1};

/// Gives the texture this size and hangs it into the bound framebuffer.
void attach(const Texture& t, GLenum attachment, const TexelFormat& f, int width, int height) {
  glBindTexture(GL_TEXTURE_2D, *t);
  glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(f.internal), width, height, 0, f.format, f.type, nullptr);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) glTexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) glTexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
  glFramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, *t, 0);
}

}  // namespace

/// Not smaller than asked, and not much larger: what is cleared and never seen costs time. In whole tiles of llvmpipe, so that
/// there is a new one only now and then.
void Target::fit(int width, int height, int most_width, int most_height) {
  if (width <= width_ && height <= height_ && 3 * width > 2 * width_ && 3 * height > 2 * height_) return;
  constexpr int kTile = 64;
  width_ = std::min((width + kTile - 1) / kTile * kTile, most_width);
  height_ = std::min((height + kTile - 1) / kTile * kTile, most_height);
  if (deep_) attach(depth_, GL_DEPTH_ATTACHMENT, kDepth, width_, height_);
  if (colour_format_.internal != 0) {
    attach(colour_, GL_COLOR_ATTACHMENT0, colour_format_, width_, height_);
  } else {
    glDrawBuffer(GL_NONE);
    glReadBuffer(GL_NONE);
  }
  const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER), error = glGetError();
  if (status == GL_FRAMEBUFFER_COMPLETE && error == GL_NO_ERROR) return;
  GLint largest = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
  throw RenderError(
      fmt::format("creating the {}: OpenGL refuses {} x {} samples (status 0x{:x}, error 0x{:x}; it allows {} a side)", name_,
                  width_, height_, status, error, largest));
}

void Target::begin(const Rectangle& r, int width, int height) {
  glBindFramebuffer(GL_FRAMEBUFFER, *frame_);
  fit(r.width, r.height, width, height);
  part_ = r;
  side_ = static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::max(width, height))));
  bind();
  const float farthest = kDepth.nothing, none = colour_format_.nothing, colour[] = {none, none, none, none};
  const GLint nothing[4] = {};
  if (deep_) glClearBufferfv(GL_DEPTH, 0, &farthest);
  if (colour_format_.format == GL_RED_INTEGER)
    glClearBufferiv(GL_COLOR, 0, nothing);
  else if (colour_format_.internal != 0)
    glClearBufferfv(GL_COLOR, 0, colour);
}

void Target::bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, *frame_);
  glViewport(-part_.x, -part_.y, side_, side_);
}

void Target::confine(const Rectangle& r) const {
  const Rectangle common = both(r, part_);
  glEnable(GL_SCISSOR_TEST);
  glScissor(common.x - part_.x, common.y - part_.y, common.width, common.height);
}

void Target::read(const Rectangle& r, void* out, int pitch) const {
  const TexelFormat& f = colour_format_.internal != 0 ? colour_format_ : kDepth;
  glBindFramebuffer(GL_FRAMEBUFFER, *frame_);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glPixelStorei(GL_PACK_ROW_LENGTH, pitch);
  glReadPixels(r.x - part_.x, r.y - part_.y, r.width, r.height, f.format, f.type, out);
  // Mesa goes on where memory ended, without what it could not draw: a shadow, say
  if (const GLenum error = glGetError(); error != GL_NO_ERROR)
    throw RenderError(fmt::format("drawing the {}: OpenGL reports error 0x{:x}{}", name_, error,
                                  error == GL_OUT_OF_MEMORY ? ", out of memory" : ""));
}

}  // namespace render::gl
