#pragma once

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "engine/math/types.h"
#include "engine/model/schedule.h"

namespace engine {

/// How a tyre's lateral force follows from its slip angle (engine/laws/tyre.h).
enum class TyreModel { linear, tm_easy };

/// How the brake force is shared out: by fixed shares, as brakes without any regulation do, or by what each wheel carries at the
/// moment, so that all reach their limit together.
enum class BrakeBalance { shares, loads };

/// One wheel: a contact point under a suspension spring, with a friction circle.
struct Wheel {
  std::string name;
  Vec3 hub_B{0, 0, 0};    // [m] wheel centre at static load, from the centre of mass, body axes
  double radius = 0.3;    // [m]
  double width = 0.2;     // [m]
  double spring = 25e3;   // [N/m] at the wheel
  double damper = 2.5e3;  // [N s/m]
  double travel = 0.12;   // [m] each way to the stop
  double friction = 0.8;  // [-] tyre on dry road; the ground's own friction limits it too (smaller value)
  TyreModel tyre = TyreModel::linear;
  double saturation_angle = 0.1745;  // [rad] linear tyre: slip angle at which the friction circle is reached
  double brake_share = 0.25;         // [-] of the vehicle's brake force, with BrakeBalance::shares; they sum to 1
  double anti_roll = 0;              // [N/m] of the axle's bar, against the wheel on the other side: force per difference of travel
  double rolling_resistance = 0;     // [-] of the load
  bool steered = false;
  bool driven = false;
};

/// Cosine between the vehicle's up axis and the ground's normal below which a wheel does not roll: the car lies on its side, and
/// its wheels' flanks are bodywork.
constexpr double kWheelFacing = 0.2;

/// [m] Tyres are as round across as wide: a leaning wheel touches with its shoulder, one on its side with its flank.
inline double crown_radius(const Wheel& wheel) {
  return std::min(0.5 * wheel.width, wheel.radius);
}

/// One act of the driver. Several may overlap; their forces add up.
struct DriverPhase {
  double first_force = 0;                                  // [s] reaction and lag are over
  double build_up = 0;                                     // [s] from there to the full force
  double until = std::numeric_limits<double>::infinity();  // [s]
  double force = 0;           // [N] of the whole vehicle at full level; of a drive negative for reversing
  bool drives = false;        // else brakes
  std::vector<double> share;  // [-] per wheel; empty: brakes by the brake balance, drives evenly by the driven wheels

  double level_at(double t) const {
    if (t < first_force || t >= until) return 0;
    return build_up > 0 ? std::min(1.0, (t - first_force) / build_up) : 1;
  }
};

/// A line on the ground that the driver steers along, looking ahead (pure pursuit: R. C. Coulter, CMU-RI-TR-92-01, 1992).
struct FollowedPath {
  std::vector<Vec3> points;  // [m] world; fewer than two: none
  double preview = 0.6;      // [s] how far ahead, at least two metres
  double largest = 0.6;      // [rad] wheel angle
  double rate = 0.6;         // [rad/s] of the wheel angle
};

/// A rigid body on wheels. Coupled trailers and two-wheelers are further bodies and joints.
struct Vehicle {
  std::string name;
  int body = -1;
  std::vector<Wheel> wheels;
  Schedule brake = 0.0;       // [-] pedal, 0..1; 1 asks each wheel for its share of `brake_force`
  double brake_force = 20e3;  // [N] at full pedal; the friction circle limits what of it acts
  BrakeBalance brake_balance = BrakeBalance::shares;
  Schedule drive_force = 0.0;  // [N] shared by driven wheels
  Schedule steer = 0.0;        // [rad] wheel angle, left positive
  std::vector<DriverPhase> sequence;
  FollowedPath path;       // steers in place of `steer`
  Vec3 drag{0.3, 0.8, 1};  // [-] of the air along its length, width and height, by the sides of the box round it
};

/// Whether it stands by itself on wheels of both sides: neither a two-wheeler nor something without wheels.
inline bool has_track(const Vehicle& vehicle) {
  bool left = false, right = false;
  for (const Wheel& wheel : vehicle.wheels) {
    left = left || wheel.hub_B.y() > 0.1;
    right = right || wheel.hub_B.y() < -0.1;
  }
  return left && right;
}

}  // namespace engine
