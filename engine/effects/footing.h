// What a wheel stands on: a level or a triangle's plane under its hub, or somebody it rolls over.
#pragma once

#include <span>

#include "engine/contact/contact.h"

namespace engine {

struct Footing {
  int body = -1;           // -1: plane or terrain
  bool found = false;      // the wheel reaches it
  bool near = false;       // it is there, but too steep to the vehicle to roll on: the car lies on its side
  double compression = 0;  // [m] of the suspension from static ride, at which the tyre just touches
  double leaving = 0;      // [m] the same of what has just become too steep
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();
};

/// Of plane, terrain and fixed meshes what compresses the suspension most: the surface under the hub, or an edge or a face before
/// or behind it that the tyre rolls over. `wheel` of State::wheels.
Footing footing_of(const Outlook&, int wheel, double droop);

/// A round body under the wheel that compresses the suspension more than what it stands on otherwise. `pairs` are the wheel's.
void step_on_bodies(const Outlook&, std::span<const std::size_t> pairs, Footing& best);

}  // namespace engine
