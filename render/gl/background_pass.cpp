// The background is computed without things and kept while camera and road stay the same; where shadows and occlusion can fall it
// is computed anew. A kept background and a fresh one come out of the same kernel, pixel by pixel, so a frame's bytes do not depend
// on what was drawn before it.
#include "render/gl/background_pass.h"

#include <algorithm>
#include <vector>

#include "render/gl/ground_tiles.h"

namespace render::gl {
namespace {

void draw_tiles(const TileMap& tiles, const shade::FrameData& data, const shade::Maps& maps, const shade::Canvas& canvas, int y0,
                int y1, const std::uint8_t* covered) {
  for (const auto& [look, rectangles] : tiles)
    for (const Rectangle& r : rectangles) {
      const int low = std::max(r.y, y0), high = std::min(r.y + r.height, y1);
      if (low < high)
        shade::kernels().background(
            data, maps,
            {r.x, low, r.width, high - low, static_cast<int>(look.zone), static_cast<int>(look.sun), look.near, covered}, canvas);
    }
}

}  // namespace

void BackgroundPass::begin(const DrawList& list, const FrameSetup& frame, const DepthPyramid& depth, const shade::FrameData& data,
                           const shade::Maps& maps, const shade::Canvas& canvas, int height) {
  const std::size_t bytes = 4 * static_cast<std::size_t>(canvas.width) * static_cast<std::size_t>(height);
  if (picture_ != list.road.picture) {
    picture_ = list.road.picture;
    kept_ = last_ = std::nullopt;
  }
  // kept from the second equal frame on: a moving camera pays for no copy
  if (last_ && same_background(*last_, frame.block) && !(kept_ && same_background(*kept_, frame.block))) {
    bare_.resize(bytes);
    draw_tiles(lay_tiles(frame, list.road, depth, Shade::none, canvas.width, height), data, maps, {bare_.data(), canvas.width}, 0,
               height, nullptr);
    kept_ = frame.block;
  }
  last_ = frame.block;
  tiles_ = lay_tiles(frame, list.road, depth, Shade::cast, canvas.width, height);
  if (kept_ && same_background(*kept_, frame.block)) {
    std::copy_n(bare_.begin(), bytes, canvas.pixels);
    std::erase_if(tiles_, [](const auto& t) { return t.first.sun == Sun::bare; });
  }
}

void BackgroundPass::draw(int y0, int y1, const std::uint8_t* covered, const shade::FrameData& data, const shade::Maps& maps,
                          const shade::Canvas& canvas) const {
  draw_tiles(tiles_, data, maps, canvas, y0, y1, covered);
}

}  // namespace render::gl
