// Triangles of a hyper-ellipsoid: a cube's grid pushed out along rays to the surface, so that n = 30 gets its edges and n = 2 no
// poles.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/geometry/hyper_ellipsoid.h"

namespace render {

struct Tessellation {
  std::vector<float> positions;  // xyz, body axes
  std::vector<float> normals;
  std::vector<std::uint32_t> indices;
};

/// `cells` per cube edge: 6 * cells^2 * 2 triangles, closed, counter-clockwise seen from outside.
Tessellation tessellate(const engine::HyperEllipsoid&, int cells);

/// Largest distance [m] along the radius from triangles to surface, at centroids and middles of edges; never less than the true gap
/// there.
double largest_gap(const engine::HyperEllipsoid&, const Tessellation&);

/// Fewest cells of a ladder up to 56 whose largest gap stays below `tolerance` [m], else 56. Measured, so call it once a shape.
int cells_for(const engine::HyperEllipsoid&, double tolerance);

}  // namespace render
