// Where GL draws lines and strips over the picture (twice the output a side for `fine`).
#pragma once

#include <cstdint>
#include <vector>

#include "render/gl/names.h"

namespace render::gl {

struct Targets {
  Targets(int width, int height);

  /// RGBA, lowest row first.
  void upload(const std::vector<std::uint8_t>& picture) const;
  void download(std::vector<std::uint8_t>& picture) const;

  int width, height;
  Texture colour, seen_depth;  // depths of a pixel, to be put into the frame buffer's
  Renderbuffer depth;
  Framebuffer picture;
};

}  // namespace render::gl
