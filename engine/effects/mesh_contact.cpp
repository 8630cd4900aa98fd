// Segments and free bodies against the meshes of vehicles and other bodies.
#include <algorithm>

#include "engine/effects/effects.h"

namespace engine {
namespace {

bool is_round(const Body& body) {
  return std::holds_alternative<HyperEllipsoid>(body.shape);
}
bool is_mesh(const Body& body) {
  return std::holds_alternative<MeshShape>(body.shape);
}
bool can_meet(const Body& round, const Body& mesh) {
  // a rider and what it rides overlap where it sits: its joints hold the two apart
  const bool rides = round.person >= 0 && round.person == mesh.person;
  return is_round(round) && is_mesh(mesh) && !rides && !(round.fixed && mesh.fixed);
}

std::optional<std::string> called_for(const Model& model) {
  long pairs = 0;
  for (const Body& round : model.bodies)
    for (const Body& mesh : model.bodies) pairs += can_meet(round, mesh);
  if (pairs == 0) return std::nullopt;
  return std::to_string(pairs) + " pairs of a hyper-ellipsoid and a mesh (vehicle or body)";
}

void begin(World& world, const State&, int self) {
  const auto& bodies = world.model.bodies;
  for (int m = 0; m < static_cast<int>(bodies.size()); ++m)
    for (int b = 0; b < static_cast<int>(bodies.size()); ++b)
      if (can_meet(bodies[b], bodies[m]))
        world.mesh_pairs.push_back({self, b, m, std::get<MeshShape>(bodies[m].shape).mesh.get(), {}, {}});
}

void find(World& world, const State& state, int self) {
  ContactPoints touches;
  for (MeshPair& pair : world.mesh_pairs) {
    if (pair.effect != self) continue;
    if (!world.awake[pair.body] && !world.model.bodies[pair.body].fixed) continue;  // in the zero condition: that effect watches
    const Body& round = world.model.bodies[pair.body];
    const Body& mesh = world.model.bodies[pair.mesh_body];
    const Pose X_WM = state.X_WB[pair.mesh_body] * std::get<MeshShape>(mesh.shape).X_BM;
    const double margin = pair_margin(world, state, pair.body, pair.mesh_body);
    const Pose X_MA = X_WM.inverse() * state.X_WB[pair.body];
    if (pair.clearance.beyond(margin, X_MA, world.reach[pair.body])) continue;
    contacts_with_mesh(std::get<HyperEllipsoid>(round.shape), state.X_WB[pair.body], *pair.mesh, X_WM, margin, pair.scratch,
                       touches);
    pair.clearance = {pair.scratch.apart, X_MA};
    const double mu = std::min(round.surface.friction_body.at(state.time), mesh.surface.friction_body.at(state.time));
    const double e = std::max(round.surface.restitution_body.at(state.time), mesh.surface.restitution_body.at(state.time));
    for (const SurfaceContact& touch : touches)
      add_contact(world, state, touch, pair.body, pair.mesh_body, self, ContactKind::vehicle, mu, e);
  }
}

}  // namespace

const Effect kMeshContactEffect{.name = "mesh_contact", .called_for = called_for, .begin = begin, .find_contacts = find};

}  // namespace engine
