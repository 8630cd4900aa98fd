// Segments and free bodies against the meshes of vehicles and other bodies.
#include <algorithm>

#include "engine/effects/effects.h"
#include "engine/effects/words.h"

namespace engine {
namespace {

bool can_meet(const Body& round, const Body& mesh) {
  // a rider and what it rides overlap where it sits: its joints hold the two apart
  const bool rides = round.person >= 0 && round.person == mesh.person;
  return is_round(round) && is_mesh(mesh) && !rides && !(round.fixed && mesh.fixed);
}

Finding look(const Model& model) {
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
  if (meshes == 0) return {false, "no vehicle and no other mesh", ""};
  if (pairs == 0) return {false, "no mesh but what the person rides", ""};
  std::string left_out = "pairs farther apart than they can travel in a step: exact";
  if (riding > 0) left_out += "; " + counted(riding, "pair") + " of a rider and its mount, whose joints hold them apart";
  return {true, counted(pairs, "pair") + " of a segment or free body and " + listed(names), left_out};
}

/// One more pair of these trees, the `at`-th of its list, joins the last run if it is of the same kind.
void add_to_runs(std::vector<MeshPairRun>& runs, int effect, int tree_a, int tree_b, std::size_t at) {
  if (runs.empty() || runs.back().effect != effect || runs.back().tree_a != tree_a || runs.back().tree_b != tree_b)
    runs.push_back({effect, tree_a, tree_b, at, at});
  runs.back().end = at + 1;
}

void begin(World& world, const State&, int self) {
  const auto& bodies = world.model.bodies;
  const std::vector<int>& tree = world.topology.tree_of_body;
  for (int m = 0; m < static_cast<int>(bodies.size()); ++m)
    for (int b = 0; b < static_cast<int>(bodies.size()); ++b)
      if (can_meet(bodies[b], bodies[m])) {
        add_to_runs(world.mesh_pair_runs, self, tree[b], tree[m], world.mesh_pairs.size());
        world.mesh_pairs.push_back({self, b, m, std::get<MeshShape>(bodies[m].shape).mesh.get(), {}});
      }
  for (const MeshPair& pair : world.mesh_pairs) reserve(world.mesh_scratch, *pair.mesh);
}

void find_contacts_of(World& world, const State& state, const MeshPairRun& run, ContactPoints& touches) {
  for (std::size_t i = run.begin; i < run.end; ++i) {
    MeshPair& pair = world.mesh_pairs[i];
    if (!world.awake[pair.body] && !world.model.bodies[pair.body].fixed) continue;  // waits or sleeps: those effects watch
    const Body& round = world.model.bodies[pair.body];
    const Body& mesh = world.model.bodies[pair.mesh_body];
    if (!world.awake[pair.mesh_body] && !mesh.fixed) continue;
    const Pose X_WM = state.X_WB[pair.mesh_body] * std::get<MeshShape>(mesh.shape).X_BM;
    const double margin = pair_margin(world, state, pair.body, pair.mesh_body);
    const Pose X_MA = X_WM.inverse() * state.X_WB[pair.body];
    if (pair.clearance.beyond(margin, X_MA, world.reach[pair.body])) continue;
    contacts_with_mesh(std::get<HyperEllipsoid>(round.shape), state.X_WB[pair.body], *pair.mesh, X_WM, margin,
                       pair.clearance.by_now(X_MA, world.reach[pair.body]), world.mesh_scratch, touches);
    pair.clearance.note(world.mesh_scratch.apart, X_MA, world.reach[pair.body]);
    const double mu = std::min(round.surface.friction_body.at(state.time), mesh.surface.friction_body.at(state.time));
    const double e = std::max(round.surface.restitution_body.at(state.time), mesh.surface.restitution_body.at(state.time));
    const std::size_t first = world.constraints.size();
    for (const SurfaceContact& touch : touches)
      add_contact(world, state, touch, pair.body, pair.mesh_body, run.effect, ContactKind::vehicle, mu, e);
    share_stiffness(world, first);
  }
}

void find(World& world, const State& state, int) {
  ContactPoints touches;
  for (const MeshPairRun& run : world.mesh_pair_runs)
    if (world.nearness.close(run.tree_a, run.tree_b)) find_contacts_of(world, state, run, touches);
}

}  // namespace

const Effect kMeshContactEffect{.name = "mesh_contact", .look = look, .begin = begin, .find_contacts = find};

}  // namespace engine
