// What lives for one attempt at a step: its length, the conditions that hold over it, where the bodies have come to. Made anew for
// each attempt; the buffers behind it are kept, so that a step allocates nothing.
#pragma once

#include <utility>
#include <vector>

#include "engine/joints/coordinates.h"
#include "engine/world.h"

namespace engine {

/// What a joint's resistance does over one step.
struct Resistance {
  Vec3 torque_W = Vec3::Zero();  // [N m] on the child at the start of the step, for springs
  Vec3 force_W = Vec3::Zero();   // [N] the same, of a slide, at the child's point
  Twist before;                  // of the child against the parent, under smooth forces alone
  Twist after;                   // with all impulses, before what they displaced turns the joint's axes
  JointCoordinates at_start;
  // of dry friction, per coordinate
  Eigen::Vector4d rate = Eigen::Vector4d::Zero();       // [rad/s], [m/s] at the start of the step
  Eigen::Vector4d slip_rate = Eigen::Vector4d::Zero();  // at which it yields its torque in this step; 0: whatever the rate
  Eigen::Vector4d held_back = Eigen::Vector4d::Zero();  // [rad/s], [m/s] by more friction than the given
  int effect = 0;
};

/// Trees that conditions join: they are solved together. By the smallest tree of each island.
struct Islands {
  std::vector<std::vector<int>> members;  // per tree: indices of conditions
  std::vector<int> roots;                 // trees that have members, the smallest island first: no loop goes over who has none
  std::vector<int> of_tree;               // a tree of the same island, or itself at its root
  std::vector<char> by_whole;             // per tree: all impulses displace by their whole
  std::vector<char> to_end;               // per tree: and all else by the velocities at the end of the step
  std::vector<SolveReport> reports;       // per tree
  std::vector<double> rise, left;         // [J] per tree: gained, explained by no condition
  std::vector<double> moved;              // [J] per tree: by which moving it to the end of the step raised it
  std::vector<int> line, place;           // trees of one island side by side, and per tree where
  std::vector<std::pair<int, int>> ends;  // per condition: the trees it joins; twice the same where it holds one
};

/// What impulses found in this attempt have shown of a compliant contact's spring. It stands for those found after them, in other
/// passes too.
struct SpringShown {
  enum class As : char { foretold, rests, struck, spent } as = As::foretold;
  double speed = 0;  // [m/s] struck: at which its law is taken; spent: that it gives back
};

/// Buffers of a step, sized once.
struct StepBuffers {
  explicit StepBuffers(const World&);

  Motion end;     // of the step
  Motion smooth;  // before resistance and impulses
  Motion whole;   // scheme `adaptive`: of the step taken in one
  std::vector<Constraint> constraints;
  std::vector<Constraint> end_contacts;         // found where the step ends
  std::vector<JointDamper> dampers;             // per joint
  std::vector<Resistance> resistances;          // per joint
  std::vector<Vec6> force, displacing, result;  // per body
  Islands islands;
  std::vector<double> weight;             // [-] per condition: share of the step that its displacement acts
  std::vector<double> share;              // [s] per tree: by which its impulses displace it
  std::vector<char> loosened;             // per tree: 1 where a damper is not that of the last pass
  std::vector<SpringShown> shown;         // per condition
  std::vector<Vec3> pull;                 // [m/s] per condition: along its rows by gravity over the step
  std::vector<double> dissipated_before;  // [J] per effect, when the step began
  std::vector<double> given;              // [J] per effect, by its hard conditions
  std::vector<double> allowed;            // [m] per condition of an island: what its position may still need
  std::vector<int> members;               // that exchange impulses at an instant
  std::vector<double> targets;            // of those
};

struct StepContext {
  /// A step of this length [s] from the state, with the contacts known there and what follows the clock: wheels, closed loops.
  StepContext(World&, State&, StepBuffers&, double length);
  StepContext(const StepContext&) = delete;

  World& world;
  State& state;  // at the start of the step
  StepBuffers& buffers;
  const double length;                   // [s]
  std::vector<Constraint>& constraints;  // conditions that act by impulses
  Motion& end;
  bool any_damper = false;  // a joint resists
  bool placing = false;     // impacts are still placed inside this step
  bool impulses = false;    // some were exchanged
  double residual = 0;      // [m/s] that the solver left
  int unsettled = -1;       // the condition that has it
  double joint_gap = 0;     // [m] before the joints were closed
};

/// Velocity along the rows of a condition, of a against b.
Vec3 row_velocity(const Constraint&, const std::vector<Twist>& V_WB);

}  // namespace engine
