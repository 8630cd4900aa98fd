#include "engine/contact/round_tyre.h"

#include <algorithm>

#include "engine/math/functions.h"
#include "engine/world.h"

namespace engine {
namespace {

const Wheel& wheel_of(const World& world, const TyrePair& pair) {
  return world.model.vehicles[pair.vehicle].wheels[pair.wheel_of_vehicle];
}

}  // namespace

Tyre tyre_of(const Outlook& outlook, int wheel, double lift) {
  const WheelState& state = outlook.state.wheels[wheel];
  const Vehicle& vehicle = outlook.world.model.vehicles[state.vehicle];
  const Wheel& spec = vehicle.wheels[state.wheel];
  const Pose& X = outlook.at.X_WB[vehicle.body];
  const Vec3 axle = X.q * Vec3::UnitY();  // a steered wheel turns about its strut: its axle stays across it
  const Vec3 forward = X.q * Vec3::UnitX();
  return {X * spec.hub_B + lift * (X.q * Vec3::UnitZ()), math::cos(state.steer) * axle - math::sin(state.steer) * forward,
          spec.radius, crown_radius(spec)};
}

std::vector<TyrePair> tyre_pairs(const Model& model) {
  std::vector<TyrePair> out;
  int wheel = 0;
  for (int v = 0; v < static_cast<int>(model.vehicles.size()); ++v) {
    const int body = model.vehicles[v].body;
    for (int w = 0; w < static_cast<int>(model.vehicles[v].wheels.size()); ++w, ++wheel)
      for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
        const Body& round = model.bodies[b];
        const bool rides = round.person >= 0 && round.person == model.bodies[body].person;
        if (std::holds_alternative<HyperEllipsoid>(round.shape) && !rides) out.push_back({wheel, v, w, body, b});
      }
  }
  return out;
}

Vec3 hub_of(const Outlook& outlook, const TyrePair& pair) {
  return outlook.at.X_WB[pair.vehicle_body] * wheel_of(outlook.world, pair).hub_B;
}

bool near(const Outlook& outlook, const TyrePair& pair, const Vec3& hub, double margin) {
  const Wheel& wheel = wheel_of(outlook.world, pair);
  const double within = wheel.radius + 2 * wheel.travel + outlook.world.reach[pair.body] + margin;
  return (hub - outlook.at.X_WB[pair.body].p).squaredNorm() < within * within;
}

namespace {

/// Does the front or the back of a tyre lie in a body, and would still when lifted by `way` [m]? Deep in a wall that is told at
/// once, and how far it would have to rise takes long to find.
bool stays_within(const Tyre& tyre, const HyperEllipsoid& shape, const Pose& X_WA, const Vec3& up, double way) {
  const auto within = [&](const Vec3& p) { return gauge(shape, X_WA.q.conjugate() * (p - X_WA.p)) < 1; };
  const Vec3 arm = tyre.radius * tyre.axle.cross(up);
  const auto stays = [&](const Vec3& p) { return within(p) && within(p + way * up); };
  return stays(tyre.centre + arm) || stays(tyre.centre - arm);
}

}  // namespace

std::optional<TyreTouch> stands_on(const Outlook& outlook, const TyrePair& pair, double least) {
  const auto& shape = std::get<HyperEllipsoid>(outlook.world.model.bodies[pair.body].shape);
  const Pose& X_WA = outlook.at.X_WB[pair.body];
  const Vec3 up = outlook.at.X_WB[pair.vehicle_body].q * Vec3::UnitZ();
  const Tyre tyre = tyre_of(outlook, pair.wheel, 0);
  const double most = 2 * wheel_of(outlook.world, pair).travel;
  if (stays_within(tyre, shape, X_WA, up, most)) return std::nullopt;
  const auto touch = move_clear(tyre, shape, X_WA, up, kWheelFacing, least);
  if (!touch || touch->way > most) return std::nullopt;
  // one that rolls up has not got farther than the last step took it: what is deeper has come from the side
  const double rise = pair_margin(outlook, pair.body, pair.vehicle_body) / touch->normal.dot(up);
  if (touch->way > outlook.state.wheels[pair.wheel].lift + rise) return std::nullopt;
  return touch;
}

RollingRim rim_at(const Outlook& outlook, const TyrePair& pair, const Vec3& p) {
  const Pose& X = outlook.at.X_WB[pair.vehicle_body];
  const WheelState& state = outlook.state.wheels[pair.wheel];
  const Wheel& spec = wheel_of(outlook.world, pair);
  const Tyre tyre = tyre_of(outlook, pair.wheel, state.lift);
  const Vec3 forward = tyre.axle.cross(X.q * Vec3::UnitZ());
  RollingRim out;
  out.roll << forward.transpose(), (tyre.centre - X.p).cross(forward).transpose();
  out.way = tyre.axle.cross(p - tyre.centre) / tyre.radius;
  if (state.static_load + spec.spring * state.compression > 0)
    out.grip = std::min(spec.friction, outlook.world.model.ground.friction_at(state.contact, outlook.at.time));
  return out;
}

bool yields_as_rubber(const Model& model, int body) {
  const Body& round = model.bodies[body];
  return round.person >= 0 && !round.fixed && !yields(model.settings.contact_law, true);
}

template <>
Touches touches_between<ShapeKind::round, ShapeKind::tyre>(const Outlook& outlook, const ContactPair& at) {
  constexpr double kDeepest = 0.15;  // [m] what lies farther inside has come from behind
  constexpr std::uint32_t kTyres = 0x800000u;
  World& world = outlook.world;
  const TyrePair& pair = world.pairs.tyres[at.at];
  const double margin = pair_margin(outlook, pair.body, pair.vehicle_body);
  if (!near(outlook, pair, hub_of(outlook, pair), margin)) return {};
  const auto& shape = std::get<HyperEllipsoid>(world.model.bodies[pair.body].shape);
  auto contact = contact_with_tyre(shape, outlook.at.X_WB[pair.body],
                                   tyre_of(outlook, pair.wheel, outlook.state.wheels[pair.wheel].lift), margin);
  if (!contact || contact->gap < -kDeepest) return {};
  // pinched, as beside a wheel that rolls over
  contact->gap = yields_as_rubber(world.model, pair.body) ? contact->gap + kTyreGives : given(contact->gap);
  contact->key = kTyres | static_cast<std::uint32_t>(pair.wheel);
  world.pairs.touches.clear();
  world.pairs.touches.push_back(*contact);
  return {world.pairs.touches.begin(), world.pairs.touches.end()};
}

}  // namespace engine
