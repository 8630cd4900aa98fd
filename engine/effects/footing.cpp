#include "engine/effects/footing.h"

#include <algorithm>

#include "engine/contact/road.h"
#include "engine/contact/round_tyre.h"
#include "engine/world.h"

namespace engine {
namespace {

constexpr double kSteepest = 0.5 * kWheelFacing;  // [-] no step turns a wheel that stands to what is steeper

/// A plane through `on`, met by a tyre round across as it is along (a torus): leaning, it rolls on its shoulder and ends on its
/// flank.
Footing on_plane(const Wheel& spec, const Pose& X, const Vec3& on, const Vec3& normal) {
  const Vec3 up = X.q * Vec3::UnitZ(), axle = X.q * Vec3::UnitY();
  const Vec3 across = normal - axle.dot(normal) * axle;
  const double lean = across.norm(), crown = crown_radius(spec);
  const double height = (spec.radius - crown) * lean + crown;  // [m] of the hub over what it touches
  const double facing = up.dot(normal);
  const Vec3 hub = X * spec.hub_B;
  Footing footing;
  footing.normal = normal;
  footing.near = facing <= kWheelFacing;
  if (facing < kSteepest) return footing;
  footing.compression = (height - normal.dot(hub - on)) / facing;
  footing.point = hub + footing.compression * up - crown * normal;
  if (lean > 0) footing.point -= (spec.radius - crown) / lean * across;
  return footing;
}

}  // namespace

Footing footing_of(const Outlook& outlook, int wheel, double droop) {
  const WheelState& state = outlook.state.wheels[static_cast<std::size_t>(wheel)];
  const Vehicle& vehicle = outlook.world.model.vehicles[state.vehicle];
  const Wheel& spec = vehicle.wheels[state.wheel];
  const Ground& ground = outlook.world.model.ground;
  const Pose& X = outlook.at.X_WB[vehicle.body];
  const Vec3 hub = X * spec.hub_B, up = X.q * Vec3::UnitZ();
  Footing best;
  best.compression = best.leaving = -droop;
  auto stand = [&](const Footing& f, int body) {
    if (f.near || f.compression <= best.compression) return;
    best.found = true;
    best.body = body;
    best.compression = f.compression;
    best.point = f.point;
    best.normal = f.normal;
  };
  auto look_at = [&](const Vec3& on, const Vec3& normal) {
    const Footing f = on_plane(spec, X, on, normal);
    best.near = best.near || (f.near && normal.dot(hub - on) < spec.radius + droop);
    if (f.near) best.leaving = std::max(best.leaving, f.compression);
    stand(f, -1);
  };
  if (ground.plane) look_at(Vec3(hub.x(), hub.y(), ground.height), Vec3::UnitZ());
  if (ground.terrain) {
    constexpr double kAbove = 0.6;  // [m] start over the hub, so that a wheel pushed into a kerb still finds the surface
    double s = 0;
    int triangle = -1;
    const double farthest = kAbove + spec.radius / kWheelFacing + droop;  // a leaning wheel's shoulder is nearer than what is below
    if (ground.terrain->raycast(hub + kAbove * up, -up, farthest, s, triangle))
      look_at(hub + (kAbove - s) * up, ground.terrain->face_normals()[triangle]);
  }
  for (const Road& road : outlook.world.pairs.roads) {
    constexpr double kHigher = 1e-5;  // [m] below it the surface under the hub serves, on which a leaning tyre has its shoulder
    if (const auto touch = stands_on(outlook, wheel, road, best.compression + kHigher))
      stand(on_plane(spec, X, touch->point, touch->normal), road.body);
  }
  return best;
}

void step_on_bodies(const Outlook& outlook, std::span<const std::size_t> pairs, Footing& best) {
  if (pairs.empty()) return;
  const Vec3 hub = hub_of(outlook, outlook.world.pairs.tyres[pairs.front()]);
  for (const std::size_t p : pairs) {
    const TyrePair& pair = outlook.world.pairs.tyres[p];
    if (!near(outlook, pair, hub, 0)) continue;
    const auto touch = stands_on(outlook, pair, best.compression);
    if (!touch) continue;
    best.found = true;
    best.body = pair.body;
    best.compression = touch->way;
    best.point = touch->point;
    best.normal = touch->normal;
  }
}

}  // namespace engine
