#include "render/gl/targets.h"

#include <string>

#include "render/error.h"

namespace render::gl {
namespace {

void allocate(const Texture& t, GLenum internal, GLenum format, GLenum type, int width, int height) {
  glBindTexture(GL_TEXTURE_2D, *t);
  glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(internal), width, height, 0, format, type, nullptr);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) glTexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) glTexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
}

void finish(const char* name) {
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw RenderError(std::string("creating the ") + name + " target: the frame buffer is incomplete; is the picture too large?");
}

void attach(const Renderbuffer& r, GLenum attachment, GLenum format, int width, int height) {
  glBindRenderbuffer(GL_RENDERBUFFER, *r);
  glRenderbufferStorage(GL_RENDERBUFFER, format, width, height);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, *r);
}

}  // namespace

Targets::Targets(int w, int h) : width(w), height(h) {
  GLint largest = 0;
  glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &largest);
  if (w > largest || h > largest)
    throw RenderError("creating the picture: OpenGL allows at most " + std::to_string(largest) + " pixels a side");
  allocate(colour, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, w, h);
  allocate(seen_depth, GL_R32F, GL_RED, GL_FLOAT, w, h);
  glBindFramebuffer(GL_FRAMEBUFFER, *picture);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, *colour, 0);
  attach(depth, GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT24, w, h);
  finish("picture");
}

void Targets::upload(const std::vector<std::uint8_t>& pixels) const {
  glBindTexture(GL_TEXTURE_2D, *colour);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
}

void Targets::download(std::vector<std::uint8_t>& pixels) const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, *picture);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
}

}  // namespace render::gl
