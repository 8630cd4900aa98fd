// What the sun and the sky see of the casters: shadow map, its bounds, occlusion map of the ground.
#pragma once

#include <cstdint>
#include <vector>

#include "render/gl/depth_pyramid.h"
#include "render/gl/pieces.h"
#include "render/gl/program.h"
#include "render/gl/target.h"
#include "render/gl/triangles.h"
#include "render/renderer.h"
#include "render/shade/kernels.h"

namespace render::gl {

class ShadowPass {
 public:
  ShadowPass();
  void draw(const Effort&, const std::vector<Piece>&, const FrameSetup&);
  /// Of the map that was drawn last.
  const DepthPyramid& bounds() const { return bounds_; }
  /// For the light of the frame that was drawn last; good until the next.
  shade::Maps maps(const Effort&, const RoadLook&) const;

 private:
  void draw_map(int size, const std::vector<Piece>&, const FrameSetup&);

  Triangles triangles_;
  Program program_;
  Target target_{"shadow map"};
  std::vector<std::int32_t> grain_;
  std::vector<float> depth_;      // of the map, with a rim of depth 1
  std::vector<float> occlusion_;  // likewise
  DepthPyramid bounds_;
};

}  // namespace render::gl
