// Everything one run works with besides its State: the topology, the factorisations, this step's constraints. One workspace,
// allocated once, so that the step allocates nothing.
#pragma once

#include <algorithm>
#include <any>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "engine/geometry/hyper_ellipsoid_mesh.h"
#include "engine/geometry/mesh_overlap.h"
#include "engine/meter.h"
#include "engine/model/model.h"
#include "engine/plan.h"
#include "engine/simulate.h"
#include "engine/solver/articulation.h"
#include "engine/solver/constraint.h"
#include "engine/solver/contact_solver.h"
#include "engine/solver/loop_closure.h"
#include "engine/state.h"

namespace engine {

/// What is known of the distance between two bodies: at least `least` when the second stood at `X` in the frame of the first.
/// Spares a pair its narrow phase for as long as it cannot matter; a bound, not a guess.
struct Clearance {
  double least = -std::numeric_limits<double>::infinity();  // [m] not known yet; negative: as deep as they met
  Pose X;
  double most = std::numeric_limits<double>::infinity();  // [m] of two that met

  /// Two surfaces were seen `apart` now. What was inside by more than it has gone since is inside still, where a look finds nothing
  /// of it: over a crack in a mesh, say.
  void note(double apart, const Pose& X_now, double reach) {
    const double way = std::isfinite(least) ? least - by_now(X_now, reach) : 0;
    const bool missed = most + way < 0 && apart > most + way;
    least = missed ? least - way : apart;
    most = missed ? most + way : apart < 0 ? apart : std::numeric_limits<double>::infinity();
    X = X_now;
  }

  /// Farther apart than `margin` still, wherever the second body has gone since? Its points lie within `reach` of its centre [m].
  bool beyond(double margin, const Pose& X_now, double reach) const { return least > margin && by_now(X_now, reach) > margin; }

  /// The least distance [m] they can have now that the second body stands at X_now.
  double by_now(const Pose& X_now, double reach) const {
    // |dq| = 2 sin(angle/4), so 2 |dq| bounds the chord 2 sin(angle/2) of a point at distance one
    const double dq =
        std::sqrt(std::min((X_now.q.coeffs() - X.q.coeffs()).squaredNorm(), (X_now.q.coeffs() + X.q.coeffs()).squaredNorm()));
    return least - (X_now.p - X.p).norm() - 2 * dq * reach;
  }
};

/// A segment that may touch a mesh (of a vehicle, of any other body, or the terrain).
struct MeshPair {
  int effect = 0;
  int body = 0;
  int mesh_body = -1;  // -1: terrain
  const TriangleMesh* mesh = nullptr;
  Clearance clearance;  // of the segment in the frame of the mesh
};

/// Two bodies that may touch each other.
struct BodyPair {
  int a = 0, b = 0;
};

/// What such a pair keeps from step to step.
struct PairMemory {
  Vec3 normal_W = Vec3::Zero();  // of the last step, zero: none yet
  Clearance clearance;           // of b in the frame of a
};

struct World;

/// All pairs of round bodies of the same two trees. Where there are many they are listed when the trees first come near each other:
/// of fifty persons there would be three hundred thousand. Their memory stands apart: of most pairs a step asks no more than who
/// they are.
struct BodyPairRun {
  int effect = 0;
  int tree_a = -1, tree_b = -1;  // -1: a fixed body
  bool listed = false;
  std::vector<BodyPair> pairs;
  std::vector<PairMemory> memory;  // of the same
};

/// Neighbours in the list of mesh pairs, all of the same two trees: of the round bodies, and of the mesh.
struct MeshPairRun {
  int effect = 0;
  int tree_a = -1, tree_b = -1;  // -1: a fixed body
  std::size_t begin = 0, end = 0;
};

/// Which bodies, and which trees of them, have anything to do with each other in a step: spheres about them, with the way they can
/// go in it. Bounds on `pair_margin`, cheaper than it.
class Nearness {
 public:
  /// From where bodies are and how they move. Before anything looks for contacts.
  void look(const World&, const State&);
  bool close(int tree_a, int tree_b) const {
    return tree_a < 0 || tree_b < 0 || tree_a == tree_b || close_[static_cast<std::size_t>(tree_a) * radius_.size() + tree_b] != 0;
  }
  /// Farther apart than their reach and `pair_margin`?
  bool apart(const State& state, int body_a, int body_b) const {
    const double within = swept_[body_a] + swept_[body_b] + spare_;
    return (state.X_WB[body_a].p - state.X_WB[body_b].p).squaredNorm() > within * within;
  }

