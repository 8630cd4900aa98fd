#include "engine/effects/riding.h"
#include "engine/math/functions.h"

#include <algorithm>
#include <cmath>

namespace engine {
namespace {

/// Of the pair.
double kinetic_energy_of(const World& world, const State& state, const std::vector<int>& bodies) {
  double energy = 0;
  for (const int b : bodies) {
    const Body& body = world.model.bodies[b];
    const Vec3 w_B = state.X_WB[b].q.conjugate() * state.V_WB[b].w;
    energy += 0.5 * body.mass * state.V_WB[b].v.squaredNorm() + 0.5 * w_B.dot(body.inertia_B * w_B);
  }
  return energy;
}

struct Demand {
  double brake = 0, drive = 0;  // [N] of all wheels, as far as they grip
  double steer = 0;             // [rad]
  double grip = 0;              // [m/s^2] most the tyres can turn the pair's way by
};

Demand demand_of(const World& world, State& state, int vehicle, double mass, double speed) {
  const double g = world.model.settings.gravity.norm();
  const double own = world.model.bodies[world.model.vehicles[vehicle].body].mass;
  double carried = 0;
  for (const WheelState& wheel : state.wheels) carried += wheel.vehicle == vehicle ? wheel.static_load : 0;
  Demand demand;
  for (WheelState& wheel : state.wheels) {
    if (wheel.vehicle != vehicle || carried <= 0) continue;
    const Wheel& spec = world.model.vehicles[vehicle].wheels[wheel.wheel];
    const double mu = std::min(spec.friction, world.model.ground.friction_at(wheel.contact, state.time));
    const double most = mu * mass * g * wheel.static_load / carried;  // the rider's weight on the wheels as the mount's
    // pedals are told by the deceleration of the mount's mass: rider and mount get it together
    const double brake = wheel.brake * mass / own, drive = wheel.drive * mass / own;
    demand.brake += std::min(brake, most);
    demand.drive += std::clamp(drive, -most, most);
    demand.grip += most / mass;
    if (spec.steered) demand.steer = wheel.steer;
    wheel.locked = brake > most && speed > 0;
    wheel.slip = wheel.locked ? speed : 0;
  }
  return demand;
}

/// Between the axles of steered and other wheels [m]; 0 where there are not both.
double wheelbase_of(const Vehicle& vehicle) {
  double front = 0, rear = 0;
  int fronts = 0, rears = 0;
  for (const Wheel& wheel : vehicle.wheels) {
    (wheel.steered ? front : rear) += wheel.hub_B.x();
    ++(wheel.steered ? fronts : rears);
  }
  return fronts > 0 && rears > 0 ? front / fronts - rear / rears : 0;
}

}  // namespace

void ride(StepContext& step, int p, int self) {
  const World& world = step.world;
  State& state = step.state;
  const Person& person = world.model.persons[p];
  const int mount = person.mount, v = world.model.bodies[mount].vehicle;
  thread_local std::vector<int> pair;  // room is kept from step to step
  pair.assign(person.bodies.begin(), person.bodies.end());
  pair.push_back(mount);
  double mass = 0;
  for (const int b : pair) mass += world.model.bodies[b].mass;
  const double h = step.length, before = kinetic_energy_of(world, state, pair);
  Vec3 forward = state.X_WB[mount].q * Vec3::UnitX();
  forward.z() = 0;
  forward.normalize();
  const double speed = state.V_WB[mount].v.dot(forward);
  const Demand demand = demand_of(world, state, v, mass, std::abs(speed));
  const bool acts = demand.brake > 0 || demand.drive != 0 || demand.steer != 0 || state.V_WB[mount].w.z() != 0;
  if (!acts) {
    for (const int b : pair) state.X_WB[b].p += h * state.V_WB[b].v;
    return;
  }
  double next = speed + h * demand.drive / mass;
  next -= std::copysign(std::min(std::abs(next), h * demand.brake / mass), next);
  const double mean = 0.5 * (speed + next), base = wheelbase_of(world.model.vehicles[v]);
  double turn = base > 0 ? mean * math::tan(demand.steer) / base : 0;  // [rad/s]
  const double most = std::abs(mean) > 1e-6 ? demand.grip / std::abs(mean) : 0;
  turn = std::clamp(turn, -most, most);
  // the rear axle follows the front: the pair turns about the vertical through the middle of the unsteered wheels
  double rear = 0;
  int rears = 0;
  for (const Wheel& wheel : world.model.vehicles[v].wheels)
    if (!wheel.steered) rear += wheel.hub_B.x(), ++rears;
  const Vec3 pivot = state.X_WB[mount].p + (rears > 0 ? rear / rears : 0) * forward;
  const Quat turned = math::rotation(h * turn, Vec3::UnitZ()), halfway = math::rotation(0.5 * h * turn, Vec3::UnitZ());
  const Vec3 climbs = state.V_WB[mount].v.z() * Vec3::UnitZ(), w = turn * Vec3::UnitZ();
  const Vec3 way = h * mean * (halfway * forward) + h * climbs, velocity = next * (turned * forward) + climbs;
  for (const int b : pair) {
    const Vec3 arm = turned * (state.X_WB[b].p - pivot);
    state.X_WB[b].p = pivot + way + arm;
    state.X_WB[b].q = (turned * state.X_WB[b].q).normalized();
    state.V_WB[b] = {velocity + w.cross(arm), w};
  }
  const double change = kinetic_energy_of(world, state, pair) - before;
  (change < 0 ? state.energy.dissipated[self] : state.energy.added) += std::abs(change);
}

}  // namespace engine
