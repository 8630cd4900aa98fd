// What OpenGL's passes share: the picture they draw into, the compiled shaders and their inputs.
#pragma once

#include <compare>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "render/gl/frame_block.h"
#include "render/gl/materials.h"
#include "render/gl/names.h"
#include "render/gl/program.h"
#include "render/gl/targets.h"
#include "render/renderer.h"

namespace render::gl {

/// Shader text.
struct Variant {
  const char* vertex;
  const char* fragment;
  auto operator<=>(const Variant&) const = default;
};

class Studio {
 public:
  Studio(int width, int height);

  /// Compiled at first sight, in use from here on.
  const Program& program(const Variant&);
  /// Frame block and textures, for all passes of a frame.
  void bind_inputs(const FrameSetup&);
  /// The rectangles of the bound framebuffer, with kTileVertex in use.
  void fill(const std::vector<Rectangle>&);

  Targets targets;

 private:
  Texture noise_;
  Buffer block_, corners_;
  VertexArray corners_array_;
  std::map<Variant, std::unique_ptr<Program>> programs_;
};

}  // namespace render::gl
