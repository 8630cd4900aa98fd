// Segments and free bodies on a terrain mesh.
#include <algorithm>

#include "engine/effects/registration.h"
#include "engine/effects/words.h"

namespace engine {
namespace {

bool has_surface(const Body& body) {
  return !body.fixed && std::holds_alternative<HyperEllipsoid>(body.shape);
}

Finding look_at(const Model& model) {
  const std::string round = round_bodies(model);
  if (!model.ground.terrain) return {false, "no terrain mesh", ""};
  if (round.empty()) return {false, "no person and no free body; vehicles meet the terrain by tyres and bodywork_contact", ""};
  return {true, round + " over a terrain of " + counted(model.ground.terrain->triangles().size(), "triangle"),
          "bodies farther from it than they can travel in a step: exact"};
}

}  // namespace

class TerrainContact final : public Effect {
 public:
  static constexpr const char* kName = "terrain_contact";
  static Finding look(const Model& model) { return look_at(model); }
  static bool gives(const Model& model) { return model.settings.contact_law != ContactLaw::default_auto; }

  TerrainContact(World& world, int self) : Effect(self) {
    if (!world.model.ground.terrain) return;
    for (int b = 0; b < static_cast<int>(world.model.bodies.size()); ++b)
      if (has_surface(world.model.bodies[b])) world.pairs.mesh.push_back({self, b, -1, world.model.ground.terrain.get()});
    reserve(world.pairs.mesh_scratch, *world.model.ground.terrain);
  }

  void find_contacts(ContactSearch& search) override {
    World& world = search.world;
    const Ground& ground = world.model.ground;
    const double t = search.at.time;
    ContactPoints touches;
    for (std::size_t i = 0; i < world.pairs.mesh.size(); ++i) {
      const MeshPair& pair = world.pairs.mesh[i];
      if (pair.effect != self_ || !world.awake[pair.body]) continue;
      const Body& body = world.model.bodies[pair.body];
      const Pose& X = search.at.X_WB[pair.body];
      const double margin = contact_margin(search, pair.body), reach = world.reach[pair.body];
      Clearance& clearance = search.state.contact_memory.mesh[i];
      if (clearance.beyond(margin, X, reach)) continue;
      contacts_with_mesh(std::get<HyperEllipsoid>(body.shape), X, *pair.mesh, Pose{}, margin, clearance.by_now(X, reach),
                         world.pairs.mesh_scratch, touches);
      clearance.note(world.pairs.mesh_scratch.apart, X, reach);
      const double e = restitution_on_ground(body, ground, t);
      const std::size_t first = search.found.size();
      for (const SurfaceContact& touch : touches)
        add_contact(search, touch, pair.body, kTerrain, self_, {friction_on_ground(body, ground, touch.p_b, t), e});
      share_stiffness(search, first);
    }
  }
};
template struct Registered<TerrainContact>;

}  // namespace engine
