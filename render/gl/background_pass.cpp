// The background is computed without things and kept while camera and road stay the same; where shadows and occlusion can fall it
// is computed anew. A kept background and a fresh one come out of the same kernel, pixel by pixel, so a frame's bytes do not depend
// on what was drawn before it.
#include "render/gl/background_pass.h"

#include <algorithm>
#include <vector>

#include "render/gl/ground_tiles.h"

namespace render::gl {
namespace {

void draw_tiles(const TileMap& tiles, const shade::FrameData& data, const shade::Maps& maps, const shade::Canvas& canvas) {
  for (const auto& [look, rectangles] : tiles)
    for (const Rectangle& r : rectangles)
      shade::kernels().background(
          data, maps, {r.x, r.y, r.width, r.height, static_cast<int>(look.zone), static_cast<int>(look.sun), look.near}, canvas);
}

}  // namespace

void BackgroundPass::draw(const DrawList& list, const FrameSetup& frame, const DepthPyramid& depth, const shade::FrameData& data,
                          const shade::Maps& maps, const shade::Canvas& canvas, int height) {
  const std::size_t bytes = 4 * static_cast<std::size_t>(canvas.width) * static_cast<std::size_t>(height);
  if (picture_ != list.road.picture) {
    picture_ = list.road.picture;
    kept_ = last_ = std::nullopt;
  }
  // kept from the second equal frame on: a moving camera pays for no copy
  if (last_ && same_background(*last_, frame.block) && !(kept_ && same_background(*kept_, frame.block))) {
    bare_.resize(bytes);
    draw_tiles(lay_tiles(frame, list.road, depth, Shade::none, canvas.width, height), data, maps, {bare_.data(), canvas.width});
    kept_ = frame.block;
  }
  last_ = frame.block;
  TileMap tiles = lay_tiles(frame, list.road, depth, Shade::cast, canvas.width, height);
  if (kept_ && same_background(*kept_, frame.block)) {
    std::copy_n(bare_.begin(), bytes, canvas.pixels);
    std::erase_if(tiles, [](const auto& t) { return t.first.sun == Sun::bare; });
  }
  draw_tiles(tiles, data, maps, canvas);
}

}  // namespace render::gl
