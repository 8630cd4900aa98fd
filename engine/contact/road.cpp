#include "engine/contact/road.h"

#include <algorithm>
#include <cmath>

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

namespace {

/// A wheel on its strut, at static ride, and how far up it may come to stand in a step.
struct Climb {
  Tyre tyre;
  Vec3 up;
  double most = 0;     // [m] of the strut
  double highest = 0;  // [m] over the tyre's centre: what is higher is too steep to the tyre where it is now
};

Climb climb_of(const Outlook& outlook, int wheel) {
  const WheelState& state = outlook.state.wheels[static_cast<std::size_t>(wheel)];
  const Vehicle& vehicle = outlook.world.model.vehicles[state.vehicle];
  const Wheel& spec = vehicle.wheels[state.wheel];
  // one that rolls up has not got farther than the last step took it: what is deeper has come from the side
  const double rise = contact_margin(outlook, vehicle.body) / kWheelFacing;
  return {tyre_of(outlook, wheel, 0), outlook.at.X_WB[vehicle.body].q * Vec3::UnitZ(), std::min(2 * spec.travel, state.lift + rise),
          state.lift - kWheelFacing * spec.radius};
}

}  // namespace

std::optional<TyreTouch> stands_on(const Outlook& outlook, int wheel, const Road& road, double least) {
  const Climb climb = climb_of(outlook, wheel);
  const Vec3 room = Vec3::Constant(climb.tyre.radius + std::max(std::abs(least), std::abs(climb.most)));
  if (((climb.tyre.centre - room).array() > road.box.upper.array()).any() ||
      ((climb.tyre.centre + room).array() < road.box.lower.array()).any())
    return std::nullopt;
  const auto touch =
      move_clear(climb.tyre, *road.mesh, road.X_WM, climb.up, kWheelFacing, {least, climb.most}, outlook.world.pairs.point_scratch);
  if (touch && climb.up.dot(touch->point - climb.tyre.centre) > climb.highest) return std::nullopt;
  return touch;
}

bool carries(const Outlook& outlook, int wheel, const Road& road) {
  const WheelState& state = outlook.state.wheels[static_cast<std::size_t>(wheel)];
  const Wheel& spec = outlook.world.model.vehicles[state.vehicle].wheels[state.wheel];
  return stands_on(outlook, wheel, road, -2 * spec.travel).has_value();
}

bool mounts(const Outlook& outlook, int wheel, double radius, const Road& road, const SurfaceContact& touch) {
  constexpr double kInside = 0.01;  // [m] behind the surface met
  const Climb climb = climb_of(outlook, wheel);
  const Vec3 forward = climb.tyre.axle.cross(climb.up), behind = touch.p_b - kInside * touch.normal;
  const Vec3 from_hub = behind - climb.tyre.centre;
  const double s = forward.dot(from_hub), z = climb.up.dot(from_hub);
  // of what is no higher than this the top is met on the way down
  const double top = std::min(climb.most - std::sqrt(std::max(0.0, radius * radius - s * s)), climb.highest);
  if (top < z) return false;
  const Vec3 up_M = road.X_WM.q.conjugate() * climb.up;
  double way = 0;
  int triangle = -1;
  return road.mesh->raycast(road.X_WM.inverse() * (behind + (top - z) * climb.up), -up_M, top - z + kInside, way, triangle) &&
         road.mesh->face_normals()[static_cast<std::size_t>(triangle)].dot(up_M) > 0;
}

}  // namespace engine
