// A hyper-ellipsoid on a triangle mesh: one that a body carries, or the terrain.
#include <cmath>

#include "engine/world.h"

namespace engine {
namespace {

constexpr double kPasses = 0.25;  // [-] of the body: ground gives way to nobody

/// The mesh stands at X_WM, the round body at X_MA in its frame.
Touches touches_on_mesh(const Outlook& outlook, const ContactPair& pair, const Pose& X_WM, const Pose& X_MA, double margin,
                        double may_pass) {
  World& world = outlook.world;
  auto& [clearance, entered] = outlook.state.contact_memory.mesh[pair.at];
  const double reach = world.reach[pair.a];
  if (clearance.beyond(margin, X_MA, reach)) return {};
  ContactPoints& touches = world.pairs.touches;
  const auto& shape = std::get<HyperEllipsoid>(world.model.bodies[pair.a].shape);
  const Pose& X_WA = outlook.at.X_WB[pair.a];
  const bool by_history = !std::isfinite(may_pass);
  if (by_history && !std::isfinite(clearance.least)) may_pass = kPasses;  // there is none yet
  contacts_with_mesh(shape, X_WA, *world.pairs.mesh[pair.at].mesh, X_WM, margin, clearance.by_now(X_MA, reach),
                     world.pairs.mesh_scratch, touches, may_pass, entered);
  if (by_history) entered = sides_of(shape, X_WA.q, touches);
  clearance.note(world.pairs.mesh_scratch.apart, X_MA, reach);
  return {touches.begin(), touches.end()};
}

}  // namespace

template <>
Touches touches_between<ShapeKind::round, ShapeKind::mesh>(const Outlook& outlook, const ContactPair& pair) {
  const Model& model = outlook.world.model;
  const Pose X_WM = outlook.at.X_WB[pair.b] * std::get<MeshShape>(model.bodies[pair.b].shape).X_BM;
  return touches_on_mesh(outlook, pair, X_WM, X_WM.inverse() * outlook.at.X_WB[pair.a], pair_margin(outlook, pair.a, pair.b),
                         may_pass(model, pair.a));
}

template <>
Touches touches_between<ShapeKind::round, ShapeKind::terrain>(const Outlook& outlook, const ContactPair& pair) {
  return touches_on_mesh(outlook, pair, Pose{}, outlook.at.X_WB[pair.a], contact_margin(outlook, pair.a), kPasses);
}

}  // namespace engine
