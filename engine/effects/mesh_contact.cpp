// Segments and free bodies against the meshes of vehicles and other bodies.
#include <algorithm>
#include <utility>

#include "engine/contact/round_tyre.h"
#include "engine/effects/registration.h"
#include "engine/effects/words.h"

namespace engine {
namespace {

constexpr double kHangs = 1;  // [m] no wheel hangs lower than that

bool can_meet(const Body& round, const Body& mesh) {
  // a rider and what it rides overlap where it sits: its joints hold the two apart
  const bool rides = round.person >= 0 && round.person == mesh.person;
  return is_round(round) && is_mesh(mesh) && !rides && !(round.fixed && mesh.fixed);
}

constexpr double kTyreStiffness = 2e5;  // [N/m] vertical, of a passenger car's tyre

Finding look_for_mesh_contact(const Model& model) {
  std::size_t pairs = 0, riding = 0, meshes = 0, rounds = 0;
  std::vector<std::string> names;
  for (const Body& mesh : model.bodies) {
    rounds += is_round(mesh);
    if (!is_mesh(mesh)) continue;
    ++meshes;
    const auto meets = std::count_if(model.bodies.begin(), model.bodies.end(), [&](const Body& b) { return can_meet(b, mesh); });
    pairs += static_cast<std::size_t>(meets);
    if (meets > 0) names.push_back(mesh.name);
    for (const Body& b : model.bodies) riding += is_round(b) && b.person >= 0 && b.person == mesh.person;
  }
  if (rounds == 0) return {false, "no person and no free body", ""};
  if (const std::size_t tyres = tyre_pairs(model).size(); pairs == 0 && tyres > 0)
    return {true, counted(tyres, "pair") + " of a segment or free body and a wheel", ""};
  if (meshes == 0) return {false, "no vehicle and no other mesh", ""};
  if (pairs == 0) return {false, "no mesh but what the person rides", ""};
  std::string left_out = "only pairs farther apart than a step can bring them together";
  if (riding > 0) left_out += "; " + counted(riding, "pair") + " of a rider and its mount, whose joints hold them apart";
  const bool gives_way = !model.persons.empty() && yields(model.settings.contact_law, true);
  return {true, counted(pairs, "pair") + " of a segment or free body and " + listed(names) + (gives_way ? "; persons yield" : ""),
          left_out};
}

/// One more pair of these trees, the `at`-th of its list, joins the last run if it is of the same kind.
void add_to_runs(std::vector<MeshPairRun>& runs, int effect, int tree_a, int tree_b, std::size_t at) {
  if (runs.empty() || runs.back().effect != effect || runs.back().tree_a != tree_a || runs.back().tree_b != tree_b)
    runs.push_back({effect, tree_a, tree_b, at, at});
  runs.back().end = at + 1;
}

}  // namespace

class MeshContact final : public Effect {
 public:
  static constexpr const char* kName = "mesh_contact";
  static constexpr bool kPassive = true;
  static Finding look(const Model& model) { return look_for_mesh_contact(model); }
  static double not_before(const Model&, const Reach& reach) { return reach.groups_are_simple ? reach.first_touch : 0; }
  static bool gives(const Model& model) {  // tyres yield under every law
    return model.settings.contact_law != ContactLaw::default_auto || (!model.persons.empty() && !tyre_pairs(model).empty());
  }

  MeshContact(World& world, int self) : Effect(self) {
    const auto& bodies = world.model.bodies;
    const std::vector<int>& tree = world.topology.tree_of_body;
    ContactPairs& pairs = world.pairs;
    for (int m = 0; m < static_cast<int>(bodies.size()); ++m)
      for (int b = 0; b < static_cast<int>(bodies.size()); ++b)
        if (can_meet(bodies[b], bodies[m])) {
          add_to_runs(pairs.mesh_runs, self, tree[b], tree[m], pairs.mesh.size());
          pairs.mesh.push_back({self, b, m, std::get<MeshShape>(bodies[m].shape).mesh.get()});
        }
    for (const MeshPair& pair : pairs.mesh) reserve(pairs.mesh_scratch, *pair.mesh);
    for (const Body& body : bodies)  // asked once, a panel's search has its room before the first step
      if (const auto* mesh = std::get_if<MeshShape>(&body.shape); mesh && mesh->panels)
        panel_at(*mesh->mesh, *mesh->panels, Vec3::Zero(), Vec3::UnitZ());
  }

  void find_contacts(ContactSearch& search) override {
    const ContactPairs& pairs = search.world.pairs;
    for (const std::size_t r : pairs.in_reach.mesh)
      for (std::size_t i = pairs.mesh_runs[r].begin; i < pairs.mesh_runs[r].end; ++i)
        add_contacts(search, mesh_, {pairs.mesh[i].body, pairs.mesh[i].mesh_body, i}, self_);
    if (search.state.wheels.empty()) return;  // they meet nothing without the effect `tyres`
    int wheel = -1;
    Vec3 hub;
    for (const std::size_t i : pairs.in_reach.tyres) {
      const TyrePair& pair = pairs.tyres[i];
      if (!search.world.awake[pair.vehicle_body]) continue;
      if (std::exchange(wheel, pair.wheel) != pair.wheel) hub = hub_of(search, pair);
      if (near(search, pair, hub, pair_margin(search, pair.body, pair.vehicle_body))) find_beside_tyre(search, i);
    }
  }

 private:
  /// What a wheel meets sideways; what it stands on is the suspension's business.
  void find_beside_tyre(ContactSearch& search, std::size_t index) const {
    const World& world = search.world;
    const TyrePair& pair = world.pairs.tyres[index];
    if (stands_on(search, pair, -kHangs)) return;
    const std::size_t before = search.found.size();
    add_contacts(search, tyre_, {pair.body, pair.vehicle_body, index}, self_);
    if (search.found.size() > before && yields_as_rubber(world.model, pair.body)) give_rubber(search.found.back());
  }

  static void give_rubber(Constraint& c) {
    constexpr double kDeepest = 0.08;  // [m] beyond which the rim would come through
    c.spring.stiffness = kTyreStiffness;
    c.spring.hysteresis = c.surface.restitution;
    c.surface.restitution = 0;
    c.spring.room = kDeepest;
    c.spring.struck_mass = 1 / c.response.free;
  }

  const PairKind& mesh_ = pair_kind({ShapeKind::round, ShapeKind::mesh});
  const PairKind& tyre_ = pair_kind({ShapeKind::round, ShapeKind::tyre});
};
template struct Registered<MeshContact>;

}  // namespace engine
