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
enum class WithNormals { no, yes };

/// A vertex of a mesh or a point of an edge, with the normals of the faces that meet there, and at those it stands for: it can
/// press on something only in a direction between them (beside an open edge also away from it). In the middle of a flat panel that
/// is one direction, on a straight edge those across it: what slides along a panel or a rail must not feel how it is cut into
/// triangles. Of a thin tube it is any.
struct RepresentativePoint {
  Vec3 p = Vec3::Zero();
  std::vector<Vec3> normals;  // outward, no two alike; none where they are not asked for
};

/// Vertices of a mesh, and points of its long edges, thinned to the one farthest out in each cube of side `spacing` [m].
std::vector<RepresentativePoint> representative_points(const TriangleMesh&, double spacing, PointsOf, WithNormals);

/// The direction of the convex cone of `normals` (unit vectors) that is nearest to the unit vector `d`, as long as the cosine of
/// the angle between them: zero from a right angle on.
Vec3 nearest_in_cone(const std::vector<Vec3>& normals, const Vec3& d);

/// Of many contacts of one pair: the deepest and those farthest from what is chosen already, at most `most`. In place.
void keep_spread(std::vector<SurfaceContact>&, std::size_t most);

}  // namespace engine
