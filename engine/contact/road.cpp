#include "engine/contact/road.h"

#include <algorithm>

#include "engine/contact/round_tyre.h"
#include "engine/geometry/mesh_overlap.h"
#include "engine/geometry/tyre_mesh.h"
#include "engine/world.h"

namespace engine {

std::vector<Road> roads_of(const Model& model) {
  std::vector<Road> out;
  if (model.ground.terrain) out.push_back({model.ground.terrain.get(), {}, model.ground.terrain->bounds(), kTerrain});
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    const Body& body = model.bodies[b];
    if (!body.fixed || !is_mesh(body) || body.vehicle >= 0) continue;
    const auto& shape = std::get<MeshShape>(body.shape);
    const Pose X_WM = body.X_WB * shape.X_BM;
    out.push_back({shape.mesh.get(), X_WM, world_bounds(*shape.mesh, X_WM), b});
  }
  return out;
}

const Road* road_of(const ContactPairs& pairs, int body) {
  const auto at = std::find_if(pairs.roads.begin(), pairs.roads.end(), [&](const Road& road) { return road.body == body; });
  return at == pairs.roads.end() ? nullptr : &*at;
}

std::optional<TyreTouch> stands_on(const Outlook& outlook, int wheel, const Road& road, double least) {
  const WheelState& state = outlook.state.wheels[static_cast<std::size_t>(wheel)];
  const Vehicle& vehicle = outlook.world.model.vehicles[state.vehicle];
  const Wheel& spec = vehicle.wheels[state.wheel];
  const Tyre tyre = tyre_of(outlook, wheel, 0);
  const Vec3 room = Vec3::Constant(spec.radius + 2 * spec.travel);
  if (((tyre.centre - room).array() > road.box.upper.array()).any() ||
      ((tyre.centre + room).array() < road.box.lower.array()).any())
    return std::nullopt;
  const double rise = contact_margin(outlook, vehicle.body) / kWheelFacing;
  const double most = std::min(2 * spec.travel, state.lift + rise);
  return move_clear(tyre, *road.mesh, road.X_WM, outlook.at.X_WB[vehicle.body].q * Vec3::UnitZ(), kWheelFacing, {least, most},
                    outlook.world.pairs.point_scratch);
}

bool mounts(const Outlook& outlook, int wheel, const Road& road) {
  const WheelState& state = outlook.state.wheels[static_cast<std::size_t>(wheel)];
  const Wheel& spec = outlook.world.model.vehicles[state.vehicle].wheels[state.wheel];
  return stands_on(outlook, wheel, road, -spec.radius - 2 * spec.travel).has_value();
}

}  // namespace engine
