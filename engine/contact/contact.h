// From points where surfaces touch or nearly touch to contacts: pairs that may meet, the search, mixed surface properties, rows.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "engine/contact/broad_phase.h"
#include "engine/geometry/hyper_ellipsoid_mesh.h"
#include "engine/geometry/surface_contact.h"
#include "engine/model/model.h"
#include "engine/solver/constraint.h"

namespace engine {

/// A segment that may touch a mesh (of a vehicle, of any other body, or the terrain).
struct MeshPair {
  int effect = 0;
  int body = 0;
  int mesh_body = -1;  // -1: terrain
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

/// A wheel and a round body that it may run over or into.
struct TyrePair {
  int wheel = 0;  // of State::wheels
  int vehicle = 0, wheel_of_vehicle = 0;
  int vehicle_body = 0;
  int body = 0;
};

/// A point that stands for a body's mesh, or for one of its wheels, where it meets other surfaces.
struct SurfacePoint {
  Vec3 p_B = Vec3::Zero();  // [m] of a wheel at static ride
  int wheel = -1;           // of State::wheels, -1: of the body
};

/// Pairs of bodies whose surfaces may touch, listed once by the effects, and scratch of their narrow phases.
struct ContactPairs {
  BroadPhase broad_phase;
  std::vector<MeshPair> mesh;
  std::vector<MeshPairRun> mesh_runs;
  std::vector<BodyPairRun> round;
  std::vector<BodyPair> bodywork;                                         // of meshes whose points meet the other's surface
  std::vector<std::array<std::vector<SurfacePoint>, 2>> bodywork_points;  // of those pairs, that may meet the other
  std::vector<TyrePair> tyres;                                            // by wheels
  std::vector<std::vector<SurfacePoint>> points;                          // per body with a mesh
  std::vector<SurfaceContact> point_contacts;                             // scratch
  std::vector<int> point_scratch;
  MeshContactScratch mesh_scratch;
};

/// A search for contacts, which are appended to `found`.
struct ContactSearch : Outlook {
  std::vector<Constraint>& found;
};

/// Friction and restitution of two surfaces that touch: the smaller friction, the larger restitution.
struct SurfacePairing {
  double friction = 0;     // [-]
  double restitution = 0;  // [-]
};
SurfacePairing between_bodies(const Body& a, const Body& b, double time);
/// The same of a body on the ground; friction at a point of it.
double restitution_on_ground(const Body&, const Ground&, double time);
double friction_on_ground(const Body&, const Ground&, const Vec3& point, double time);

/// What stands for the ground in place of a second body.
constexpr int kPlane = -1, kTerrain = -2;

/// What a contact of these two is in the record: by their shapes.
ContactKind kind_of_pair(const Model&, int a, int b);

/// Appends a contact of body `a` with `b`, rows and all. `b` may be a fixed body, the plane or the terrain.
void add_contact(ContactSearch&, const SurfaceContact&, int a, int b, int effect, SurfacePairing);

/// By how much of its half thickness [-] the centre of a part may come to lie behind the panel it is pressed into. Mostly a
/// quarter: it is the part that gives way. It is the panel that does under a head that yields hardly at all, by 12 to 19 cm at
/// most.
double may_pass(const Model&, int body);

/// Compliant law: the points appended from `first` on, all of one surface on another, share its stiffness S by depth, so that a
/// face that stands on four corners, or a limb on many small triangles, yields as one that touches at one point: S_i = S d_i /
/// sum_j d_j max(0, n_i.n_j). Points that face different ways do not share.
void share_stiffness(ContactSearch&, std::size_t first);

}  // namespace engine