 private:
  double spare_ = 0;           // [m] of a pair
  std::vector<double> swept_;  // [m] per body: about its centre, with its way
  std::vector<Vec3> centre_;   // [m] per tree
  std::vector<double> radius_;
  std::vector<char> close_;  // trees x trees
};

/// A point that stands for a body's mesh, or for one of its wheels, where it meets other surfaces.
struct SurfacePoint {
  Vec3 p_B = Vec3::Zero();  // [m] of a wheel at static ride
  int wheel = -1;           // of World::wheels, -1: of the body
};

/// What two meshes whose points may meet the other's surface keep from step to step: of b in the frame of a, points of a on b and
/// points of b on a.
using BodyworkClearance = std::array<Clearance, 2>;

/// Two meshes that collide by Kudlich-Slibar.
struct ImpactPair {
  int a = 0, b = 0;
  ImpactSettings settings;
  bool touching = false;
  double due = 0;  // [s] when the impulse is exchanged, while touching
  int exchanges = 0;
};

/// What the wheel effect keeps between steps.
struct WheelState {
  int vehicle = 0, wheel = 0;
  double static_load = 0;       // [N]
  double compression = 0;       // [m] from static ride, positive: compressed
  double lift = 0;              // [m] of the hub from static ride: no more than the stops let it
  double brake = 0;             // [N] asked for now
  Vec3 contact = Vec3::Zero();  // [m] world
  Vec3 hub = Vec3::Zero();      // [m] world
  Vec3 impulse = Vec3::Zero();  // [N s] last step: load, longitudinal, lateral
  double slip = 0;              // [m/s]
  double drive = 0;             // [N] of the engine at this wheel now
  double steer = 0;             // [rad]
  bool locked = false;
};

/// Joints of one leg whose passive torques know each other's angles; -1: has none.
struct PassiveLeg {
  int hip = -1;
  int knees[2] = {-1, -1};
  int ankle = -1;
};

/// Trees of bodies that lie still and are left alone until something comes near.
struct Sleep {
  std::vector<char> asleep;  // per tree; empty: the effect is off
  std::vector<char> still;   // per tree, scratch
  std::vector<Pose> X_then;  // per body, at the last look
  double next_look = 0;      // [s]
};

/// What a joint's resistance does over one step.
struct Resistance {
  Vec3 torque_W = Vec3::Zero();  // [N m] on the child at the start of the step, for springs
  Vec3 w_before = Vec3::Zero();  // [rad/s] relative angular velocity under smooth forces alone
  Vec3 w_after = Vec3::Zero();   // [rad/s] with all impulses, before what they displaced turns the joint's axes
  Mat3 axes_W = Mat3::Zero();    // of the articulation angles, columns
  // of dry friction, per articulation angle
  Vec3 rate = Vec3::Zero();       // [rad/s] at the start of the step
  Vec3 slip_rate = Vec3::Zero();  // [rad/s] at which it yields its torque in this step, 0: has none
  Vec3 change = Vec3::Zero();     // [rad/s^2] of the rate over the last step
  int effect = 0;
};

/// [-] of the step: instants nearer than this to the ends of a step are taken there.
constexpr double kSliver = 1e-3;

/// Conditions the buffers of a step have room for from the start: a step allocates nothing until there are more.
constexpr std::size_t kRoom = 128;

/// The moment at which a run falls farthest short of one of its bounds, and between whom.
struct Shortfall {
  double amount = 0, time = 0;
  int body_a = -1, body_b = -1;

  void note(double amount_now, double now, const Constraint& c) {
    if (amount_now > amount) *this = {amount_now, now, c.record_a, c.record_b};
  }
};

/// Two bodies that stand inside each other before anything has moved.
struct Overlap {
  int a = -1, b = -1;
  double depth = 0;  // [m]
};

struct World {
  World(const Model&, const Plan&, const RunOptions&);

