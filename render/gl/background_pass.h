// Sky and ground, the ground's shade, marks on the ground.
#pragma once

#include <optional>

#include "render/gl/depth_pyramid.h"
#include "render/gl/studio.h"

namespace render::gl {

class BackgroundPass {
 public:
  void draw(Studio&, const DrawList&, const FrameSetup&, const DepthPyramid&);

 private:
  void draw_strips(Studio&, const DrawList&);

  std::optional<FrameBlock> kept_, last_;  // whose background lies in targets.bare, and whose was drawn last
  Buffer strip_vertices_;
  VertexArray strip_array_;
};

}  // namespace render::gl
