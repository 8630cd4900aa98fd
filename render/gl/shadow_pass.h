// What the sun and the sky see of the casters: shadow map, its bounds, occlusion map of the ground.
#pragma once

#include <cstdint>
#include <vector>

#include "render/gl/depth_pyramid.h"
#include "render/gl/pieces.h"
#include "render/gl/studio.h"
#include "render/shade/kernels.h"

namespace render::gl {

class ShadowPass {
 public:
  ShadowPass();
  void draw(Studio&, const std::vector<Piece>&, const FrameSetup&);
  /// Of the map that was drawn last.
  const DepthPyramid& bounds() const { return bounds_; }
  /// For the light of the frame that was drawn last; good until the next.
  shade::Maps maps(const Effort&, const RoadLook&) const;

 private:
  void read_depth(int size);

  std::vector<std::int32_t> grain_;
  std::vector<float> depth_;      // of the map, with a rim of depth 1
  std::vector<float> occlusion_;  // likewise
  DepthPyramid bounds_;
};

}  // namespace render::gl
