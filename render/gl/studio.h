// What all passes of a frame share: the quality's price list, the pictures they draw into, the compiled shaders and their inputs.
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

/// Shader text with its switches.
struct Variant {
  const char* vertex;
  const char* fragment;
  int kind = 0;
  std::string options{};  // switches that are on
  auto operator<=>(const Variant&) const = default;
};

class Studio {
 public:
  Studio(int width, int height, const Effort&);

  /// Compiled at first sight, in use from here on.
  const Program& program(const Variant&);
  /// Frame block and textures, for all passes of a frame.
  void bind_inputs(const FrameSetup&);
  /// The rectangles of the bound framebuffer, with kTileVertex in use.
  void fill(const std::vector<Rectangle>&);

  const Effort cost;
  Targets targets;

 private:
  Texture noise_;
  Buffer block_, corners_;
  VertexArray corners_array_;
  std::map<Variant, std::unique_ptr<Program>> programs_;
};

}  // namespace render::gl
