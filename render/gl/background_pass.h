// Sky and ground, the ground's shade.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "render/gl/depth_pyramid.h"
#include "render/gl/frame_block.h"
#include "render/shade/kernels.h"

namespace render::gl {

class BackgroundPass {
 public:
  /// Onto the whole canvas, `width` by `height` pixels.
  void draw(const DrawList&, const FrameSetup&, const DepthPyramid&, const shade::FrameData&, const shade::Maps&,
            const shade::Canvas&, int height);

 private:
  std::vector<std::uint8_t> bare_;                // RGBA, lowest row first
  std::optional<FrameBlock> kept_, last_;         // whose background lies in bare_, and whose was drawn last
  std::shared_ptr<const GroundPicture> picture_;  // that lay on it
};

}  // namespace render::gl
