// Joints between two bodies, or a body and the world.
#pragma once

#include <array>
#include <limits>
#include <string>

#include "engine/math/types.h"

namespace engine {

/// A kind is a word here and the file of its name in engine/joints/, which says what it leaves free.
enum class JointKind { revolute, universal, spherical, ragdoll, fixed, prismatic, cylindrical, spinal, count };

/// Coordinates of a joint: swing x, swing y, twist z, slide along y.
constexpr int kCoordinates = 4;
constexpr int kSlide = 3;

/// One coordinate of a joint: an articulation angle, or the slide with m for rad and N for N m.
///
/// The relative rotation R_FpFc is split into a swing (rotation vector with components x and y) and a twist about z; the three
/// angles are swing x, swing y, twist z. A person's frames: x forward, y left, z up in the standing pose turned to the middle of
/// the range, so that no angle comes near 180 deg, where the swing is singular.
struct JointCoordinate {
  double lower = -std::numeric_limits<double>::infinity();  // [rad]
  double upper = std::numeric_limits<double>::infinity();   // [rad]
  double stiffness = 0;                                     // [N m/rad] resistive spring
  double rest = 0;                                          // [rad] at which the spring is slack
  double damping = 0;                                       // [N m s/rad]
  double friction = 0;                                      // [N m] constant resistance
  double stop_stiffness = 0;                                // [N m/rad] at the ends, compliant law only; 0: rigid stops
};

/// Passive elastic torque inside the range of motion of a leg's joints (engine/laws/passive_torque.h). It acts about y of the
/// child's and the parent's body axes, which agree when the leg is straight. Joints of one leg follow each other down the tree;
/// several that are called knee share its flexion.
enum class PassiveTorque { none, hip, knee, ankle };

struct Joint {
  std::string name;
  JointKind kind = JointKind::spherical;
  int parent = -1;                        // body index, -1: the world
  int child = 0;                          // body index
  Pose X_PF;                              // joint frame in the parent (in the world for parent -1)
  Pose X_CF;                              // joint frame in the child
  std::array<JointCoordinate, 3> angles;  // x, y, z as above; a revolute joint uses y only
  JointCoordinate slide;                  // of the child's point along y of the parent's joint frame, of a spinal joint along z
  PassiveTorque passive = PassiveTorque::none;
  double passive_share = 1;  // [-] of an adult's torque
  int flexes_about = 1;      // +1: a turn about +y is flexion (knee), -1: about -y (hip, ankle)
  double breaking_force = std::numeric_limits<double>::infinity();  // [N] a grip or pedal lets go above it; mean over some 10 ms

  const JointCoordinate& coordinate(int i) const { return i == kSlide ? slide : angles[static_cast<std::size_t>(i)]; }
};

}  // namespace engine
