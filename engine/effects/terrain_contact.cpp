// Segments and free bodies on a terrain mesh.
#include "engine/effects/registration.h"
#include "engine/effects/words.h"

namespace engine {
namespace {

bool has_surface(const Body& body) {
  return !body.fixed && std::holds_alternative<HyperEllipsoid>(body.shape);
}

Finding look_for_terrain_contact(const Model& model) {
  const std::string round = round_bodies(model);
  if (!model.ground.terrain) return {false, "no terrain mesh", ""};
  if (round.empty()) return {false, "no person and no free body; vehicles meet the terrain by tyres and bodywork_contact", ""};
  return {true, round + " over a terrain of " + counted(model.ground.terrain->triangles().size(), "triangle"),
          "only bodies farther from it than a step can bring them"};
}

}  // namespace

class TerrainContact final : public Effect {
 public:
  static constexpr const char* kName = "terrain_contact";
  static constexpr bool kPassive = true;
  static Finding look(const Model& model) { return look_for_terrain_contact(model); }
  static double not_before(const Model&, const Reach& reach) { return reach.all_rounds_wait ? reach.first_touch : 0; }
  static bool gives(const Model& model) { return model.settings.contact_law != ContactLaw::default_auto; }

  TerrainContact(World& world, int self) : Effect(self) {
    if (!world.model.ground.terrain) return;
    for (int b = 0; b < static_cast<int>(world.model.bodies.size()); ++b)
      if (has_surface(world.model.bodies[b])) world.pairs.mesh.push_back({self, b, kTerrain, world.model.ground.terrain.get()});
    reserve(world.pairs.mesh_scratch, *world.model.ground.terrain);
  }

  void find_contacts(ContactSearch& search) override {
    const std::vector<MeshPair>& pairs = search.world.pairs.mesh;
    for (std::size_t i = 0; i < pairs.size(); ++i)
      if (pairs[i].effect == self_) add_contacts(search, terrain_, {pairs[i].body, kTerrain, i}, self_);
  }

 private:
  const PairKind& terrain_ = pair_kind({ShapeKind::round, ShapeKind::terrain});
};
template struct Registered<TerrainContact>;

}  // namespace engine
