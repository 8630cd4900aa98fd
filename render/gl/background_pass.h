// Sky and ground, the ground's shade.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "render/gl/depth_pyramid.h"
#include "render/gl/frame_block.h"
#include "render/gl/ground_tiles.h"
#include "render/shade/kernels.h"

namespace render::gl {

class BackgroundPass {
 public:
  /// What is to be drawn on the canvas; puts there what is kept of the last frame. `step` 2: every other
  /// pixel of a row is looked at, with twice the footprint, and those between are blended.
  void begin(const DrawList&, const FrameSetup&, const DepthPyramid&, const shade::Maps&, const shade::Canvas&, int step);
  /// Its rows from y0 up to y1, but not where `covered` (shade::Tile) says so.
  void draw(int y0, int y1, const std::uint8_t* covered, const shade::Maps&, const shade::Canvas&);

 private:
  bool half_ = false;                 // step 2
  std::vector<std::uint8_t> narrow_;  // then, half as wide
  shade::FrameData data_{};
  TileMap tiles_;
  std::vector<std::uint8_t> bare_;                // a canvas, lowest row first
  std::optional<shade::FrameData> kept_, last_;   // whose background lies in bare_, and whose was drawn last
  std::shared_ptr<const GroundPicture> picture_;  // that lay on it
};

}  // namespace render::gl
