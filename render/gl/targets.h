// The pictures a frame passes through (twice the output a side for `fine`).
#pragma once

#include "render/gl/names.h"

namespace render::gl {

struct Targets {
  /// `samples` a side to a pixel in the object pass.
  Targets(int width, int height, int out_width, int out_height, int samples, int shadow_map_size, int occlusion_size);

  int width, height, out_width, out_height, samples, shadow_map_size, occlusion_size;
  int band_width = 0, band_height = 0;  // pixels of the picture that the object pass holds at a time
  Texture seen_colour, seen_depth, shadow_depth, shadow_bounds, occlusion_colour;
  Renderbuffer bare_colour, picture_colour, picture_depth, surfaces_depth, out_colour;
  Framebuffer bare, picture, surfaces, seen, shadow, occlusion, out;
  Sampler compare, plain;  // two ways to read the shadow map
};

}  // namespace render::gl
