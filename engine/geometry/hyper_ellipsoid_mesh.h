// Contact of a hyper-ellipsoid (a) with a triangle mesh (b): faces, convex edges and vertices; inner edges are not felt.
#pragma once

#include <vector>

#include "engine/geometry/hyper_ellipsoid.h"
#include "engine/geometry/surface_contact.h"
#include "engine/geometry/triangle_mesh.h"

namespace engine {

/// Sides of a flat-sided body through which a mesh has come in: bit 2 axis for the lower one, bit 2 axis + 1 for the upper.
using Sides = std::uint8_t;

/// A vertex beyond whose edge a body reaches, and the normal there.
struct VertexTouch {
  int vertex;
  Vec3 normal;
};

/// Scratch of contacts_with_mesh, kept by the caller between steps (no allocation after warm-up).
struct MeshContactScratch {
  std::vector<int> triangles;
  /// The call a triangle was last near in, and its place among `triangles` there.
  struct Seen {
    std::uint32_t call = 0, place = 0;
  };
  std::vector<Seen> seen;    // per triangle
  std::vector<Vec3> points;  // [m] per near triangle: where the body reaches farthest against its face
  std::uint32_t call = 0;
  std::vector<SurfaceContact> candidates;
  std::vector<int> vertices;        // of a body with flat sides
  std::vector<VertexTouch> beyond;  // of a round one
  double apart = 0;                 // [m] the surfaces are at least this far from each other; negative: the deepest contact's gap
};

/// Room for whatever a body can meet of the mesh.
void reserve(MeshContactScratch&, const TriangleMesh&);

/// Points with gap < margin [m] between the hyper-ellipsoid at X_WA and the mesh at X_WM; `out` is cleared first. Normals within
/// 10 degrees are clustered; the deepest and up to three spread points stay. A part sliding over a flat sheet of many triangles
/// gets the contacts of a plane. A triangle whose plane the centre has passed by more than `passed` [-] of the body is its far side
/// and not felt, nor is what lies deeper than `least` by a quarter of the body: `least` [m] is the smallest gap there can be, from
/// what was seen before (Clearance::by_now), so a fold or the underside of a sill is not met from behind.
/// What lies deep in a flat-sided body is held by the nearest of the sides that it has `entered` through, not by the nearest of
/// all.
void contacts_with_mesh(const HyperEllipsoid&, const Pose& X_WA, const TriangleMesh&, const Pose& X_WM, double margin, double least,
                        MeshContactScratch&, ContactPoints& out, double passed = 0.25, Sides entered = 0);

/// The sides through which contacts found hold the mesh.
Sides sides_of(const HyperEllipsoid&, const Quat& q_WA, const ContactPoints&);

}  // namespace engine
