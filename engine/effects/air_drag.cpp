// Resistance of the air, wind included: F = -1/2 rho |u| D u with u the body's velocity through the air and D the drag areas along
// the body's axes (coefficient times section, diagonal in body axes). It acts at the centre of mass. Sections are those of the
// hyper-ellipsoid through its centre, and of the box round a mesh. 1.2 is the coefficient of a circular cylinder across the flow
// at Reynolds numbers of 1e4 to 2e5 (S. F. Hoerner, Fluid-Dynamic Drag, 1965): a standing adult of fourteen segments has 0.66 m^2.
// A vehicle has its own (scenes/library). Another mesh has 0.3 from the front, that is the 0.35 of a saloon car (0.22 to 0.4 by
// H. Heisler, Advanced Vehicle Technology, 2nd ed. 2002, chapter 14) on 85 % of the box, as much as a car fills of it; from the
// side and from above those of blocks with rounded and with sharp edges, 0.8 and 1.0 (Hoerner: a cube 1.05).
//
// A scene without [air] has still air of the usual density around its vehicles and persons, unless what it is worth is below
// kShare. Its free bodies have none: nobody knows what they are meant to be. What that leaves out is told as the speed that drag
// would take: 1/2 rho A v^2/m in a unit of time. Before the run v is bounded by the energy there is, after it v is that of the run.
#include <algorithm>
#include <cmath>

#include "engine/effects/greatest_energy.h"
#include "engine/effects/registration.h"
#include "engine/effects/words.h"
#include "engine/geometry/mesh_overlap.h"
#include "engine/math/functions.h"

