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

/// For pixels twice as wide.
FrameSetup of_half_width(FrameSetup frame) {
  shade::FrameData& f = frame.data;
  for (int i = 0; i < 4; ++i) {
    f.near_x[i] *= 2;
    f.far_x[i] *= 2;
  }
  f.frame[0] *= 2;
  return frame;
}

/// A row twice as wide, blended between the middles of its pixels.
void widen(const std::uint8_t* from, int width, std::uint8_t* to) {
  const auto blend = [](const std::uint8_t* near, const std::uint8_t* far, std::uint8_t* out) {
    for (int c = 0; c < 4; ++c) out[c] = static_cast<std::uint8_t>((3 * near[c] + far[c] + 2) / 4);
  };
  blend(from, from, to);
  for (int x = 0; x + 1 < width; ++x) {
    blend(from + 4 * x, from + 4 * x + 4, to + 8 * x + 4);
    blend(from + 4 * x + 4, from + 4 * x, to + 8 * x + 8);
  }
  blend(from + 4 * (width - 1), from + 4 * (width - 1), to + 8 * (width - 1) + 4);
}

}  // namespace

void BackgroundPass::begin(const DrawList& list, const FrameSetup& whole, const DepthPyramid& depth, const shade::Maps& maps,
                           const shade::Canvas& onto, int step) {
  half_ = step == 2 && onto.width % 2 == 0;
  const int width = half_ ? onto.width / 2 : onto.width, height = onto.height;
  const std::size_t bytes = 4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  if (half_) narrow_.resize(bytes);
  const shade::Canvas canvas = half_ ? shade::Canvas{narrow_.data(), width, height, width} : onto;
  const FrameSetup frame = half_ ? of_half_width(whole) : whole;
  data_ = frame.data;
  if (picture_ != list.road.picture) {
    picture_ = list.road.picture;
    kept_ = last_ = std::nullopt;
  }
  // kept from the second equal frame on: a moving camera pays for no copy
  if (last_ && same_background(*last_, data_) && !(kept_ && same_background(*kept_, data_))) {
    bare_.resize(bytes);
    draw_tiles(lay_tiles(frame, list.road, depth, Shade::none, width, height), data_, maps, {bare_.data(), width, height, width}, 0,
               height, nullptr);
    kept_ = data_;
  }
  last_ = data_;
  tiles_ = lay_tiles(frame, list.road, depth, Shade::cast, width, height);
  if (kept_ && same_background(*kept_, data_)) {
    for (std::ptrdiff_t y = 0; y < height; ++y)
      std::copy_n(bare_.data() + 4 * y * width, 4 * width, canvas.pixels + 4 * y * canvas.pitch);
    std::erase_if(tiles_, [](const auto& t) { return t.first.sun == Sun::bare; });
  }
}

void BackgroundPass::draw(int y0, int y1, const std::uint8_t* covered, const shade::Maps& maps, const shade::Canvas& canvas) {
  if (!half_) {
    draw_tiles(tiles_, data_, maps, canvas, y0, y1, covered);
    return;
  }
  const int width = canvas.width / 2;
  draw_tiles(tiles_, data_, maps, {narrow_.data(), width, canvas.height, width}, y0, y1, nullptr);
  for (std::ptrdiff_t y = y0; y < y1; ++y) widen(narrow_.data() + 4 * y * width, width, canvas.pixels + 4 * y * canvas.pitch);
}

}  // namespace render::gl
