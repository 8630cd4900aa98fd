// What stands for a mesh where it meets other surfaces: points of it and, of a vehicle, of the rims and flanks of its wheels.
#pragma once

#include <limits>
#include <vector>

#include "engine/contact/contact.h"

namespace engine {

/// A towing vehicle and its trailer.
bool coupled(const Model&, int a, int b);

/// May two meshes touch by Default-Auto?
bool meshes_meet(const Model&, int a, int b);

/// Vehicles whose wheels may meet: by Default-Auto, and not coupled.
std::vector<BodyPair> wheeled_pairs(const Model&);

/// Points round a wheel at static ride, in the middle and on either flank, from the vehicle's centre of mass, body axes.
constexpr int kRing = 24, kRimPoints = 3 * kRing;
Vec3 rim_point(const Wheel&, int i);

/// The points of all bodies with a mesh, and the pairs that meet, to `points`, `bodywork` and `bodywork_points`.
void list_mesh_pairs(const Model&, ContactPairs&);

/// Box around a body's points in world axes.
Aabb box_of(const World&, const Motion&, int body);

/// Some of a body's points: those of its mesh stand before those of its wheels.
struct PointRange {
  std::size_t begin = 0, end = 0;
};
std::size_t first_of_wheels(const std::vector<SurfacePoint>&);

/// A surface that points are held against: a mesh at a pose, or the plane z = height where there is none.
struct PointTarget {
  const TriangleMesh* mesh = nullptr;
  Pose X_WM = {};
  double height = 0;                                        // [m]
  Aabb within = {};                                         // what is outside of this box is not looked at
  double rolls = 0;                                         // [-] cosine to the up axis: a wheel rolls on what is nearer to level
  bool is_ground = true;                                    // its tyre carries a wheel that rolls there, however it got there
  const Road* road = nullptr;                               // its tyre carries a wheel that mounts it
  double least = -std::numeric_limits<double>::infinity();  // [m] what has a smaller gap is not met
};

/// Contacts of a body's points with it, to ContactPairs::point_contacts.
void touch_with_points(const Outlook&, int body, const std::vector<SurfacePoint>&, PointRange, const PointTarget&, double margin);

}  // namespace engine
