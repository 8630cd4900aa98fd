// How soon any two things of a scene that stand apart can touch: proved before the run from their speeds, energies, drives and the
// fall of gravity, so that effects which cannot matter in it are left out.
#pragma once

#include <string>

#include "engine/model/model.h"

namespace engine {

/// The earliest touch of two groups of bodies, each held together by its joints. Before it none gets energy from another, so that
/// the speed v of a group of mass M obeys v <= sqrt(2 E/M) + t F/M: E what it has at the start in motion, suspension springs and
/// height over a level plane, F the greatest drive; on other ground gravity adds to F/M. What has springs in its joints, gives way,
/// can break, stands in the ground or in the wind may move at once as far as it likes; who waits in the zero condition walks on,
/// and two who wait touch each other no sooner than the boxes of their bodies do.
struct Reach {
  double first_touch = 0;  // [s] no earlier; infinity: not within the run
  std::string who;         // that touch, "car and pedestrian"; empty: there are no two
  /// Do all joints, all round bodies, all bodies that move belong to persons who wait for a touch?
  bool all_joints_wait = false, all_rounds_wait = false, all_bodies_wait = false;
  /// Is every group one body, or one person without a mount?
  bool groups_are_simple = false;
};

Reach reach_of(const Model&);

/// Box in world axes of a body at the start, a vehicle without its wheels; a point where it has no shape.
Aabb box_at_start(const Body&);

}  // namespace engine
