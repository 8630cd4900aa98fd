// Textures that are drawn into.
#pragma once

#include "render/gl/frame_block.h"
#include "render/gl/names.h"

namespace render::gl {

struct TexelFormat {
  GLenum internal, format, type;
  float nothing;  // what a texel holds before anything is drawn
};

/// A framebuffer with a colour, a depth of 32 bits, or both, no larger than the part of the picture that is drawn asks for.
class Target {
 public:
  /// Colour and perhaps depth. `name`: for messages.
  Target(const char* name, const TexelFormat& colour, bool deep) : name_(name), colour_format_(colour), deep_(deep) {}
  /// Depth alone.
  explicit Target(const char* name) : name_(name), deep_(true) {}
  /// Holds nothing in the part r of a picture of this size, and is drawn into from here on. Throws RenderError if OpenGL refuses
  /// the size; says what was asked for.
  void begin(const Rectangle& r, int width, int height);
  /// Two over the viewport's side, a power of two: what brings a pixel of the picture to clip space, but for 1.
  float per_viewport() const { return 2 / static_cast<float>(side_); }
  /// Is drawn into again.
  void bind() const;
  /// What was begun is drawn into where it lies in r, up to `glDisable(GL_SCISSOR_TEST)`.
  void confine(const Rectangle& r) const;
  /// What it holds of r, a part of what was begun; `pitch` texels from row to row, 0: no more than there are.
  void read(const Rectangle& r, void* out, int pitch = 0) const;
  const Texture& depth() const { return depth_; }

 private:
  void fit(int width, int height, int most_width, int most_height);

  const char* name_;
  TexelFormat colour_format_{};  // internal format 0: none
  bool deep_;
  Texture colour_, depth_;
  Framebuffer frame_;
  int width_ = 0, height_ = 0;  // of the textures
  Rectangle part_;
  int side_ = 0;  // of the viewport
};

}  // namespace render::gl
