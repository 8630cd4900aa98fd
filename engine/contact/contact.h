// From points where surfaces touch or nearly touch to contacts: pairs that may meet, mixed surface properties, rows.
#pragma once

#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "engine/contact/pair_table.h"
#include "engine/geometry/hyper_ellipsoid_mesh.h"
#include "engine/geometry/surface_contact.h"
#include "engine/model/model.h"
#include "engine/solver/constraint.h"

namespace engine {

/// A segment that may touch a mesh (of a vehicle, of any other body, or the terrain).
struct MeshPair {
  int effect = 0;
  int body = 0;
  int mesh_body = kTerrain;
  const TriangleMesh* mesh = nullptr;
};

/// Two bodies that may touch each other.
struct BodyPair {
  int a = 0, b = 0;
};

/// All pairs of round bodies of the same two trees. Where there are many they are listed when the trees first come near each other:
/// of fifty persons there would be three hundred thousand.
struct BodyPairRun {
  int effect = 0;
  int tree_a = -1, tree_b = -1;  // -1: a fixed body
  bool listed = false;
  std::vector<BodyPair> pairs;
};

/// Neighbours in the list of mesh pairs, all of the same two trees: of the round bodies, and of the mesh.
struct MeshPairRun {
  int effect = 0;
  int tree_a = -1, tree_b = -1;  // -1: a fixed body
  std::size_t begin = 0, end = 0;
};

/// A mesh that wheels roll on.
struct Road {
  const TriangleMesh* mesh = nullptr;
  Pose X_WM;
  Aabb box;  // [m] world
  int body = kTerrain;
};

/// A wheel and a round body that it may run over or into.
struct TyrePair {
  int wheel = 0;  // of State::wheels
  int vehicle = 0, wheel_of_vehicle = 0;
  int vehicle_body = 0;
  int body = 0;
};

/// A point that stands for a body's mesh, or for one of its wheels, where it meets other surfaces.
struct SurfacePoint {
  Vec3 p_B = Vec3::Zero();           // [m] of a wheel at static ride
  int wheel = -1;                    // of State::wheels, -1: of the body
  double radius = 0;                 // [m] from the wheel's axle
  std::vector<Vec3> normals_B = {};  // between which it can press; none: any
};
using SurfacePoints = std::shared_ptr<const std::vector<SurfacePoint>>;  // of one body, for all its pairs

/// Of the pairs those that a step can bring together, as the broad phase saw last.
struct PairsInReach {
  std::vector<std::size_t> round, mesh;  // runs
  std::vector<std::size_t> tyres;        // pairs, by wheels
};

/// Pairs of bodies whose surfaces may touch, listed once by the effects, and scratch of their narrow phases.
struct ContactPairs {
  /// The broad phase, and which pairs it leaves.
  void look(const Outlook&);

  BroadPhase broad_phase;
  PairsInReach in_reach;
  std::vector<MeshPair> mesh;
  std::vector<MeshPairRun> mesh_runs;
  std::vector<BodyPairRun> round;
  std::vector<BodyPair> bodywork;                             // of meshes whose points meet the other's surface
  std::vector<std::array<SurfacePoints, 2>> bodywork_points;  // of those pairs, that may meet the other
  std::vector<TyrePair> tyres;                                // by wheels
  std::vector<Road> roads;                                    // the terrain first
  std::vector<std::vector<SurfacePoint>> points;              // per body with a mesh
  ContactPoints touches;                                      // scratch: those of the pair looked at last
  std::vector<SurfaceContact> point_contacts;                 // of meshes
  std::vector<int> point_scratch;
  MeshContactScratch mesh_scratch;
};

/// A search for contacts, which are appended to `found`; `before`: those of the last step's end.
struct ContactSearch : Outlook {
  const std::vector<Constraint>& before;
  std::vector<Constraint>& found;
};

/// Friction and restitution of two surfaces that touch: the smaller friction, the larger restitution.
struct SurfacePairing {
  double friction = 0;     // [-]
  double restitution = 0;  // [-]
};
/// Of a body with another, or with the ground at a point of it.
SurfacePairing mixed_surfaces(const Model&, int a, int b, const Vec3& point, double time);

/// Has the contacts of a pair found and appends them, rows and all. None of what waits or sleeps: those effects watch.
void add_contacts(ContactSearch&, const PairKind&, const ContactPair&, int effect);

/// By how much of its half thickness [-] the centre of a part may come to lie behind the panel it is pressed into before it is
/// taken for having gone through. Mostly a quarter: it is the part that gives way. It is the panel that does under a head that
/// yields hardly at all: until the head is wholly behind it.
double may_pass(const Model&, int body);

}  // namespace engine
