// Points of one mesh on the surface of another.
#include "engine/contact/mesh_points.h"
#include "engine/contact/road.h"
#include "engine/world.h"

namespace engine {
namespace {

constexpr double kFarther = 0.01;     // [m] a point so much deeper than the way since allows came from behind
constexpr double kUnderWheel = 0.75;  // [-] cosine to the vehicle's up axis: a wheel rolls on what is nearer to level

/// Where the boxes of a pair meet; nothing if a step cannot bring them together.
std::optional<Aabb> shared_box(const Outlook& outlook, std::size_t which, double margin) {
  const BodyPair& pair = outlook.world.pairs.bodywork[which];
  const Motion& at = outlook.at;
  const Aabb box_a = box_of(outlook.world, at, pair.a), box_b = box_of(outlook.world, at, pair.b);
  const Aabb shared{box_a.lower.cwiseMax(box_b.lower), box_a.upper.cwiseMin(box_b.upper)};
  if ((shared.lower.array() <= shared.upper.array() + margin).all()) return shared;
  for (Clearance& clearance : outlook.state.contact_memory.bodywork[which])
    clearance = {0, at.X_WB[pair.a].inverse() * at.X_WB[pair.b]};
  return std::nullopt;
}

}  // namespace

template <>
Touches touches_between<ShapeKind::mesh, ShapeKind::mesh>(const Outlook& outlook, const ContactPair& pair) {
  World& world = outlook.world;
  const Motion& at = outlook.at;
  const auto [low, high] = world.pairs.bodywork[pair.at];
  const auto way = static_cast<std::size_t>(pair.a == low ? 0 : 1);
  const double margin = pair_margin(outlook, low, high);
  const std::optional<Aabb> within = shared_box(outlook, pair.at, margin);
  if (!within) return {};
  const Pose X_AB = at.X_WB[low].inverse() * at.X_WB[high];
  Clearance& clearance = outlook.state.contact_memory.bodywork[pair.at][way];
  const auto& shape = std::get<MeshShape>(world.model.bodies[pair.b].shape);
  const Road* road = road_of(world.pairs, pair.b);
  const std::vector<SurfacePoint>& points = *world.pairs.bodywork_points[pair.at][way];
  touch_with_points(outlook, pair.a, points, {0, points.size()},
                    {.mesh = shape.mesh.get(),
                     .X_WM = at.X_WB[pair.b] * shape.X_BM,
                     .within = *within,
                     .rolls = kUnderWheel,
                     .is_ground = false,
                     .road = road,
                     .least = clearance.by_now(X_AB, world.reach[high]) - kFarther},
                    margin);
  clearance = {0, X_AB};
  for (const SurfaceContact& c : world.pairs.point_contacts) clearance.least = std::min(clearance.least, c.gap);
  return world.pairs.point_contacts;
}

}  // namespace engine
