// What each sample of the things' rectangle sees: which triangle, how near.
#pragma once

#include <cstdint>
#include <vector>

#include "render/gl/frame_block.h"
#include "render/gl/pieces.h"
#include "render/gl/sampler.h"

namespace render::gl {

class ObjectPass {
 public:
  /// The band r of a picture of `width` by `height` pixels, `samples` a side to each.
  void draw(const DrawList&, const std::vector<Piece>&, const FrameSetup&, int width, int height, int samples, const Rectangle& r);

  /// Of the band, row by row, lowest first; where the depth is 1 nothing is seen and the name means nothing.
  const float* depth() const { return depth_.data(); }
  const std::int32_t* names() const { return names_.data(); }
  Sampler& sampler() { return sampler_; }
  /// 255 for the pixels of the band all of whose samples see a thing, 0 for the others of its rows, in a picture `width` wide.
  void cover(const Rectangle& r, int samples, int width, std::vector<std::uint8_t>& out) const;

 private:
  std::vector<float> depth_;
  std::vector<std::int32_t> names_;  // of Sampler::triangles
  Sampler sampler_;
};

}  // namespace render::gl
