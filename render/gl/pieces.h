// A DrawList as runs of triangles with one material each, and the boxes of what throws shadows.
#pragma once

#include <vector>

#include "render/gl/frame_block.h"
#include "render/gl/geometry_cache.h"
#include "render/gl/materials.h"

namespace render::gl {

// enum MaterialKind, then these
constexpr int kTerrainKind = 8, kWireKind = 9;

/// From within a body its inside is seen.
enum class Culling { on, off };

struct Piece {
  const Geometry* geometry;
  const Geometry::Level* level;
  std::size_t run;  // of the level's
  int row;          // of the material table
  float opacity;
  int kind;
  Matrix4 model;
  Float3 axes;  // [m] of an ellipsoid
  bool casts;
  Culling culling;  // of what faces away
};

/// What the frame shows. `pixel_share`: tessellations stay within this part of a pixel at their distance, `height` pixels high.
std::vector<Piece> collect(const DrawList&, GeometryCache&, MaterialTable&, double pixel_share, int height,
                           std::vector<CasterBox>& boxes);

}  // namespace render::gl
