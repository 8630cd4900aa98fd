// The space that two bodies share when rigid meshes have run into each other: its volume, centroid and the plane between them.
//
// Vertical lines on a grid, which lies with the headings of the two: a scene turned as a whole finds the same. Along each a mesh is
// taken as filled from its lowest to its highest surface, so that open undersides, wheel arches and windows of a vehicle's mesh do
// not matter. The contact normal is that direction of moving body a in which the shared volume shrinks fastest: the gradient of the
// volume is the vector area of the part of a's surface inside b, hence the normal of the plane that best spans the curve in which
// the surfaces cut each other. In plan view that is the line through the points where the outlines cross.
#pragma once

#include <optional>
#include <vector>

#include "engine/geometry/triangle_mesh.h"

namespace engine {

/// A box in plan axes P: upright, turned about the vertical through the world's origin.
struct PlanBox {
  Quat q_WP = Quat::Identity();
  Aabb box_P;  // [m]
};

struct MeshOverlap {
  double volume = 0;              // [m^3]
  Vec3 centroid = Vec3::Zero();   // [m] world
  Vec3 normal_W = Vec3::UnitX();  // unit, horizontal, from b to a
  PlanBox region;                 // around what is shared
};

/// Kept by the caller: no allocation after the first call.
struct OverlapScratch {
  struct Span {
    double low = 1, high = 0;  // [m] empty where high < low
  };
  std::vector<Span> a, b;
};

void reserve(OverlapScratch&);

/// Box in world axes of a mesh at a pose.
Aabb world_bounds(const TriangleMesh&, const Pose& X_WM);

/// Nothing if the meshes share less than a grid cell (1/64 of the region their boxes share, then of the shared region itself).
std::optional<MeshOverlap> overlap_of(const TriangleMesh& a, const Pose& X_WA, const TriangleMesh& b, const Pose& X_WB,
                                      OverlapScratch&);

/// Do the meshes share anything along the lines of a grid over `region`? A grid that stays where it is tells when they begin to.
bool share_space(const TriangleMesh& a, const Pose& X_WA, const TriangleMesh& b, const Pose& X_WB, const PlanBox& region,
                 OverlapScratch&);

}  // namespace engine
