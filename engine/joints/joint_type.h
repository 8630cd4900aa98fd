// What a kind of joint is: which directions it holds, and by which coordinates its freedoms are counted. One file a kind.
//
// The motion subspace S (6 x freedoms) follows from what is held; factorisation, projection, closed loops, limits and resistance
// read that subspace and the coordinates, and never ask for the kind.
#pragma once

#include <array>

#include "engine/joints/coordinates.h"

namespace engine {

/// An axis fixed in the parent's joint frame and one fixed in the child's that stay at right angles to each other.
struct AxisPair {
  int parent_axis;  // column of R_WFp
  int child_axis;   // column of R_WFc
};

struct JointType {
  const char* name;     // as in a scene file
  const char* in_plan;  // as counted in the plan's reason
  /// Axes of the parent's joint frame: the child's point is held along the first `held_along`, and slides along the others.
  std::array<int, 3> axes;
  int held_along;
  /// Of two pairs both have the axis of the child that the joint turns about; the axes of a single pair are the two it turns about.
  std::array<AxisPair, 3> held_square;
  int held_turns;
  void (*coordinates)(const JointFrames&, JointCoordinates&);

  int slides() const { return 3 - held_along; }
  int turns() const { return 3 - held_turns; }
  int rows() const { return held_along + held_turns; }
};

/// Each kind defines its own, in the file of its name.
template <JointKind kind>
JointType joint_type();

/// In the order of JointKind; filled before main.
extern const std::array<JointType, static_cast<std::size_t>(JointKind::count)> kJointTypes;

inline const JointType& type_of(JointKind kind) {
  return kJointTypes[static_cast<std::size_t>(kind)];
}

}  // namespace engine
