#include "render/gl/targets.h"

#include <algorithm>
#include <string>

#include "render/error.h"

namespace render::gl {
namespace {

constexpr int kSeenPixels = 8'500'000;  // of the object pass: 1080p at four samples in one band, 100 MB

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

void texture_target(const Framebuffer& f, const Texture& colour, int width, int height, GLenum internal, const char* name) {
  allocate(colour, internal, GL_RGBA, GL_UNSIGNED_BYTE, width, height);
  glBindFramebuffer(GL_FRAMEBUFFER, *f);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, *colour, 0);
  finish(name);
}

void attach(const Renderbuffer& r, GLenum attachment, GLenum format, int width, int height) {
  glBindRenderbuffer(GL_RENDERBUFFER, *r);
  glRenderbufferStorage(GL_RENDERBUFFER, format, width, height);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, *r);
}

}  // namespace

Targets::Targets(int w, int h, int ow, int oh, int sample_side, int shadow_size)
    : width(w), height(h), out_width(ow), out_height(oh), samples(sample_side), shadow_map_size(shadow_size) {
  GLint largest = 0;
  glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &largest);
  if (w > largest || h > largest)
    throw RenderError("creating the picture: OpenGL allows at most " + std::to_string(largest) + " pixels a side");
  texture_target(picture, picture_colour, w, h, GL_RGBA8, "picture");
  attach(picture_depth, GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT24, w, h);
  finish("picture");
  // a large picture is drawn in bands, so that memory does not grow with its area times the samples
  band_width = w;
  band_height = std::clamp(kSeenPixels / (w * samples * samples), 16, h);
  // both read back as they are
  texture_target(seen, seen_colour, band_width * samples, band_height * samples, GL_RGBA16, "object");
  allocate(seen_depth, GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, band_width * samples, band_height * samples);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, *seen_depth, 0);
  finish("object");
  if (ow != w) {
    glBindFramebuffer(GL_FRAMEBUFFER, *out);
    attach(out_colour, GL_COLOR_ATTACHMENT0, GL_RGBA8, ow, oh);
    finish("output");
  }

  allocate(shadow_depth, GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, shadow_size, shadow_size);
  glBindFramebuffer(GL_FRAMEBUFFER, *shadow);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, *shadow_depth, 0);
  glDrawBuffer(GL_NONE);
  glReadBuffer(GL_NONE);
  finish("shadow");
}

}  // namespace render::gl
