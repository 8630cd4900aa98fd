// A hyper-ellipsoid on the plane of the ground, eq. (70) to (74).
#include "engine/geometry/hyper_ellipsoid_plane.h"
#include "engine/world.h"

namespace engine {

template <>
Touches touches_between<ShapeKind::round, ShapeKind::plane>(const Outlook& outlook, const ContactPair& pair) {
  World& world = outlook.world;
  const Pose& X = outlook.at.X_WB[pair.a];
  const double height = world.model.ground.height, margin = contact_margin(outlook, pair.a);
  if (X.p.z() - height > world.reach[pair.a] + margin) return {};
  const auto& shape = std::get<HyperEllipsoid>(world.model.bodies[pair.a].shape);
  if (X.p.z() - height > support_bound(shape, X.q.conjugate() * Vec3::UnitZ()) + margin) return {};
  ContactPoints& touches = world.pairs.touches;
  contacts_with_plane(shape, X, Vec3::UnitZ(), height, margin, touches);
  return {touches.begin(), touches.end()};
}

}  // namespace engine
