#include "engine/world.h"

#include <algorithm>
#include <numeric>

#include "engine/effects/effect.h"

namespace engine {

namespace {

constexpr unsigned kActs = static_cast<unsigned>(Hook::find_contacts) | static_cast<unsigned>(Hook::find_limits);

/// Joints that do not hold: none, or all when the effect is forced off.
std::vector<char> apart(const Model& model, const Plan& plan) {
  const bool held = model.joints.empty() || plan.has("joints");
  return std::vector<char>(model.joints.size(), static_cast<char>(!held));
}

}  // namespace

World::World(const Model& m, const Plan& p, const RunOptions& o)
    : model(m), plan(p), topology(build_topology(m, apart(m, p))), smooth(m), impulse(m), loops(m), meter(o.clock) {
  for (const EffectKind* effect : p.active) meter.effects.push_back({effect->name, 0, 0});
  smooth.reset(topology);
  impulse.reset(topology);
  loops.reset(topology);
  coordinates.reset(m.joints.size());
  const std::size_t n = m.bodies.size();
  reach.assign(n, 0);
  awake.assign(n, 1);
  for (std::size_t b = 0; b < n; ++b) {
    const Body& body = m.bodies[b];
    if (body.fixed) awake[b] = 0;
    if (const auto* shape = std::get_if<HyperEllipsoid>(&body.shape)) reach[b] = shape->semi_axes.norm();
    if (const auto* shape = std::get_if<MeshShape>(&body.shape)) {
      const Aabb& box = shape->mesh->bounds();
      const Vec3 far = box.lower.cwiseAbs().cwiseMax(box.upper.cwiseAbs());
      reach[b] = far.norm() + shape->X_BM.p.norm();
    }
  }
  for (const Vehicle& vehicle : m.vehicles)  // it may have no bodywork, and wheels that stand out of it
    for (const Wheel& wheel : vehicle.wheels)
      reach[vehicle.body] =
          std::max(reach[vehicle.body], wheel.hub_B.norm() + wheel.radius + crown_radius(wheel) + 2 * wheel.travel);
  for (const Topology::Tree& tree : topology.trees) {
    double mass = 0;
    for (int l = tree.begin; l < tree.end; ++l) mass += m.bodies[topology.links[l].body].mass;
    tree_mass.push_back(mass);
  }
  solver.reserve(topology, kRoom);
  active_trees.reserve(topology.trees.size());
  awake_joints.reserve(m.joints.size());
  still.others.resize(n);
  std::iota(still.others.begin(), still.others.end(), 0);
  still.chosen_of.reserve(m.persons.size() + topology.trees.size() + m.joints.size());
  log.events.reserve(kRoom);
  for (std::size_t e = 0; e < p.active.size(); ++e) {
    effects.push_back(p.active[e]->make(*this, static_cast<int>(e)));
    for (std::size_t hook = 0; hook < of_hook_.size(); ++hook)
      if ((p.active[e]->hooks >> hook & 1) != 0) of_hook_[hook].push_back(e);
    log.acted.push_back({.told = (p.active[e]->hooks & kActs) != 0});
    gives.push_back(static_cast<char>(p.active[e]->gives && p.active[e]->gives(m)));
  }
}

World::~World() = default;

double RunLog::overlap_at_start(int a, int b) const {
  double depth = 0;
  for (const Overlap& met : overlaps)
    if (std::minmax(met.a, met.b) == std::minmax(a, b)) depth = std::max(depth, met.depth);
  return depth;
}

void warn_of_overlap(World& world, int a, int b, double gap) {
  constexpr double kTold = 1e-3;  // [m]
  constexpr double kParts = 0.1;  // [m] deeper, points of a mesh are not followed to the surface of another
  if (gap > -kTold) return;
  auto name = [&](int body) { return body >= 0 ? world.model.bodies[body].name : std::string("the ground"); };
  std::vector<std::string>& warnings = world.log.diagnostics.warnings;
  const auto pair = [&](int one, int other) { return name(one) + " and " + name(other) + " overlap by "; };
  const double before = world.log.overlap_at_start(a, b);
  world.log.overlaps.push_back({a, b, -gap});
  if (before >= -gap) return;
  // one warning a pair, of the deepest
  if (before > 0)
    std::erase_if(warnings, [&](const std::string& w) { return w.starts_with(pair(a, b)) || w.starts_with(pair(b, a)); });
  const auto with_mesh = [&world](int body) { return body >= 0 && is_mesh(world.model.bodies[body]); };
  const auto& bodies = world.model.bodies;
  const bool meshes = with_mesh(a) && with_mesh(b);
  const bool never =
      meshes && model_between(bodies[a].collision_model, bodies[b].collision_model) == CollisionModel::kudlich_slibar;
  const char* parted = never ? " or more at the start; a run does not part what collides by Kudlich-Slibar: move one"
                       : meshes && -gap > kParts
                           ? " or more at the start; a run does not part what stands so deep in another: move one"
                           : " at the start; they are moved apart gently";
  warnings.push_back(pair(a, b) + std::to_string(std::lround(-gap * 1e3)) + " mm" + parted);
}

namespace {

bool waits(const State& state, int person) {
  return person >= 0 && !state.released[person];
}

/// All that the choice of trees hangs on: who waits, who sleeps, what has broken.
void write_choice(const World& world, const State& state, std::vector<char>& out) {
  out.assign(state.released.begin(), state.released.end());
  out.insert(out.end(), state.asleep.begin(), state.asleep.end());
  if (!world.topology.loops.empty()) out.insert(out.end(), state.broken.begin(), state.broken.end());
}

bool is_chosen(const World& world, const State& state) {
  const std::vector<char>& known = world.still.chosen_of;
  const std::size_t persons = state.released.size(), trees = state.asleep.size();
  const std::size_t joints = world.topology.loops.empty() ? 0 : state.broken.size();
  if (world.still.changes == 0 || known.size() != persons + trees + joints) return false;
  const auto same = [&](const std::vector<char>& now, std::size_t count, std::size_t from) {
    return std::equal(now.begin(), now.begin() + static_cast<std::ptrdiff_t>(count),
                      known.begin() + static_cast<std::ptrdiff_t>(from));
  };
  return same(state.released, persons, 0) && same(state.asleep, trees, persons) && same(state.broken, joints, persons + trees);
}

/// Neither takes part nor walks or rides on.
bool is_still(const World& world, const State& state, int body) {
  const Body& of = world.model.bodies[body];
  if (of.fixed) return true;
  const bool mounted = of.person >= 0 && world.model.persons[of.person].mount >= 0;
  return !world.awake[body] && !mounted && state.V_WB[body].v.isZero(0) && state.V_WB[body].w.isZero(0);
}

void list_still(World& world, const State& state) {
  StillBodies& still = world.still;
  still.others.clear();
  still.potential = 0;
  for (int b = 0; b < static_cast<int>(world.model.bodies.size()); ++b) {
    const Body& body = world.model.bodies[b];
    if (!is_still(world, state, b))
      still.others.push_back(b);
    else if (!body.fixed)
      still.potential -= body.mass * world.model.settings.gravity.dot(state.X_WB[b].p);
  }
  world.awake_joints.clear();
  for (int j = 0; j < static_cast<int>(world.model.joints.size()); ++j) {
    const Joint& joint = world.model.joints[j];
    if (world.awake[joint.child] || (joint.parent >= 0 && world.awake[joint.parent])) world.awake_joints.push_back(j);
  }
  ++still.changes;
}

}  // namespace

void choose_trees(World& world, const State& state) {
  if (is_chosen(world, state)) return;
  write_choice(world, state, world.still.chosen_of);
  world.active_trees.clear();
  for (int tree = 0; tree < static_cast<int>(world.topology.trees.size()); ++tree) {
    const bool asleep = waits(state, world.topology.trees[tree].person) || (!state.asleep.empty() && state.asleep[tree]);
    const auto& range = world.topology.trees[tree];
    for (int l = range.begin; l < range.end; ++l) world.awake[world.topology.links[l].body] = static_cast<char>(!asleep);
    if (!asleep) world.active_trees.push_back(tree);
  }
  if (!world.topology.loops.empty()) world.loops.choose(world.topology, state.broken, world.awake);
  list_still(world, state);
}

namespace {

double kinetic_energy_of(const Body& body, const Motion& state, std::size_t b) {
  const Vec3 w_B = state.X_WB[b].q.conjugate() * state.V_WB[b].w;
  return 0.5 * body.mass * state.V_WB[b].v.squaredNorm() + 0.5 * w_B.dot(body.inertia_B * w_B);
}

}  // namespace

double kinetic_energy(const Model& model, const Motion& state) {
  double energy = 0;
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    if (!model.bodies[b].fixed) energy += kinetic_energy_of(model.bodies[b], state, b);
  return energy;
}

double kinetic_energy(const World& world, const Motion& state) {
  double energy = 0;
  for (const int b : world.still.others)
    if (!world.model.bodies[b].fixed) energy += kinetic_energy_of(world.model.bodies[b], state, static_cast<std::size_t>(b));
  return energy;
}

double potential_energy(const Model& model, const Motion& state) {
  double energy = 0;
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    if (!model.bodies[b].fixed) energy -= model.bodies[b].mass * model.settings.gravity.dot(state.X_WB[b].p);
  return energy;
}

double mechanical_energy(const World& world, const Motion& state) {
  double energy = world.still.potential;
  for (const int b : world.still.others) {
    const Body& body = world.model.bodies[b];
    if (body.fixed) continue;
    energy += kinetic_energy_of(body, state, static_cast<std::size_t>(b));
    energy -= body.mass * world.model.settings.gravity.dot(state.X_WB[b].p);
  }
  return energy;
}

}  // namespace engine
