// Resistance of the air, wind included: F = -1/2 rho |u| D u with u the body's velocity through the air and D the drag areas along
// the body's axes (coefficient times section, diagonal in body axes). It acts at the centre of mass. Sections are those of the
// hyper-ellipsoid through its centre, and of the box round a mesh. 1.2 is the coefficient of a circular cylinder across the flow
// at Reynolds numbers of 1e4 to 2e5 (S. F. Hoerner, Fluid-Dynamic Drag, 1965): a standing adult of fourteen segments has 0.66 m^2.
// Of a mesh: 0.3 from the front, that is the 0.35 of a saloon car (0.22 to 0.4 by H. Heisler, Advanced Vehicle Technology, 2nd ed.
// 2002, chapter 14; vans 0.35 to 0.5, buses 0.4 to 0.8, rigid trucks 0.7 to 0.9) on 85 % of the box, as much as a car fills of it;
// from the side and from above those of blocks with rounded and with sharp edges, 0.8 and 1.0 (Hoerner: a cube 1.05).
//
// A scene without [air] has none. What that leaves out is bounded: drag takes no more than 1/2 rho D v^2/m from the speed in a unit
// of time, and never more than there is.
#include <algorithm>
#include <cmath>

#include "engine/effects/registration.h"
#include "engine/effects/words.h"
#include "engine/geometry/mesh_overlap.h"
#include "engine/math/functions.h"