  const Model& model;
  const Plan& plan;
  const RunOptions& options;
  Topology topology;
  Articulation smooth;   // of the stage at hand, undamped
  Articulation impulse;  // at the start of the step, with joint resistance
  LoopClosure loops;     // of the joints cut from the trees
  ContactSolver solver;

  std::vector<double> tree_mass;  // [kg] per tree
  std::vector<double> reach;      // [m] per body: radius of its shape about the centre, 0 without
  std::vector<char> awake;        // per body: takes part in this step
  std::vector<int> active_trees;
  std::vector<MeshPair> mesh_pairs;
  std::vector<BodyPairRun> body_pair_runs;
  std::vector<MeshPairRun> mesh_pair_runs;
  Nearness nearness;
  std::vector<WheelState> wheels;
  std::vector<Vec3> joint_load;                           // [N] on the child, per joint; of those that can break
  std::vector<std::vector<SurfacePoint>> surface_points;  // per body with a mesh, for meshes against others
  std::vector<BodyPair> bodywork_pairs;
  std::vector<BodyworkClearance> bodywork_clearances;  // of the same
  std::vector<SurfaceContact> point_contacts;          // scratch of those
  std::vector<int> point_scratch;
  MeshContactScratch mesh_scratch;
  std::vector<double> path_steer;  // [rad] per vehicle that follows a path
  std::vector<ImpactPair> impact_pairs;
  Sleep sleep;
  OverlapScratch overlap;
  std::vector<Vec6> impact_force, impact_change;  // per body, of an impulse between two

  // this step
  double time = 0;                                                // [s] its start
  double step = 0;                                                // [s] its length
  double next_instant = std::numeric_limits<double>::infinity();  // [s] at which a step must end, if no more than one away
  std::vector<Constraint> constraints;
  std::vector<JointDamper> dampers;        // per joint
  std::vector<Resistance> resistances;     // per joint
  std::vector<char> resistance_in_stages;  // per joint: springs and dampers act in the stages of Runge and Kutta
  std::vector<PassiveLeg> passive_legs;
  double resistance_power = 0;  // [W] what those take out at the start of the step
  bool any_damper = false;

  std::vector<std::any> memory;  // per effect of the plan: what it keeps to itself, set in its `begin`

  // for the books, per effect of the plan
  std::vector<double> dissipated;  // [J]
  Meter meter;
  double added = 0;          // [J]
  double spring_energy = 0;  // [J] in the suspensions now
  Diagnostics diagnostics;
  Shortfall unsettled;            // [m/s] conditions that the solver left unmet
  std::vector<Overlap> overlaps;  // at the start
  std::vector<Event> events;
  std::vector<ContactRecord> exchanges;  // at an instant and by no constraint (Kudlich-Slibar), over the whole run
  std::optional<Failure> failure;

  double overlap_at_start(int a, int b) const;  // [m] 0 if they stood apart
};

/// Largest distance [m] body `b` can travel towards anything in this step, with a little to spare.
double contact_margin(const World&, const State&, int body);

/// The same between two bodies, from their relative motion.
double pair_margin(const World&, const State&, int a, int b);

/// Told of what stands inside something else before anything has moved: two bodies (-1: the ground) and their gap [m].
void warn_of_overlap(World&, int a, int b, double gap);

/// Appends a contact of body `a` with `b` (-1: the ground), rows and all. `b` may be a fixed body.
void add_contact(World&, const State&, const SurfaceContact&, int a, int b, int effect, ContactKind, double friction,
                 double restitution);

/// Compliant law: the points appended from `first` on, all of one surface on another, share its stiffness S by depth, so that a
/// face that stands on four corners, or a limb on many small triangles, yields as one that touches at one point: S_i = S d_i /
/// sum_j d_j max(0, n_i.n_j). Points that face different ways do not share.
void share_stiffness(World&, std::size_t first);

/// Velocity (6) of a body; zero for the world.
Vec6 velocity_of(const State&, int body);

/// Relative velocity of a against b along the rows of a constraint.
Vec3 row_velocity(const Constraint&, const std::vector<Twist>& V_WB);

/// Kinetic and gravitational energy [J] of all bodies that move.
double kinetic_energy(const Model&, const State&);
double potential_energy(const Model&, const State&);

}  // namespace engine
