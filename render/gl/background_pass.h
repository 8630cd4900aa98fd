// Sky and ground, the ground's shade.
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
  std::vector<std::uint8_t> canvas_, bare_;       // RGBA, lowest row first
  std::optional<FrameBlock> kept_, last_;         // whose background lies in bare_, and whose was drawn last
  std::shared_ptr<const GroundPicture> picture_;  // that lay on it
};

}  // namespace render::gl
