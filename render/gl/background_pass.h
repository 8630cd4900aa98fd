// Sky and ground, the ground's shade, marks on the ground.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "render/gl/depth_pyramid.h"
#include "render/gl/studio.h"
#include "render/shade/kernels.h"

namespace render::gl {

class BackgroundPass {
 public:
  void draw(Studio&, const DrawList&, const FrameSetup&, const DepthPyramid&, const shade::FrameData&, const shade::Maps&);

 private:
  void draw_strips(Studio&, const DrawList&);

  std::vector<std::uint8_t> canvas_, bare_;       // RGBA, lowest row first
  std::optional<FrameBlock> kept_, last_;         // whose background lies in bare_, and whose was drawn last
  std::shared_ptr<const GroundPicture> picture_;  // that lay on it
  Buffer strip_vertices_;
  VertexArray strip_array_;
};

}  // namespace render::gl
