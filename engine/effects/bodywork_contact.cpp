// The mesh of a vehicle (or of any body) against ground, terrain and other meshes by Default-Auto, at many points through the one
// contact solver: rollover, landing on the roof, a kerb, cars that do not both ask for Kudlich-Slibar. Points of each mesh are
// held against the other's surface. What lies under a wheel is its suspension's business; what it meets sideways, or lies on when
// the vehicle has turned over, touches its rim and flanks here.
#include "engine/contact/mesh_points.h"
#include "engine/effects/registration.h"
#include "engine/effects/words.h"

namespace engine {
namespace {

/// A pair that meets by Default-Auto, and why: which of the two does not ask for Kudlich-Slibar.
std::string with_law(const Model& model, int body_a, int body_b) {
  const Body &a = model.bodies[body_a], &b = model.bodies[body_b];
  if (coupled(model, body_a, body_b)) return a.name + " with " + b.name + " (default_auto: coupled)";
  const bool from_a = a.collision_model == CollisionModel::kudlich_slibar,
             from_b = b.collision_model == CollisionModel::kudlich_slibar;
  const std::string who = from_a ? b.name + " does not ask" : from_b ? a.name + " does not ask" : "neither asks";
  return a.name + " with " + b.name + " (default_auto: " + who + " for kudlich_slibar)";
}

Finding look_for_bodywork_contact(const Model& model) {
  std::vector<std::string> moving, pairs;
  const int n = static_cast<int>(model.bodies.size());
  for (int a = 0; a < n; ++a) {
    if (is_mesh(model.bodies[a]) && !model.bodies[a].fixed) moving.push_back(model.bodies[a].name);
    for (int b = a + 1; b < n; ++b)
      if (meshes_meet(model, a, b)) pairs.push_back(with_law(model, a, b));
  }
  const bool ground = model.ground.plane || model.ground.terrain;
  if (moving.empty()) return {false, "no vehicle and no other mesh that moves", ""};
  if (pairs.empty() && !ground) return {false, "no ground, and no second mesh to meet", ""};
  std::string reason = ground ? listed(moving) + " can touch the ground with its body (kerb, slope, rollover)" : "";
  if (moving.size() > 1 && ground) reason = listed(moving) + " can touch the ground with their bodies (kerb, slope, rollover)";
  if (!pairs.empty()) reason += (ground ? ", and " : "") + listed(pairs) + (ground ? "" : " can touch");
  std::vector<std::string> held, towing;
  for (int a = 0; a < n; ++a)
    for (int b = a + 1; b < n; ++b)
      if (is_mesh(model.bodies[a]) && is_mesh(model.bodies[b]) && model.bodies[a].person < 0 && jointed(model, a, b))
        (coupled(model, a, b) ? towing : held).push_back(model.bodies[a].name + " with " + model.bodies[b].name);
  std::string left_out = "only meshes whose boxes a step cannot bring together";
  if (!held.empty()) left_out += "; " + listed(held) + ", which a joint holds";
  if (!towing.empty())
    left_out += "; of " + listed(towing) + " what stands within 5 cm of the other at the start, about the coupling";
  return {true, reason, left_out};
}

}  // namespace

class BodyworkContact final : public Effect {
 public:
  static constexpr const char* kName = "bodywork_contact";
  static constexpr bool kPassive = true;
  static Finding look(const Model& model) { return look_for_bodywork_contact(model); }
  static bool gives(const Model& model) { return model.settings.contact_law != ContactLaw::default_auto; }

  BodyworkContact(World& world, int self) : Effect(self), wheeled_(wheeled_pairs(world.model)) {
    list_mesh_pairs(world.model, world.pairs);
    for (int b = 0; b < static_cast<int>(world.model.bodies.size()); ++b)
      if (is_mesh(world.model.bodies[b])) meshes_.push_back(b);
  }

  void find_contacts(ContactSearch& search) override {
    const World& world = search.world;
    const Ground& ground = world.model.ground;
    const std::vector<int>& tree = world.topology.tree_of_body;
    const std::vector<BodyPair>& pairs = world.pairs.bodywork;
    std::size_t i = 0;
    for (const int a : meshes_) {
      if (world.awake[a]) {
        if (ground.plane) add_contacts(search, plane_, {a, kPlane}, self_);
        if (ground.terrain) add_contacts(search, terrain_, {a, kTerrain}, self_);
      }
      for (; i < pairs.size() && pairs[i].a == a; ++i) {
        if (!world.pairs.broad_phase.close(tree[a], tree[pairs[i].b])) continue;
        add_contacts(search, mesh_, {a, pairs[i].b, i}, self_);
        add_contacts(search, mesh_, {pairs[i].b, a, i}, self_);
      }
    }
    for (const BodyPair& pair : wheeled_) {
      if (!world.pairs.broad_phase.close(tree[pair.a], tree[pair.b])) continue;
      add_contacts(search, tyre_, {pair.a, pair.b}, self_);
      add_contacts(search, tyre_, {pair.b, pair.a}, self_);
    }
  }

 private:
  const PairKind& plane_ = pair_kind({ShapeKind::mesh, ShapeKind::plane});
  const PairKind& terrain_ = pair_kind({ShapeKind::mesh, ShapeKind::terrain});
  const PairKind& mesh_ = pair_kind({ShapeKind::mesh, ShapeKind::mesh});
  const PairKind& tyre_ = pair_kind({ShapeKind::tyre, ShapeKind::tyre});
  const std::vector<BodyPair> wheeled_;
  std::vector<int> meshes_;
};
template struct Registered<BodyworkContact>;

}  // namespace engine
