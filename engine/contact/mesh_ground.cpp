// The mesh of a vehicle, or of any body, on the ground: kerb, slope, rollover. What lies under a wheel is its suspension's
// business.
#include "engine/contact/mesh_points.h"
#include "engine/contact/road.h"
#include "engine/geometry/mesh_overlap.h"
#include "engine/world.h"

namespace engine {

template <>
Touches touches_between<ShapeKind::mesh, ShapeKind::plane>(const Outlook& outlook, const ContactPair& pair) {
  World& world = outlook.world;
  const Pose& X = outlook.at.X_WB[pair.a];
  const double margin = contact_margin(outlook, pair.a), height = world.model.ground.height;
  const Aabb box = box_of(world, outlook.at, pair.a);
  if (box.lower.z() >= height + margin) return {};
  // of a vehicle that stands upright and clear of the road neither its mesh nor its wheels: the road is under them
  const auto& shape = std::get<MeshShape>(world.model.bodies[pair.a].shape);
  const bool low = world_bounds(*shape.mesh, X * shape.X_BM).lower.z() < height + margin;
  const bool upright = (X.q * Vec3::UnitZ()).z() > kWheelFacing;
  const std::vector<SurfacePoint>& points = world.pairs.points[pair.a];
  const std::size_t wheels = first_of_wheels(points);
  touch_with_points(outlook, pair.a, points, {low ? 0 : wheels, upright ? wheels : points.size()},
                    {.height = height, .within = box, .rolls = kWheelFacing}, margin);
  return world.pairs.point_contacts;
}

template <>
Touches touches_between<ShapeKind::mesh, ShapeKind::terrain>(const Outlook& outlook, const ContactPair& pair) {
  constexpr std::uint32_t kOnTerrain = 0x400000u;
  World& world = outlook.world;
  const TriangleMesh& terrain = *world.model.ground.terrain;
  const std::vector<SurfacePoint>& points = world.pairs.points[pair.a];
  touch_with_points(outlook, pair.a, points, {0, points.size()},
                    {.mesh = &terrain, .within = terrain.bounds(), .rolls = kWheelFacing, .road = road_of(world.pairs, kTerrain)},
                    contact_margin(outlook, pair.a));
  for (SurfaceContact& c : world.pairs.point_contacts) c.key |= kOnTerrain;
  return world.pairs.point_contacts;
}

}  // namespace engine
