// Two wheels of different vehicles that meet by rims and flanks: points of the one on the surface of the other.
#include "engine/contact/mesh_points.h"
#include "engine/contact/round_tyre.h"
#include "engine/geometry/point_mesh.h"
#include "engine/geometry/point_tyre.h"
#include "engine/world.h"

namespace engine {
namespace {

/// Points of one wheel on a tyre, appended.
void touch_tyre(const Outlook& outlook, const WheelState& wheel, const Tyre& tyre, double margin, std::uint32_t key,
                std::vector<SurfaceContact>& out) {
  const Vehicle& vehicle = outlook.world.model.vehicles[wheel.vehicle];
  const Wheel& spec = vehicle.wheels[wheel.wheel];
  const Pose& X = outlook.at.X_WB[vehicle.body];
  const Vec3 lift = wheel.lift * (X.q * Vec3::UnitZ());
  const double within = tyre.radius + spec.radius + margin;
  if ((X * spec.hub_B + lift - tyre.centre).squaredNorm() > within * within) return;
  for (int i = 0; i < kRimPoints; ++i) {
    SurfaceContact c = point_on_tyre(X * rim_point(spec, i) + lift, tyre);
    if (c.gap >= margin) continue;
    c.gap = given(c.gap);
    c.key = key | static_cast<std::uint32_t>(i);
    out.push_back(c);
  }
}

}  // namespace

template <>
Touches touches_between<ShapeKind::tyre, ShapeKind::tyre>(const Outlook& outlook, const ContactPair& pair) {
  constexpr std::uint32_t kTyreOnTyre = 0x800000u;
  const Model& model = outlook.world.model;
  const std::vector<WheelState>& wheels = outlook.state.wheels;
  std::vector<SurfaceContact>& out = outlook.world.pairs.point_contacts;
  out.clear();
  const double margin = pair_margin(outlook, pair.a, pair.b);
  for (std::size_t k = 0; k < wheels.size(); ++k) {
    if (wheels[k].vehicle != model.bodies[pair.b].vehicle) continue;
    const Tyre tyre = tyre_of(outlook, static_cast<int>(k), wheels[k].lift);
    for (const WheelState& wheel : wheels)
      if (wheel.vehicle == model.bodies[pair.a].vehicle)
        touch_tyre(outlook, wheel, tyre, margin, kTyreOnTyre | static_cast<std::uint32_t>(16 * wheels[k].wheel + wheel.wheel) << 8,
                   out);
  }
  keep_spread(out, static_cast<std::size_t>(model.settings.contacts_per_pair));
  return out;
}

}  // namespace engine
