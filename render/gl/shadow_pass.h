// What the sun and the sky see of the casters: shadow map, its bounds, occlusion map of the ground.
#pragma once

#include <vector>

#include "render/gl/depth_pyramid.h"
#include "render/gl/pieces.h"
#include "render/gl/studio.h"

namespace render::gl {

class ShadowPass {
 public:
  void draw(Studio&, const std::vector<Piece>&, const FrameSetup&);
  /// Of the map that was drawn last.
  const DepthPyramid& bounds() const { return bounds_; }

 private:
  const std::vector<float>& read_depth(int size);

  std::vector<float> depth_;  // of the map, as read back
  DepthPyramid bounds_;
};

}  // namespace render::gl
