#include "engine/step/energy_ledger.h"

#include <algorithm>

#include "engine/effects/effect.h"
#include "engine/math/disjoint_sets.h"
#include "engine/step/bounds.h"
#include "engine/step/joint_friction.h"

namespace engine {
namespace {

bool is_hard(const Constraint& c) {
  return (c.kind == ConstraintKind::contact || c.kind == ConstraintKind::limit) && !is_compliant(c);
}

/// Work [J] of a condition over the step on the bodies it acts on.
double work_of(const StepContext& s, std::size_t i) {
  const Constraint& c = s.constraints[i];
  // what it displaces the smooth forces' potential gains or loses: of compliant contacts in the stages, which have none, not theirs
  const bool stop = c.kind == ConstraintKind::limit && contacts_in_stages(s.world.model.settings);
  const Vec3 pull = stop ? s.buffers.pull[i] : Vec3(c.u.smooth - c.u.before);
  const Vec3 mean = 0.5 * (c.u.smooth + c.u.after) - s.buffers.weight[i] * pull;
  double work = 0;
  for (int r = 0; r < c.rows; ++r) work += c.impulse[r] * mean[r];
  // a wedge pushed out lifts the car that lies on it: that is slow, and of the smooth forces gravity alone counts
  return work - c.push / s.length * s.buffers.pull[i][0];
}

/// Wheels and springs may give energy to what they act on.
bool has_springs(const StepContext& s, const std::vector<int>& island) {
  return std::any_of(island.begin(), island.end(),
                     [&](int i) { return s.constraints[i].kind == ConstraintKind::wheel || is_compliant(s.constraints[i]); });
}

/// Change [J] of the mechanical energy of a link's body from `from` to the end of the step, less what its joint's resistance did.
double change_since(StepContext& s, int l, const Motion& from) {
  World& world = s.world;
  const int b = world.topology.links[l].body, j = world.topology.links[l].joint;
  const Body& body = world.model.bodies[b];
  const Pose &X_from = from.X_WB[b], &X_to = s.end.X_WB[b];
  const Twist &V_from = from.V_WB[b], &V_to = s.end.V_WB[b];
  double change = 0.5 * body.mass * (V_to.v - V_from.v).dot(V_to.v + V_from.v);
  change -= body.mass * world.model.settings.gravity.dot(X_to.p - X_from.p);
  const double turning = V_from.w.dot(world.impulse.inertia_at(world.topology, l, X_from.q) * V_from.w);
  change += 0.5 * (V_to.w.dot(world.smooth.inertia_at(world.topology, l, X_to.q) * V_to.w) - turning);
  return s.any_damper && j >= 0 && s.buffers.dampers[j].present ? change - resistance_work(s, j) : change;
}

/// Rise [J] of the mechanical energy of each island without springs, by its root.
void note_rises(StepContext& s) {
  World& world = s.world;
  Islands& islands = s.buffers.islands;
  for (const int tree : world.active_trees) {
    const int root = math::representative(islands.of_tree, tree);
    if (islands.members[root].empty() || has_springs(s, islands.members[root])) continue;
    for (int l = world.topology.trees[tree].begin; l < world.topology.trees[tree].end; ++l)
      islands.rise[root] += change_since(s, l, s.state);
  }
}

/// What [J] no condition explains of the step's impulses, of the island of which that is most.
double unexplained(StepContext& s) {
  Islands& islands = s.buffers.islands;
  std::vector<double>& left = islands.left;
  left.assign(islands.members.size(), 0);
  for (const int tree : s.world.active_trees)
    for (int l = s.world.topology.trees[tree].begin; l < s.world.topology.trees[tree].end; ++l)
      left[math::representative(islands.of_tree, tree)] += change_since(s, l, s.buffers.smooth);
  for (const int root : islands.roots)
    for (const int i : islands.members[root]) left[root] -= work_of(s, static_cast<std::size_t>(i));
  for (const int tree : s.world.active_trees) left[math::representative(islands.of_tree, tree)] -= islands.moved[tree];
  double most = 0;
  for (const int tree : s.world.active_trees) most = std::max(most, std::abs(left[tree]));
  return most;
}

/// Trees are moved to the end of the step for the springs that squeeze them: it counts with their work.
void book_moved(StepContext& s) {
  Islands& islands = s.buffers.islands;
  if (!s.impulses) return;
  for (const int tree : s.world.active_trees) {
    if (islands.moved[tree] == 0) continue;
    const std::vector<int>& island = islands.members[math::representative(islands.of_tree, tree)];
    const auto squeezes = [&s](int i) { return is_compliant(s.constraints[i]); };
    s.state.energy.dissipated[s.constraints[*std::find_if(island.begin(), island.end(), squeezes)].effect] -= islands.moved[tree];
  }
}

/// The most [J] that the hard contacts and stops of one effect gave which has none to give.
double largest_gift(StepContext& s) {
  std::vector<double>& given = s.buffers.given;
  given.assign(s.world.effects.size(), 0);
  for (std::size_t i = 0; i < s.constraints.size(); ++i)
    if (const Constraint& c = s.constraints[i]; is_hard(c) && !s.world.gives[c.effect]) given[c.effect] += work_of(s, i);
  return *std::max_element(given.begin(), given.end());
}

/// What [J] the wheels' springs hold more than was done to press them. At the start they were looked at as at the end of the step
/// before: what has moved since, a mount with its rider or a wheel that steers, is not of this step.
double stored_unearned(StepContext& s) {
  double stored = -s.state.energy.springs;
  for (const std::size_t e : s.world.taking_part(Hook::stored)) {
    const Meter::Span span(s.world.meter, e);
    stored += s.world.effects[e]->stored(s);
  }
  for (const Constraint& c : s.constraints)
    if (c.kind == ConstraintKind::wheel) stored += c.impulse[0] * 0.5 * (c.u.smooth[0] + c.u.after[0]);
  return stored;
}

}  // namespace

void note_pull(StepContext& s) {
  s.buffers.pull.assign(s.constraints.size(), Vec3::Zero());
  if (s.constraints.empty()) return;
  const World& world = s.world;
  const Vec3& gravity = world.model.settings.gravity;
  for (const int tree : world.active_trees) {
    const Topology::Tree& range = world.topology.trees[tree];
    const bool falls = world.topology.links[range.end - 1].joint < 0;  // its root is free: all its bodies alike
    for (int l = range.begin; l < range.end; ++l) {
      const int b = world.topology.links[l].body;
      s.buffers.force[b] << world.model.bodies[b].mass * gravity, Vec3::Zero();
      s.buffers.result[b] << gravity, Vec3::Zero();
    }
    if (!falls) s.world.impulse.solve(world.topology, tree, s.buffers.force, s.buffers.result, Articulation::Bias::zero);
  }
  for (std::size_t i = 0; i < s.constraints.size(); ++i) {
    const Constraint& c = s.constraints[i];
    for (int r = 0; r < c.rows; ++r) {
      if (c.a.body >= 0) s.buffers.pull[i][r] += s.length * c.a.J.row(r).dot(s.buffers.result[c.a.body]);
      if (c.b.body >= 0) s.buffers.pull[i][r] += s.length * c.b.J.row(r).dot(s.buffers.result[c.b.body]);
    }
  }
}

void book(StepContext& s) {
  World& world = s.world;
  Diagnostics& diagnostics = world.log.diagnostics;
  std::vector<double>& dissipated = s.state.energy.dissipated;
  for (std::size_t i = 0; i < s.constraints.size(); ++i) {
    const Constraint& c = s.constraints[i];
    dissipated[c.effect] -= work_of(s, i);
    if (!is_hard(c)) continue;
    double& deepest = is_angular_limit(c) ? diagnostics.max_joint_angle_error : diagnostics.max_penetration;
    deepest = std::max(deepest, -c.gap);
  }
  book_moved(s);
  if (!s.any_damper) return;
  for (const int tree : world.active_trees)
    for (int l = world.topology.trees[tree].begin; l < world.topology.trees[tree].end; ++l) {
      const int j = world.topology.links[l].joint;
      if (j >= 0 && s.buffers.dampers[j].present) dissipated[s.buffers.resistances[j].effect] -= resistance_work(s, j);
    }
}

void note_gains(StepContext& s) {
  RunLog& log = s.world.log;
  for (std::size_t e = 0; e < s.world.effects.size(); ++e) {
    const double gain = s.buffers.dissipated_before[e] - s.state.energy.dissipated[e];
    if (s.world.gives[e] || gain <= log.gain.amount) continue;
    log.gain = {gain, s.state.time, -1, -1};
    log.gained_by = static_cast<int>(e);
    double most = 0;
    for (std::size_t i = 0; s.impulses && i < s.buffers.pull.size(); ++i)
      if (const Constraint& c = s.constraints[i]; c.effect == static_cast<int>(e) && work_of(s, i) > most) {
        most = work_of(s, i);
        log.gain.body_a = c.a.record, log.gain.body_b = c.b.record;
      }
  }
}

double mislaid(StepContext& s) {
  const double unearned = stored_unearned(s);
  return s.impulses ? std::max({unexplained(s), largest_gift(s), unearned}) : unearned;
}

double largest_rise(StepContext& s) {
  Islands& islands = s.buffers.islands;
  islands.rise.assign(islands.members.size(), 0);
  note_rises(s);
  double largest = 0;
  for (const int k : islands.roots) {
    const std::vector<int>& island = islands.members[k];
    if (has_springs(s, island)) {
      for (const int i : island)
        if (is_hard(s.constraints[i])) islands.rise[k] += work_of(s, static_cast<std::size_t>(i));
    }
    largest = std::max(largest, islands.rise[k]);
  }
  return largest;
}

}  // namespace engine
