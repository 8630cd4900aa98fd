#include "engine/effects/riding.h"
#include "engine/math/functions.h"
#include "engine/math/roots.h"

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

/// How the pair stands on its wheels, along its way.
struct Stance {
  Vec3 centre = Vec3::Zero();   // [m] of mass
  double mass = 0, weight = 0;  // [kg], [N] on the wheels
  double height = 0;            // [m] of the centre over the road
  double front = 0, rear = 0;   // [m] ahead of the centre: where the wheels before and behind it stand
};

bool is_before(const Vec3& centre, const Vec3& hub, const Vec3& forward) {
  return forward.dot(hub - centre) > 0;
}

Stance stance_of(const World& world, const State& state, const std::vector<int>& pair, int vehicle, const Vec3& forward) {
  Stance out;
  for (const int b : pair) {
    out.mass += world.model.bodies[b].mass;
    out.centre += world.model.bodies[b].mass * state.X_WB[b].p;
  }
  out.centre /= out.mass;
  out.weight = -out.mass * world.model.settings.gravity.z();
  int fronts = 0, rears = 0;
  for (const WheelState& wheel : state.wheels) {
    if (wheel.vehicle != vehicle) continue;
    const bool before = is_before(out.centre, wheel.hub, forward);
    (before ? out.front : out.rear) += forward.dot(wheel.hub - out.centre);
    ++(before ? fronts : rears);
    out.height += out.centre.z() - wheel.contact.z();
  }
  if (fronts > 0) out.front /= fronts;
  if (rears > 0) out.rear /= rears;
  if (fronts + rears > 0) out.height /= fronts + rears;
  return out;
}

struct Demand {
  double brake = 0, drive = 0;  // [N] of all wheels, as far as they grip
  double steer = 0;             // [rad]
  double grip = 0;              // [m/s^2] most the tyres can turn the pair's way by
};

/// What the wheels take of what the driver asks, where the load on the front axle is a share of the weight.
Demand demand_at(const World& world, State& state, const Stance& stance, int vehicle, const Vec3& forward, double share, double h,
                 double speed) {
  const double own = world.model.bodies[world.model.vehicles[vehicle].body].mass;
  double carried[2] = {0, 0};  // [N] by the mount alone at rest: how wheels side by side share their axle's load
  for (const WheelState& wheel : state.wheels)
    if (wheel.vehicle == vehicle) carried[is_before(stance.centre, wheel.hub, forward)] += wheel.static_load;
  Demand demand;
  for (WheelState& wheel : state.wheels) {
    if (wheel.vehicle != vehicle) continue;
    const Wheel& spec = world.model.vehicles[vehicle].wheels[wheel.wheel];
    const bool before = is_before(stance.centre, wheel.hub, forward);
    const double part = carried[before] > 0 ? wheel.static_load / carried[before] : 0;
    const double load = part * stance.weight * (before ? share : 1 - share);
    const double most = std::min(spec.friction, world.model.ground.friction_at(wheel.contact, state.time)) * load;
    // pedals are told by the deceleration of the mount's mass: rider and mount get it together
    const double asked = wheel.brake * stance.mass / own;
    const double brake = std::min(asked, most), drive = std::clamp(wheel.drive * stance.mass / own, -most, most);
    demand.brake += brake;
    demand.drive += drive;
    demand.grip += most / stance.mass;
    if (spec.steered) demand.steer = wheel.steer;
    wheel.locked = asked > most && speed != 0;
    wheel.slip = wheel.locked ? std::abs(speed) : 0;
    wheel.impulse = {h * load, h * (drive - std::copysign(speed == 0 ? 0 : brake, speed)), 0};
  }
  return demand;
}

/// The load goes to the front as the pair slows. Where a wheel would leave the road the driver holds back at that.
Demand demand_of(const World& world, State& state, const Stance& stance, int vehicle, const Vec3& forward, double h, double speed) {
  constexpr double kLeastShare = 1e-9;  // [-]
  const double base = stance.front - stance.rear, at_rest = base > 0 ? -stance.rear / base : 0.5;
  const auto demand = [&](double share) { return demand_at(world, state, stance, vehicle, forward, share, h, speed); };
  const auto follows = [&](double share) {  // from what the wheels take with this one
    const Demand of = demand(share);
    return at_rest + (std::copysign(of.brake, speed) - of.drive) * stance.height / (base * stance.weight);
  };
  const Demand evenly = demand(at_rest);
  if (base <= 0 || stance.weight <= 0 || (evenly.brake == 0 && evenly.drive == 0)) return evenly;
  const bool pitches = follows(1) > 1;
  if (!pitches && follows(0) >= 0)
    return demand(math::bisect({0, 1}, math::kToTheWidth, kLeastShare, [&](double share) { return follows(share) > share; }).low);
  Demand held = demand(pitches ? 1 : 0);
  const double most = stance.weight * (pitches ? stance.front : -stance.rear) / stance.height;
  held.brake = std::min(held.brake, most);
  held.drive = std::clamp(held.drive, -most, most);
  return held;
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

void book(State& state, int self, double given) {
  (given < 0 ? state.energy.dissipated[self] : state.energy.added) += std::abs(given);
}

void ride(StepContext& step, int p, int self) {
  const World& world = step.world;
  State& state = step.state;
  const Person& person = world.model.persons[p];
  const int mount = person.mount, v = world.model.bodies[mount].vehicle;
  thread_local std::vector<int> pair;  // room is kept from step to step
  pair.assign(person.bodies.begin(), person.bodies.end());
  pair.push_back(mount);
  const Vec3 gravity = world.model.settings.gravity;
  const double h = step.length, before = kinetic_energy_of(world, state, pair);
  Vec3 forward = state.X_WB[mount].q * Vec3::UnitX();
  forward.z() = 0;
  forward.normalize();
  const double speed = state.V_WB[mount].v.dot(forward);
  const Stance stance = stance_of(world, state, pair, v, forward);
  const Demand demand = demand_of(world, state, stance, v, forward, h, speed);
  const bool acts = demand.brake > 0 || demand.drive != 0 || demand.steer != 0 || state.V_WB[mount].w.z() != 0;
  if (!acts) {  // keeps its speed, on a slope too
    for (const int b : pair) state.X_WB[b].p += h * state.V_WB[b].v;
    book(state, self, -h * stance.mass * gravity.dot(state.V_WB[mount].v));
    return;
  }
  const double rise = speed != 0 ? state.V_WB[mount].v.z() / speed : 0, level = 1 / math::hypot(1, rise);
  const double pulled = level * (gravity.dot(forward) + gravity.z() * rise);  // [m/s^2] along the way
  double next = speed + h * level * (demand.drive / stance.mass + pulled);
  next -= std::copysign(std::min(std::abs(next), h * level * demand.brake / stance.mass), next);
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
  double fell = 0;  // [J] what gravity did
  for (const int b : pair) {
    const Vec3 arm = turned * (state.X_WB[b].p - pivot), place = pivot + way + arm;
    fell += world.model.bodies[b].mass * gravity.dot(place - state.X_WB[b].p);
    state.X_WB[b].p = place;
    state.X_WB[b].q = (turned * state.X_WB[b].q).normalized();
    state.V_WB[b] = {velocity + w.cross(arm), w};
  }
  book(state, self, kinetic_energy_of(world, state, pair) - before - fell);
}

}  // namespace engine