namespace engine {
namespace {

constexpr double kDensity = 1.2;                             // [kg/m^3] at 20 deg C and 1013 hPa
const Vec3 kDrag{1.2, 1.2, 1.2}, kVehicleDrag{0.3, 0.8, 1};  // [-] along x, y, z of the body

constexpr SceneKey kKeys[] = {
    {"density", "kg/m^3", 1, "'1.2 kg/m^3'", "Density of the air; 0 for a vacuum.", 0},
    {"wind", "m/s", 3, "'0 0 0 m/s'", "Velocity of the air over the ground."},
    {"drag", "", 1, "1.2", "Drag coefficient of persons and free bodies, each segment by its own section.", 0},
    {"vehicle_drag", "", 3, "[0.3, 0.8, 1]",
     "Drag coefficients of a mesh along its length, width and height, by the sides of its box: those of a saloon car; a van has "
     "0.4 along its length, a bus 0.6, a truck 0.8.",
     0},
};

struct Air {
  double density = 0;
  Vec3 wind = Vec3::Zero();
  std::vector<Vec3> drag_area;  // [m^2] per body, along its axes
};

/// Areas [m^2] of the sections across x, y and z.
Vec3 sections_of(const Body& body) {
  if (const auto* shape = std::get_if<HyperEllipsoid>(&body.shape)) {
    const Vec3& a = shape->semi_axes;
    const double n = shape->exponent;
    const double fullness = 4 * math::exp(2 * math::lgamma(1 + 1 / n) - math::lgamma(1 + 2 / n));  // pi for n = 2, 4 for a box
    return fullness * Vec3(a.y() * a.z(), a.x() * a.z(), a.x() * a.y());
  }
  if (const auto* shape = std::get_if<MeshShape>(&body.shape)) {
    const Aabb box = world_bounds(*shape->mesh, shape->X_BM);
    const Vec3 side = box.upper - box.lower;
    return {side.y() * side.z(), side.x() * side.z(), side.x() * side.y()};
  }
  return Vec3::Zero();
}

std::vector<Vec3> drag_areas(const Model& model, const Vec3& drag, const Vec3& vehicle_drag) {
  std::vector<Vec3> out;
  for (const Body& body : model.bodies)
    out.push_back(body.fixed ? Vec3(Vec3::Zero()) : Vec3(sections_of(body).cwiseProduct(is_mesh(body) ? vehicle_drag : drag)));
  return out;
}

Vec3 force_on(const Air& air, std::size_t body, const Quat& q, const Vec3& v) {
  const Vec3 u = v - air.wind;
  return q * Vec3(-0.5 * air.density * u.norm() * air.drag_area[body].cwiseProduct(q.conjugate() * u));
}

// What is left out.

/// Bodies that keep together: a person, or one body.
struct Group {
  std::string name;
  std::vector<int> bodies;
  double mass = 0;
};

std::vector<Group> groups_of(const Model& model) {
  std::vector<Group> out;
  for (const Person& person : model.persons) out.push_back({person.name, person.bodies, 0});
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    if (!model.bodies[b].fixed && model.bodies[b].person < 0) out.push_back({model.bodies[b].name, {static_cast<int>(b)}, 0});
  for (Group& group : out)
    for (const int b : group.bodies) group.mass += model.bodies[b].mass;
  return out;
}

struct Bound {
  double speed = 0, way = 0;  // [m/s], [m]
  std::string of;
};

std::string in_words(const Bound& worst, const char* when) {
  if (worst.way == 0) return "air drag: nothing moves";
  return "air drag" + std::string(when) + ": at most " + number(worst.speed) + " m/s and " + number(worst.way) + " m (" + worst.of +
         "); [air] has it computed";
}

/// Speed [m/s] nothing in the scene exceeds: the fastest body, thrown on with the largest restitution, and what it can fall.
double greatest_speed(const Model& model) {
  const double T = model.settings.duration, g = model.settings.gravity.norm();
  double fastest = 0, restitution = 0, high = 0;
  for (const Body& body : model.bodies) {
    if (body.fixed) continue;
    fastest = std::max(fastest, body.V_WB.v.norm());
    restitution = std::max({restitution, body.surface.restitution_body.at(0), body.surface.restitution_ground.at(0)});
    if (model.ground.plane) high = std::max(high, body.X_WB.p.z() - model.ground.height);
  }
  if (!model.ground.plane) high = 0.5 * g * T * T;
  return math::hypot((1 + restitution) * fastest, std::sqrt(2 * g * high));
}

Bound bound_before(const Model& model) {
  const std::vector<Vec3> areas = drag_areas(model, kDrag, kVehicleDrag);
  const double v = greatest_speed(model), T = model.settings.duration;
  Bound worst;
  for (const Group& group : groups_of(model)) {
    double area = 0;
    for (const int b : group.bodies) area += areas[b].maxCoeff();
    const double a = 0.5 * kDensity * area * v * v / group.mass;  // [m/s^2]
    if (a == 0) continue;
    const double t = std::min(T, v / a);  // until it would stand
    const Bound bound{a * t, 0.5 * a * t * t + v * (T - t), group.name};
    if (bound.way > worst.way) worst = bound;
  }
  return worst;
}

Bound bound_along(const Model& model, const Recording& run) {
  const std::vector<Vec3> areas = drag_areas(model, kDrag, kVehicleDrag);
  Bound worst;
  for (const Group& group : groups_of(model)) {
    Bound bound;
    bound.of = group.name;
    double lost = 0;  // [m/s]
    for (std::size_t k = 1; k < run.snapshots.size(); ++k) {
      const double dt = run.snapshots[k].time - run.snapshots[k - 1].time;
      Vec3 momentum = Vec3::Zero();
      double force = 0;
      for (const int b : group.bodies) {
        const Vec3& v = run.snapshots[k].bodies[b].V_WB.v;
        const double fastest = std::max(v.squaredNorm(), run.snapshots[k - 1].bodies[b].V_WB.v.squaredNorm());
        force += 0.5 * kDensity * areas[b].maxCoeff() * fastest;
        momentum += model.bodies[b].mass * v;
      }
      lost = std::min(lost + force / group.mass * dt, momentum.norm() / group.mass);
      bound.speed = std::max(bound.speed, lost);
      bound.way += lost * dt;
    }
    if (bound.way > worst.way) worst = bound;
  }
  return worst;
}

Finding look_at(const Model& model) {
  const Vec3* density = input(model, "air.density");
  if (!density)
    return {false, "the scene has no [air]",
            in_words(bound_before(model), " (all the time at the greatest speed; --measure bounds it closer)")};
  if (density->x() == 0) return {false, "air.density is 0", ""};
  const Vec3 wind = *input(model, "air.wind");
  return {true,
          "air of " + number(density->x()) + " kg/m^3" + (wind.isZero() ? ", still" : ", wind of " + number(wind.norm()) + " m/s"),
          ""};
}

std::string left_out_along(const Model& model, const Recording& run) {
  if (input(model, "air.density")) return "";
  return in_words(bound_along(model, run), " along this run");
}

Air air_of(const Model& model) {
  Air air;
  if (const Vec3* density = input(model, "air.density")) {
    const double drag = input(model, "air.drag")->x();
    air.density = density->x();
    air.wind = *input(model, "air.wind");
    air.drag_area = drag_areas(model, drag * Vec3::Ones(), *input(model, "air.vehicle_drag"));
  }
  return air;
}

/// Power [W] the air takes from what moves; negative where the wind drives.
double power_taken(const World& world, const Motion& at, const Air& air) {
  double power = 0;
  if (air.density == 0) return power;
  for_awake_bodies(
      world, [&](int b) { power -= force_on(air, static_cast<std::size_t>(b), at.X_WB[b].q, at.V_WB[b].v).dot(at.V_WB[b].v); });
  return power;
}

}  // namespace

class AirDrag final : public Effect {
 public:
  static constexpr const char* kName = "air_drag";
  static constexpr SceneSection kSection{"air",
                                         "The air, where its resistance or the wind counts. Without this section there is none; "
                                         "`crashreel plan` tells what that leaves out.",
                                         kKeys};
  static Finding look(const Model& model) { return look_at(model); }
  static bool gives(const Model& model) {
    const Vec3* wind = input(model, "air.wind");
    return wind && !wind->isZero(0);
  }
  static std::string left_out(const Model& model, const Recording& run) { return left_out_along(model, run); }

  AirDrag(const World& world, int self) : Effect(self), air_(air_of(world.model)) {}

  void before_step(World& world, State& state, double) override { power_ = power_taken(world, state, air_); }

  void add_forces(const World& world, const std::vector<Pose>& X, const std::vector<Twist>& V,
                  std::vector<Vec6>& force) const override {
    if (air_.density == 0) return;
    for_awake_bodies(world, [&](int b) { force[b].head<3>() += force_on(air_, static_cast<std::size_t>(b), X[b].q, V[b].v); });
  }

  void after_step(StepContext& s) override {
    s.state.energy.dissipated[self_] += 0.5 * s.length * (power_ + power_taken(s.world, s.state, air_));
  }

 private:
  const Air air_;
  double power_ = 0;  // [W] taken at the start of the step
};
template struct Registered<AirDrag>;

}  // namespace engine