namespace engine {
namespace {

constexpr double kDensity = 1.2;                          // [kg/m^3] at 20 deg C and 1013 hPa
const Vec3 kDrag{1.2, 1.2, 1.2}, kMeshDrag{0.3, 0.8, 1};  // [-] along x, y, z of the body

constexpr SceneKey kKeys[] = {
    {"density", "kg/m^3", 1, "'1.2 kg/m^3'", "Density of the air; 0 for a vacuum.", 0},
    {"wind", "m/s", 3, "'0 0 0 m/s'", "Velocity of the air over the ground."},
    {"drag", "", 1, "1.2", "Drag coefficient of persons and free bodies, each segment by its own section.", 0},
    {"vehicle_drag", "", 3, "",
     "Drag coefficients of all meshes along their length, width and height, by the sides of their boxes. Left out: each vehicle "
     "has its own, other meshes those of a saloon car, [0.3, 0.8, 1].",
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

/// Coefficients along the axes of a body: those given for all meshes, or each vehicle's own where there are none.
Vec3 drag_of(const Model& model, const Body& body, const Vec3& drag, const Vec3* of_all_meshes) {
  if (!is_mesh(body)) return drag;
  if (of_all_meshes) return *of_all_meshes;
  return body.vehicle >= 0 ? model.vehicles[body.vehicle].drag : kMeshDrag;
}

std::vector<Vec3> drag_areas(const Model& model, const Vec3& drag, const Vec3* of_all_meshes = nullptr) {
  std::vector<Vec3> out;
  for (const Body& body : model.bodies)
    out.push_back(body.fixed ? Vec3(Vec3::Zero())
                             : Vec3(sections_of(body).cwiseProduct(drag_of(model, body, drag, of_all_meshes))));
  return out;
}

Vec3 force_on(const Air& air, std::size_t body, const Quat& q, const Vec3& v) {
  const Vec3 u = v - air.wind;
  return q * Vec3(-0.5 * air.density * u.norm() * air.drag_area[body].cwiseProduct(q.conjugate() * u));
}

// What is left out.

constexpr double kShare = 0.01;  // [-] of a speed, above which it matters
constexpr double kPush = 0.1;    // [-] of a weight, above which who waits would not stand as he does

/// Bodies that keep together: a person, or one body.
struct Group {
  std::string name;
  std::vector<int> bodies;
  double mass = 0;
  bool usual = false;  // a person or vehicle
};

std::vector<Group> groups_of(const Model& model) {
  std::vector<Group> out;
  for (const Person& person : model.persons) out.push_back({person.name, person.bodies, 0, true});
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    if (!body.fixed && body.person < 0) out.push_back({body.name, {static_cast<int>(b)}, 0, body.vehicle >= 0});
  }
  for (Group& group : out)
    for (const int b : group.bodies) group.mass += model.bodies[b].mass;
  return out;
}

/// What drag would take from somebody.
struct Loss {
  double speed = 0;  // [m/s]
  double share = 0;  // [-] of the greatest speed it can have, or had
  std::string of;
};

/// What may give a scene energy that it does not have at the start; empty: nothing.
std::string source_of_energy(const Model& model) {
  for (const EffectKind* effect : effect_table())
    if (effect->gives && effect->gives(model)) return effect->name;
  for (const Vehicle& vehicle : model.vehicles) {
    const auto drives = [](const DriverPhase& phase) { return phase.drives; };
    const auto& knots = vehicle.drive_force.knots();
    if (std::any_of(knots.begin(), knots.end(), [](const Schedule::Knot& knot) { return knot.value != 0; }) ||
        std::any_of(vehicle.sequence.begin(), vehicle.sequence.end(), drives))
      return "the drive of " + vehicle.name;
  }
  return {};
}

/// The greatest loss before the run. Of bodies with masses m and areas A that share an energy E the drag is rho E max(A/m) at most.
Loss loss_before(const Model& model, const std::vector<Group>& groups) {
  const std::vector<Vec3> areas = drag_areas(model, kDrag);
  const double energy = greatest_energy(model), T = model.settings.duration;
  Loss worst;
  for (const Group& group : groups) {
    double area = 0;  // [m^2/kg]
    for (const int b : group.bodies) area = std::max(area, areas[b].maxCoeff() / model.bodies[b].mass);
    const double speed = std::sqrt(2 * energy / group.mass), taken = kDensity * energy * area / group.mass * T;
    if (speed > 0 && taken / speed > worst.share) worst = {taken, taken / speed, group.name};
  }
  return worst;
}

/// The greatest loss of those the air of a run, if it had any, does not act on.
Loss loss_along(const Model& model, const Recording& run, bool had_air) {
  const std::vector<Vec3> areas = drag_areas(model, kDrag);
  Loss worst;
  for (const Group& group : groups_of(model)) {
    if (had_air && group.usual) continue;
    double taken = 0, fastest = 0;
    for (std::size_t k = 1; k < run.snapshots.size(); ++k) {
      double force = 0;
      for (const int b : group.bodies) {
        const double v2 =
            std::max(run.snapshots[k].bodies[b].V_WB.v.squaredNorm(), run.snapshots[k - 1].bodies[b].V_WB.v.squaredNorm());
        force += 0.5 * kDensity * areas[b].maxCoeff() * v2;
        fastest = std::max(fastest, std::sqrt(v2));
      }
      taken += force / group.mass * (run.snapshots[k].time - run.snapshots[k - 1].time);
    }
    if (fastest > 0 && taken / fastest > worst.share) worst = {taken, taken / fastest, group.name};
  }
  return worst;
}

/// `whose` says what the greatest speed is.
std::string in_words(const Loss& loss, const std::string& whose) {
  const std::string speed = number(loss.speed / loss.share) + " m/s";
  if (loss.share >= 1) return "all of the speed of " + loss.of + ", " + whose + " " + speed;
  return number(loss.speed) + " m/s from " + loss.of + ", " + number(100 * loss.share) + " % of its speed, " + whose + " " + speed;
}

constexpr const char* kHow = "; [air] has it computed";
/// Drag coefficients are assumed, and the motion is that without drag: where a touch hangs on it, what follows is not bounded.
constexpr const char* kEstimate =
    "; an estimate with usual drag coefficients in still air, of drag by itself: a touch that comes otherwise can change more";

/// Of a scene that says nothing of the air.
Finding look_at_usual(const Model& model) {
  const std::vector<Group> groups = groups_of(model);
  const bool usual = std::any_of(groups.begin(), groups.end(), [](const Group& group) { return group.usual; });
  const bool free = std::any_of(groups.begin(), groups.end(), [](const Group& group) { return !group.usual; });
  const std::string air = "still air of " + number(kDensity) + " kg/m^3, the usual, around ", how = kHow;
  const std::string source = source_of_energy(model);
  const Loss loss = loss_before(model, groups);
  const bool matters = !source.empty() || loss.share > kShare;
  if (usual && matters) return {true, air + "vehicles and persons", free ? "drag of free bodies" + how : ""};
  if (!source.empty())
    return {false, "the scene has no [air], vehicle or person",
            "drag, not bounded before the run, for " + source + " gives energy" + how};
  if (loss.share == 0) return {false, "no speed for drag to take", ""};
  return {false, usual ? "worth less than a hundredth of a speed" : "the scene has no [air], vehicle or person",
          "drag takes at most " + in_words(loss, "which energy bounds at") + kEstimate + how};
}

/// The wind on persons that keep their pose until something touches them.
LeftOut push_on_waiting(const Model& model) {
  const double wind = input(model, "air.wind")->norm(), density = input(model, "air.density")->x();
  const std::vector<Vec3> areas = drag_areas(model, input(model, "air.drag")->x() * Vec3::Ones());
  LeftOut out;
  for (const Person& person : model.persons) {
    if (!person.zero_condition || wind * density == 0) continue;
    double area = 0, mass = 0;
    for (const int b : person.bodies) area += areas[b].maxCoeff(), mass += model.bodies[b].mass;
    const double push = 0.5 * density * area * wind * wind;
    out.text += (out.text.empty() ? "the push of the wind, up to " : ", ") + number(push) + " N on " + person.name;
    out.matters = out.matters || push > kPush * mass * model.settings.gravity.norm();
  }
  if (!out.text.empty()) out.text += ", until something touches who waits; zero_condition = false has it computed";
  return out;
}

Finding look_for_air_drag(const Model& model) {
  const Vec3* density = input(model, "air.density");
  if (!density) return look_at_usual(model);
  if (density->x() == 0) return {false, "air.density is 0", ""};
  const Vec3 wind = *input(model, "air.wind");
  return {true,
          "air of " + number(density->x()) + " kg/m^3" + (wind.isZero() ? ", still" : ", wind of " + number(wind.norm()) + " m/s"),
          push_on_waiting(model).text};
}

LeftOut left_out_along(const Model& model, const Recording& run, bool had_air) {
  if (input(model, "air.density")) return push_on_waiting(model);
  const Loss loss = loss_along(model, run, had_air);
  if (loss.share == 0) return {};
  return {"drag would take " + in_words(loss, "at the most") + " along this run" + kEstimate + kHow, loss.share > kShare};
}

Air air_of(const Model& model) {
  Air air;
  if (const Vec3* density = input(model, "air.density")) {
    const double drag = input(model, "air.drag")->x();
    air.density = density->x();
    air.wind = *input(model, "air.wind");
    air.drag_area = drag_areas(model, drag * Vec3::Ones(), input(model, "air.vehicle_drag"));
    return air;
  }
  if (!look_for_air_drag(model).called_for) return air;  // switched on by hand
  air.density = kDensity;
  air.drag_area = drag_areas(model, kDrag);
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    if (model.bodies[b].person < 0 && model.bodies[b].vehicle < 0) air.drag_area[b].setZero();
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
  static constexpr SceneSection kSection{
      "air",
      "The air, where its resistance or the wind counts. Without this section there is still air around "
      "vehicles and persons, and none around free bodies; `crashreel plan` tells what that leaves "
      "out.",
      kKeys};
  static Finding look(const Model& model) { return look_for_air_drag(model); }
  static bool gives(const Model& model) {
    const Vec3* wind = input(model, "air.wind");
    return wind && !wind->isZero(0);
  }
  /// The wind on who waits is left out, not needless.
  static double not_before(const Model& model, const Reach& reach) {
    return reach.all_bodies_wait && !gives(model) ? reach.first_touch : 0;
  }
  static LeftOut left_out(const Model& model, const Recording& run, bool had_air) { return left_out_along(model, run, had_air); }

  AirDrag(const World& world, int self) : Effect(self), air_(air_of(world.model)) {}

  void before_step(World& world, State& state, double) override { power_ = power_taken(world, state, air_); }

  void add_forces(const World& world, std::span<const int> trees, const std::vector<Pose>& X, const std::vector<Twist>& V,
                  std::vector<Vec6>& force) const override {
    if (air_.density == 0) return;
    for_bodies_of(world, trees, [&](int b) { force[b].head<3>() += force_on(air_, static_cast<std::size_t>(b), X[b].q, V[b].v); });
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
