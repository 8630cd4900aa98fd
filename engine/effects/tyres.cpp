// Wheels: a suspension spring and damper under each hub, and a tyre that holds what the friction circle allows. Both are rows of
// the one impulse solve, the spring soft (implicit), so a braked car stands on a slope without creeping.
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "engine/effects/effects.h"

namespace engine {
namespace {

constexpr double kStopStiffness = 10;  // [-] times the spring's, beyond the travel

std::optional<std::string> called_for(const Model& model) {
  std::size_t count = 0;
  for (const Vehicle& vehicle : model.vehicles) count += vehicle.wheels.size();
  if (count == 0 || (!model.ground.plane && !model.ground.terrain)) return std::nullopt;
  return std::to_string(count) + " wheels stand on the ground";
}

/// Loads that carry the weight about the centre of mass with the least sum of squares.
Eigen::VectorXd static_loads(const Model& model, const Vehicle& vehicle) {
  const auto n = static_cast<Eigen::Index>(vehicle.wheels.size());
  Eigen::MatrixXd A(3, n);
  for (Eigen::Index i = 0; i < n; ++i) A.col(i) << 1, vehicle.wheels[i].hub_B.x(), vehicle.wheels[i].hub_B.y();
  const double weight = model.bodies[vehicle.body].mass * model.settings.gravity.norm();
  const Mat3 AA = A * A.transpose() + 1e-9 * Mat3::Identity();  // a two-wheeler has no track: keep it solvable
  const Vec3 multipliers = AA.ldlt().solve(Vec3(weight, 0, 0));
  return A.transpose() * multipliers;
}

void begin(World& world, const State&, int) {
  for (int v = 0; v < static_cast<int>(world.model.vehicles.size()); ++v) {
    const Vehicle& vehicle = world.model.vehicles[v];
    if (vehicle.wheels.empty()) continue;
    const Eigen::VectorXd loads = static_loads(world.model, vehicle);
    for (int w = 0; w < static_cast<int>(vehicle.wheels.size()); ++w) {
      WheelState wheel;
      wheel.vehicle = v;
      wheel.wheel = w;
      wheel.static_load = loads[w];
      world.wheels.push_back(wheel);
    }
  }
}

struct Footing {
  bool found = false;
  double distance = 0;  // [m] from the hub along the vehicle's down axis
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();
};

Footing footing_of(const Ground& ground, const Vec3& hub, const Vec3& down, double far) {
  Footing footing;
  double best = far;
  if (ground.plane && down.z() < -0.2) {
    const double s = (ground.height - hub.z()) / down.z();
    if (s < best) {
      best = s;
      footing = {true, s, hub + s * down, Vec3::UnitZ()};
    }
  }
  if (ground.terrain) {
    constexpr double kAbove = 0.6;  // [m] start over the hub, so that a wheel pushed into a kerb still finds the surface
    double s = 0;
    int triangle = -1;
    if (ground.terrain->raycast(hub - kAbove * down, down, best + kAbove, s, triangle) && s - kAbove < best)
      footing = {true, s - kAbove, hub + (s - kAbove) * down, ground.terrain->face_normals()[triangle]};
  }
  return footing;
}

/// Spring force [N] at a compression, stop included.
double spring_force(const Wheel& spec, double static_load, double compression) {
  const double beyond = std::max(0.0, std::abs(compression) - spec.travel);
  return static_load + spec.spring * (compression + std::copysign(kStopStiffness * beyond, compression));
}

double spring_energy(const Wheel& spec, double static_load, double compression) {
  const double beyond = std::max(0.0, std::abs(compression) - spec.travel);
  return static_load * compression + 0.5 * spec.spring * (compression * compression + kStopStiffness * beyond * beyond);
}

void add_wheel(World& world, const State& state, WheelState& wheel, const Footing& footing, int index, int self) {
  const Vehicle& vehicle = world.model.vehicles[wheel.vehicle];
  const Wheel& spec = vehicle.wheels[wheel.wheel];
  const Pose& X = state.X_WB[vehicle.body];
  const double h = world.step;
  const double stiffness = spec.spring * (std::abs(wheel.compression) > spec.travel ? 1 + kStopStiffness : 1);
  const double force = spring_force(spec, wheel.static_load, wheel.compression);

  Constraint c;
  c.kind = ConstraintKind::wheel;
  c.body_a = vehicle.body;
  c.record_a = vehicle.body;
  c.point = footing.point;
  const Vec3 forward = X.q * Vec3(std::cos(wheel.steer), std::sin(wheel.steer), 0);
  const Vec3 t1 = (forward - forward.dot(footing.normal) * footing.normal).normalized();
  c.frame << footing.normal, t1, footing.normal.cross(t1);
  const Vec3 r = c.point - X.p;
  for (int k = 0; k < 3; ++k) c.J_a.row(k) << c.frame.col(k).transpose(), r.cross(c.frame.col(k)).transpose();
  const double implicit = stiffness * h + spec.damper;
  c.softness = 1 / (h * implicit);
  c.target = force / implicit;
  c.friction = std::min(spec.friction, world.model.ground.surface.friction_ground.at(state.time));
  c.rolling_bound = h * wheel.brake;
  c.gap = -wheel.compression;
  c.key = (static_cast<std::uint64_t>(self) << 56) | static_cast<std::uint64_t>(index);
  c.effect = self;
  c.wheel = index;
  world.constraints.push_back(c);
}

void find(World& world, const State& state, int self) {
  double energy = 0;
  for (int i = 0; i < static_cast<int>(world.wheels.size()); ++i) {
    WheelState& wheel = world.wheels[i];
    const Vehicle& vehicle = world.model.vehicles[wheel.vehicle];
    const Wheel& spec = vehicle.wheels[wheel.wheel];
    const Pose& X = state.X_WB[vehicle.body];
    wheel.steer = spec.steered ? vehicle.steer.at(state.time) : 0;
    wheel.brake = std::clamp(vehicle.brake.at(state.time), 0.0, 1.0) * vehicle.brake_force * spec.brake_share;
    const Vec3 hub_static = X * spec.hub_B;
    const Vec3 down = -(X.q * Vec3::UnitZ());
    const double droop = spec.travel + wheel.static_load / spec.spring;
    const Footing footing = footing_of(world.model.ground, hub_static, down, spec.radius + droop);
    wheel.compression = footing.found ? spec.radius - footing.distance : -droop;
    wheel.hub = hub_static - down * std::clamp(wheel.compression, -droop, 2 * spec.travel);
    wheel.contact = footing.found ? footing.point : Vec3(wheel.hub + down * spec.radius);
    wheel.impulse.setZero();
    energy +=
        footing.found ? spring_energy(spec, wheel.static_load, wheel.compression) : spring_energy(spec, wheel.static_load, -droop);
    if (footing.found) add_wheel(world, state, wheel, footing, i, self);
  }
  // what the springs took or gave since the last look is not lost: it leaves the dampers' account
  world.dissipated[self] -= energy - world.spring_energy;
  world.spring_energy = energy;
}

/// Drive force, shared by the driven wheels that stand, within their friction.
void add_forces(const World& world, const std::vector<Pose>& X, const std::vector<Twist>&, std::vector<Vec6>& force) {
  for (const WheelState& wheel : world.wheels) {
    const Vehicle& vehicle = world.model.vehicles[wheel.vehicle];
    const Wheel& spec = vehicle.wheels[wheel.wheel];
    if (!spec.driven || wheel.drive == 0) continue;
    const Vec3 push = wheel.drive * (X[vehicle.body].q * Vec3(std::cos(wheel.steer), std::sin(wheel.steer), 0));
    force[vehicle.body].head<3>() += push;
    force[vehicle.body].tail<3>() += (wheel.contact - X[vehicle.body].p).cross(push);
  }
}

void before_step(World& world, State& state, int) {
  for (WheelState& wheel : world.wheels) {
    const Vehicle& vehicle = world.model.vehicles[wheel.vehicle];
    const Wheel& spec = vehicle.wheels[wheel.wheel];
    wheel.drive = 0;
    if (!spec.driven) continue;
    const auto driven = std::count_if(vehicle.wheels.begin(), vehicle.wheels.end(), [](const Wheel& w) { return w.driven; });
    const double most = spec.friction * std::max(0.0, spring_force(spec, wheel.static_load, wheel.compression));
    wheel.drive = std::clamp(vehicle.drive_force.at(state.time) / static_cast<double>(driven), -most, most);
  }
}

void after_step(World& world, State& state, int) {
  for (const Constraint& c : world.constraints) {
    if (c.kind != ConstraintKind::wheel) continue;
    WheelState& wheel = world.wheels[c.wheel];
    const Wheel& spec = world.model.vehicles[wheel.vehicle].wheels[wheel.wheel];
    wheel.impulse = c.impulse;
    const double grip = c.friction * c.impulse[0];
    const bool sliding = std::hypot(c.impulse[1], c.impulse[2]) >= 0.999 * grip && grip > 0;
    wheel.locked = sliding && wheel.brake > 0 && std::abs(c.impulse[1]) < 0.999 * c.rolling_bound;
    wheel.slip = sliding ? std::hypot(wheel.locked ? c.u_after[1] : 0.0, c.u_after[2]) : 0;
    if (!wheel.locked) state.wheel_spin[c.wheel] += world.step * c.u_after[1] / spec.radius;
    if (wheel.drive != 0) world.added += world.step * wheel.drive * 0.5 * (c.u_before[1] + c.u_after[1]);
  }
}

}  // namespace

const Effect kTyresEffect{.name = "tyres",
                          .called_for = called_for,
                          .begin = begin,
                          .before_step = before_step,
                          .find = find,
                          .add_forces = add_forces,
                          .after_step = after_step};

}  // namespace engine
