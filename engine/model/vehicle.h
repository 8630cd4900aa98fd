#pragma once

#include <string>
#include <vector>

#include "engine/math/types.h"
#include "engine/model/schedule.h"

namespace engine {

/// One wheel: a contact point under a suspension spring, with a friction circle.
struct Wheel {
  std::string name;
  Vec3 hub_B{0, 0, 0};        // [m] wheel centre at static load, from the centre of mass, body axes
  double radius = 0.3;        // [m]
  double width = 0.2;         // [m]
  double spring = 25e3;       // [N/m] at the wheel
  double damper = 2.5e3;      // [N s/m]
  double travel = 0.12;       // [m] each way to the stop
  double friction = 0.8;      // [-] tyre on dry road; the ground's own friction limits it too (smaller value)
  double brake_share = 0.25;  // [-] share of the brake force this wheel can take; shares sum to 1
  bool steered = false;
  bool driven = false;
};

/// A rigid body on wheels. Coupled trailers and two-wheelers are further bodies and joints.
struct Vehicle {
  std::string name;
  int body = -1;
  std::vector<Wheel> wheels;
  Schedule brake = 0.0;        // [-] pedal, 0..1; 1 asks each wheel for its share of `brake_force`
  double brake_force = 20e3;   // [N] at full pedal; the friction circle limits what of it acts
  Schedule drive_force = 0.0;  // [N] shared by driven wheels
  Schedule steer = 0.0;        // [rad] wheel angle, left positive
};

}  // namespace engine
