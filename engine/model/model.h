// What a scene contains. Constant while it runs; plain structs with defaults, SI units, no behaviour.
#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/model/body.h"
#include "engine/model/impact.h"
#include "engine/model/joint.h"
#include "engine/model/person.h"
#include "engine/model/vehicle.h"

namespace engine {

constexpr double kGravity = 9.81;  // [m/s^2] the value of the published cases the tests compare with

/// A rectangle, sides along x and y, where the road has another friction: wet, ice. Later ones lie over earlier ones.
struct GroundPatch {
  Vec3 lower = Vec3::Zero(), upper = Vec3::Zero();  // [m] world, z is not looked at
  Schedule friction = 1.0;                          // [-]
};

struct Ground {
  bool plane = true;                                   // an infinite plane z = height
  double height = 0;                                   // [m]
  std::shared_ptr<const TriangleMesh> terrain;         // world frame; in place of or besides the plane
  SurfaceProperties surface{1.0, 1.0, 0.0, 0.0, 1e9};  // friction: the smaller of two surfaces acts, so 1.0 leaves it to the other
  std::vector<GroundPatch> patches;

  double friction_at(const Vec3& point, double time) const {
    for (auto patch = patches.rbegin(); patch != patches.rend(); ++patch)
      if (((point - patch->lower).head<2>().array() >= 0).all() && ((patch->upper - point).head<2>().array() >= 0).all())
        return patch->friction.at(time);
    return surface.friction_ground.at(time);
  }

  /// Of the plane or the terrain [m], whichever is first met straight down from a point; nothing over a hole.
  std::optional<double> height_below(const Vec3& from) const {
    constexpr double kDeepest = 1e6;  // [m]
    std::optional<double> highest;
    if (plane && height <= from.z()) highest = height;
    double way = 0;
    int triangle = -1;
    if (terrain && terrain->raycast(from, -Vec3::UnitZ(), highest ? from.z() - *highest : kDeepest, way, triangle))
      highest = from.z() - way;
    return highest;
  }
};

enum class Scheme { stepping, rk4, adaptive };
/// default_auto: nothing gives way. compliant: everything does. persons_yield: persons do, at whatever they touch and at the ends
/// of their joints' ranges; vehicles, free bodies and road among themselves do not.
enum class ContactLaw { default_auto, compliant, persons_yield };
/// Whether a contact gives way: `person` tells whether one of the two is a person's part.
inline bool yields(ContactLaw law, bool person) {
  return law == ContactLaw::compliant || (law == ContactLaw::persons_yield && person);
}
enum class Force { automatic, on, off };  // a scene's author may force an effect

struct Settings {
  double duration = 4.0;          // [s]
  double step = 1e-3;             // [s]
  double record_interval = 5e-3;  // [s] between snapshots; rounded to whole steps
  Scheme scheme = Scheme::stepping;
  ContactLaw contact_law = ContactLaw::default_auto;
  Vec3 gravity{0, 0, -kGravity};         // [m/s^2]
  double solver_tolerance = 1e-5;        // [m/s] residual of the contact solver
  double touch_distance = 2e-5;          // [m] surfaces nearer than this exchange impulses
  double adaptive_tolerance = 1e-5;      // [m] error of a step, scheme `adaptive`
  int contacts_per_pair = 10;            // points at which two meshes hold each other at a time
  bool locate_events = true;             // place restitution impacts inside the step
  bool sleep = false;                    // what lies still is left alone until something comes near
  bool stop_at_rest = true;              // end the run when everything has come to rest
  std::map<std::string, Force> effects;  // forced effects by name
};

/// Compliant contacts act as forces in the stages of Runge and Kutta, not by impulses.
inline bool contacts_in_stages(const Settings& settings) {
  return settings.contact_law == ContactLaw::compliant && settings.scheme != Scheme::stepping;
}

struct Model {
  std::vector<Body> bodies;
  std::vector<Joint> joints;
  std::vector<Person> persons;
  std::vector<Vehicle> vehicles;
  std::vector<ImpactSettings> impacts;  // pairs not named here have the defaults
  Ground ground;
  Settings settings;
  std::map<std::string, Vec3> inputs;  // SI, by "section.key", a number in x: scene keys that effects bring with them
};

/// Does a joint hold the two bodies together?
inline bool jointed(const Model& model, int a, int b) {
  return std::any_of(model.joints.begin(), model.joints.end(),
                     [&](const Joint& j) { return (j.parent == a && j.child == b) || (j.parent == b && j.child == a); });
}

/// A segment of a person, not its mount? -1: the ground.
inline bool is_part(const Model& model, int body) {
  return body >= 0 && model.bodies[body].person >= 0 && model.bodies[body].vehicle < 0;
}

/// Does by the scene's law yield what these two touch each other with?
inline bool yields_between(const Model& model, int a, int b) {
  return yields(model.settings.contact_law, is_part(model, a) || is_part(model, b));
}

}  // namespace engine
