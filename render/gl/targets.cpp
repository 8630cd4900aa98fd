#include "render/gl/targets.h"

#include <algorithm>
#include <array>
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

void shadow_sampler(const Sampler& s, GLint mode, GLint filter) {
  glSamplerParameteri(*s, GL_TEXTURE_MIN_FILTER, filter);
  glSamplerParameteri(*s, GL_TEXTURE_MAG_FILTER, filter);
  glSamplerParameteri(*s, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
  glSamplerParameteri(*s, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
  constexpr std::array<GLfloat, 4> kFar{1, 1, 1, 1};  // outside the map the sun shines
  glSamplerParameterfv(*s, GL_TEXTURE_BORDER_COLOR, kFar.data());
  glSamplerParameteri(*s, GL_TEXTURE_COMPARE_MODE, mode);
  glSamplerParameteri(*s, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
}

}  // namespace

Targets::Targets(int w, int h, int ow, int oh, int sample_side, int shadow_size, int occlusion_side)
    : width(w),
      height(h),
      out_width(ow),
      out_height(oh),
      samples(sample_side),
      shadow_map_size(shadow_size),
      occlusion_size(occlusion_side) {
  GLint largest = 0;
  glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &largest);
  if (w > largest || h > largest)
    throw RenderError("creating the picture: OpenGL allows at most " + std::to_string(largest) + " pixels a side");
  glBindFramebuffer(GL_FRAMEBUFFER, *bare);
  attach(bare_colour, GL_COLOR_ATTACHMENT0, GL_RGBA8, w, h);
  finish("background");
  glBindFramebuffer(GL_FRAMEBUFFER, *picture);
  attach(picture_colour, GL_COLOR_ATTACHMENT0, GL_RGBA8, w, h);
  attach(picture_depth, GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT24, w, h);
  finish("picture");
  // the picture again, with a depth that counts the surfaces in each pixel
  glBindFramebuffer(GL_FRAMEBUFFER, *surfaces);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, *picture_colour);
  attach(surfaces_depth, GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT16, w, h);
  finish("surface");
  // a large picture is drawn in bands, so that memory does not grow with its area times the samples
  band_width = w;
  band_height = std::clamp(kSeenPixels / (w * samples * samples), 16, h);
  texture_target(seen, seen_colour, band_width * samples, band_height * samples, GL_RGBA16, "object");
  allocate(seen_depth, GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, band_width * samples, band_height * samples);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, *seen_depth, 0);
  finish("object");
  texture_target(occlusion, occlusion_colour, occlusion_side, occlusion_side, GL_R16, "occlusion");
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) glTexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) glTexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_BORDER);
  constexpr std::array<GLfloat, 4> kOpen{1, 1, 1, 1};
  glTexParameterfv(GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, kOpen.data());
  if (ow != w) {
    glBindFramebuffer(GL_FRAMEBUFFER, *out);
    attach(out_colour, GL_COLOR_ATTACHMENT0, GL_RGBA8, ow, oh);
    finish("output");
  }

  // float: read back as it is
  allocate(shadow_depth, GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, shadow_size, shadow_size);
  glBindFramebuffer(GL_FRAMEBUFFER, *shadow);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, *shadow_depth, 0);
  glDrawBuffer(GL_NONE);
  glReadBuffer(GL_NONE);
  finish("shadow");
  shadow_sampler(compare, GL_COMPARE_REF_TO_TEXTURE, GL_LINEAR);
  shadow_sampler(plain, GL_NONE, GL_NEAREST);
}

}  // namespace render::gl
