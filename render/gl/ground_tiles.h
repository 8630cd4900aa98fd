// The picture in tiles, each with the cheapest kernel that is exact for it: sky or ground, which part of the road's pattern it can
// show, what the sun can do there. No GL.
#pragma once

#include <compare>
#include <map>
#include <vector>

#include "render/gl/depth_pyramid.h"
#include "render/gl/frame_block.h"

namespace render::gl {

enum class Zone { sky, everything, roadway, asphalt, pavement, grass };  // what of the pattern
enum class Sun { bare, lit, dark, open };  // bare: neither shadow nor occlusion; open: ask the shadow map

struct TileLook {
  Zone zone = Zone::sky;
  Sun sun = Sun::bare;
  bool near = false;  // no haze of the horizon yet
  auto operator<=>(const TileLook&) const = default;
};

enum class Shade { none, cast };  // none: as if nothing threw shadows

/// Rectangles that cover the picture, by look.
using TileMap = std::map<TileLook, std::vector<Rectangle>>;
TileMap lay_tiles(const FrameSetup&, const RoadLook&, const DepthPyramid&, Shade, int width, int height);

}  // namespace render::gl
