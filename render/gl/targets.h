// The pictures a frame passes through (twice the output a side for `fine`).
#pragma once

#include "render/gl/names.h"

namespace render::gl {

struct Targets {
  /// `samples` a side to a pixel in the object pass.
  Targets(int width, int height, int out_width, int out_height, int samples, int shadow_map_size);

  int width, height, out_width, out_height, samples, shadow_map_size;
  int band_width = 0, band_height = 0;  // pixels of the picture that the object pass holds at a time
  Texture picture_colour, seen_colour, seen_depth, shadow_depth;
  Renderbuffer picture_depth, out_colour;
  Framebuffer picture, seen, shadow, out;
};

}  // namespace render::gl
