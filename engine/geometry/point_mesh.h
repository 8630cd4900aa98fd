// A point against a triangle mesh, and the points that stand for a mesh where it meets others.
#pragma once

#include <optional>
#include <vector>

#include "engine/geometry/surface_contact.h"
#include "engine/geometry/triangle_mesh.h"

namespace engine {

/// Nearest surface of the mesh within `reach` [m] of a point (mesh frame): gap negative behind the surface, normal outwards. On the
/// border of several triangles the one that faces the point most decides the sign.
struct NearestSurface {
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();
  double gap = 0;
  int triangle = -1;
};
std::optional<NearestSurface> nearest_surface(const TriangleMesh&, const Vec3& p, double reach, std::vector<int>& scratch);

/// Point of the triangle a, b, c nearest to p.
Vec3 nearest_in_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// Vertices are enough for a plane to lie on; another mesh may come between them.
enum class PointsOf { vertices, vertices_and_edges };

/// Vertices of a mesh, and points of its long edges, thinned to the one farthest out in each cube of side `spacing` [m].
std::vector<Vec3> representative_points(const TriangleMesh&, double spacing, PointsOf);

/// Of many contacts of one pair: the deepest and those farthest from what is chosen already, at most `most`. In place.
void keep_spread(std::vector<SurfaceContact>&, std::size_t most);

}  // namespace engine
