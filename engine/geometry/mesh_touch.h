// How a hyper-ellipsoid touches one face, edge or vertex of a mesh; contacts_with_mesh goes over those that are near.
#pragma once

#include <limits>

#include "engine/geometry/face_corners.h"
#include "engine/geometry/hyper_ellipsoid_mesh.h"

namespace engine {

constexpr std::uint32_t kDeepest = 5;  // rank of a face's deepest point after its corners 1 to 4, as on a plane; 0: edge or vertex

/// A body and a mesh that may touch, and where what is found goes.
struct MeshTouch {
  const HyperEllipsoid& shape;
  Pose X_MA;  // body in the mesh frame
  const TriangleMesh& mesh;
  double margin;
  double least;                           // [m] smallest gap that can be of this side
  Sides entered;                          // of a body with flat sides
  MeshContactScratch& scratch;            // candidates: mesh axes, from the body's centre
  SmallVector<Vec3, 5> last_points = {};  // [m]
  Vec3 last_normal = Vec3::Zero();

  bool flat() const { return shape.exponent >= kFlatExponent; }
  bool is_near(int triangle) const { return scratch.seen[static_cast<std::size_t>(triangle)].call == scratch.call; }
  const Vec3& point_of_near(int triangle) const { return scratch.points[scratch.seen[static_cast<std::size_t>(triangle)].place]; }
  Vec3 vertex(int v) const { return mesh.vertices()[static_cast<std::size_t>(v)] - X_MA.p; }

  /// The deepest point against a face of this normal and, of a body with flat sides, the corners of its side, of rank 1 to 4: those
  /// of the last normal are kept, for a panel may have thousands of triangles.
  const SmallVector<Vec3, 5>& points_against(const Vec3& normal);
};

/// Outward normal of one of the Sides, in body axes.
inline Vec3 outward_of(int side) {
  return (side % 2 ? 1 : -1) * Vec3::Unit(side / 2);
}

void touch_face(MeshTouch&, int triangle);
/// Of a round body, after the faces of all near triangles. Where the point reached projects beyond an end, that vertex is worth a
/// look with the normal found.
void touch_edge_round(MeshTouch&, int triangle, int edge);
/// The normal whose support point lies over the vertex, from a guess: Newton on the distance, which is largest there.
void touch_vertex_round(MeshTouch&, const VertexTouch& guess);
/// Of a body with flat sides.
void touch_edge_flat(MeshTouch&, int triangle, int edge);
void touch_vertex_flat(MeshTouch&, int vertex);

}  // namespace engine
