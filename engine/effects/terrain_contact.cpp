// Segments and free bodies on a terrain mesh.
#include <algorithm>

#include "engine/effects/effects.h"
#include "engine/effects/words.h"

namespace engine {
namespace {

bool has_surface(const Body& body) {
  return !body.fixed && std::holds_alternative<HyperEllipsoid>(body.shape);
}

Finding look(const Model& model) {
  const std::string round = round_bodies(model);
  if (!model.ground.terrain) return {false, "no terrain mesh", ""};
  if (round.empty()) return {false, "no person and no free body; vehicles meet the terrain by tyres and bodywork_contact", ""};
  return {true, round + " over a terrain of " + counted(model.ground.terrain->triangles().size(), "triangle"),
          "bodies farther from it than they can travel in a step: exact"};
}

void begin(World& world, const State&, int self) {
  if (!world.model.ground.terrain) return;
  for (int b = 0; b < static_cast<int>(world.model.bodies.size()); ++b)
    if (has_surface(world.model.bodies[b])) world.mesh_pairs.push_back({self, b, -1, world.model.ground.terrain.get(), {}});
  reserve(world.mesh_scratch, *world.model.ground.terrain);
}

void find(World& world, const State& state, int self) {
  ContactPoints touches;
  for (MeshPair& pair : world.mesh_pairs) {
    if (pair.effect != self || !world.awake[pair.body]) continue;
    const Body& body = world.model.bodies[pair.body];
    const auto& shape = std::get<HyperEllipsoid>(body.shape);
    const double margin = contact_margin(world, state, pair.body);
    if (pair.clearance.beyond(margin, state.X_WB[pair.body], world.reach[pair.body])) continue;
    contacts_with_mesh(shape, state.X_WB[pair.body], *pair.mesh, Pose{}, margin,
                       pair.clearance.by_now(state.X_WB[pair.body], world.reach[pair.body]), world.mesh_scratch, touches);
    pair.clearance.note(world.mesh_scratch.apart, state.X_WB[pair.body], world.reach[pair.body]);
    const Ground& ground = world.model.ground;
    const double t = state.time;
    const double e = std::max(body.surface.restitution_ground.at(t), ground.surface.restitution_ground.at(t));
    const std::size_t first = world.constraints.size();
    for (const SurfaceContact& touch : touches) {
      const double mu = std::min(body.surface.friction_ground.at(t), ground.friction_at(touch.p_b, t));
      add_contact(world, state, touch, pair.body, -1, self, ContactKind::terrain, mu, e);
    }
    share_stiffness(world, first);
  }
}

}  // namespace

const Effect kTerrainContactEffect{.name = "terrain_contact", .look = look, .begin = begin, .find_contacts = find};

}  // namespace engine
