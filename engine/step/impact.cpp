#include "engine/step/impact.h"

#include <algorithm>
#include <cmath>

#include "engine/math/roots.h"
#include "engine/step/bounds.h"
#include "engine/step/islands.h"
#include "engine/step/solve.h"

namespace engine {
namespace {

/// Fixed, or a body by itself that is no part of a person or vehicle.
bool is_free(const World& world, int body) {
  if (body < 0) return true;
  const Topology::Tree& tree = world.topology.trees[static_cast<std::size_t>(world.topology.tree_of_body[body])];
  const Body& of = world.model.bodies[body];
  return tree.end - tree.begin == 1 && world.topology.links[tree.begin].joint < 0 && of.person < 0 && of.vehicle < 0;
}

/// What takes part in the impact of an island: all that touches, and of what still closes that which meets at the same instant.
/// Their targets are those of Newton's rule. False if no touch is an instant.
bool choose_members(StepContext& s, const std::vector<int>& island) {
  constexpr double kTogether = 1e-8;  // [m]
  const double v_impact = impact_speed(s), touching = s.world.model.settings.touch_distance;
  const bool placing = places_impacts(s.world, s.state);
  bool any = false;
  s.buffers.members.clear();
  for (const int i : island) {
    Constraint& c = s.constraints[i];
    if (c.kind == ConstraintKind::wheel || c.gap > touching) continue;  // closed loops have no gap: they take part
    const bool closing = c.u.before[0] < -v_impact, instant = is_instant(s.world, c);
    if (placing && closing && instant && c.gap > kTogether) continue;
    s.buffers.members.push_back(i);
    any = any || (closing && instant);
    c.target = closing ? -c.surface.restitution * c.u.before[0] : 0;
    c.u.free = c.u.smooth = c.u.before;
    c.impulse.setZero();
  }
  return any;
}

SolveReport solve(StepContext& s) {
  return s.world.solver.solve(s.constraints, s.buffers.members, 1e-3 * s.world.model.settings.solver_tolerance);
}

/// Newton's rule at several points with friction can create energy (Kane 1984): all restitutions scaled until it does not.
void take_out_gain(StepContext& s, SolveReport& report) {
  World& world = s.world;
  const std::vector<int>& members = s.buffers.members;
  const double energy_change = world.solver.kinetic_energy_change(s.constraints, members);
  double energy_before = 0;
  for (const int i : members)
    for (int r = 0; r < s.constraints[i].rows; ++r)
      energy_before += std::abs(s.constraints[i].impulse[r] * s.constraints[i].u.free[r]);
  if (!(energy_change > 1e-12 * energy_before)) return;
  std::vector<double>& targets = s.buffers.targets;
  targets.clear();
  for (const int i : members) targets.push_back(s.constraints[i].target);
  const auto keeps_energy = [&](double share) {
    for (std::size_t i = 0; i < members.size(); ++i) s.constraints[members[i]].target = share * targets[i];
    report = solve(s);
    return !(world.solver.kinetic_energy_change(s.constraints, members) > 0);
  };
  keeps_energy(math::bisect({0, 1}, 29, 0, keeps_energy).low);
  ++world.log.diagnostics.restitution_scaled;
}

/// The impulses of the members change the velocities of the state, through the joints.
void apply_at_once(StepContext& s) {
  World& world = s.world;
  std::vector<Vec6>&force = s.buffers.force, &result = s.buffers.result;
  for_awake_bodies(world, [&](int b) { force[b].setZero(); });
  for (const int i : s.buffers.members) {
    const Constraint& c = s.constraints[i];
    for (int r = 0; r < c.rows; ++r) {
      if (c.a.body >= 0) force[c.a.body] += c.a.J.row(r).transpose() * c.impulse[r];
      if (c.b.body >= 0) force[c.b.body] += c.b.J.row(r).transpose() * c.impulse[r];
    }
  }
  for (const int tree : world.active_trees) {
    world.impulse.solve(world.topology, tree, force, result, Articulation::Bias::zero);
    for (int l = world.topology.trees[tree].begin; l < world.topology.trees[tree].end; ++l) {
      const int b = world.topology.links[l].body;
      s.state.V_WB[b].v += result[b].head<3>();
      s.state.V_WB[b].w += result[b].tail<3>();
    }
  }
}

void exchange(StepContext& s) {
  World& world = s.world;
  world.solver.assemble(world.topology, world.impulse, s.constraints, s.buffers.members);
  SolveReport report = solve(s);
  take_out_gain(s, report);
  Diagnostics& diagnostics = world.log.diagnostics;
  diagnostics.max_solver_residual = std::max(diagnostics.max_solver_residual, report.residual);
  if (report.worst >= 0) world.log.unsettled.note(report.residual, s.state.time, s.constraints[report.worst]);
  diagnostics.contact_sweeps += report.sweeps;
  apply_at_once(s);
  for (const int i : s.buffers.members) {
    const Constraint& c = s.constraints[i];
    s.state.energy.dissipated[c.effect] -= c.impulse.dot(0.5 * (c.u.before + c.u.after));
  }
}

}  // namespace

bool is_instant(const World& world, const Constraint& c) {
  if (is_compliant(c)) return false;
  if (c.kind == ConstraintKind::limit) return world.model.bodies[c.a.record].person < 0;
  if (!is_contact(c)) return false;
  return c.surface.restitution > 0 || is_between_free(world, c);
}

bool is_between_free(const World& world, const Constraint& c) {
  return is_free(world, c.a.body) && is_free(world, c.b.body);
}

bool places_impacts(const World& world, const State& state) {
  constexpr int kMaxCuts = 8;  // of one step
  return world.model.settings.locate_events && state.pace.cuts < kMaxCuts;
}

NextImpact next_impact(const StepContext& s) {
  NextImpact next{s.length, 0};
  const double v_impact = impact_speed(s);
  for (const Constraint& c : s.constraints) {
    if (c.gap <= kPlaced || c.u.before[0] > -v_impact || !is_instant(s.world, c)) continue;
    if (const double time = c.gap / -c.u.before[0]; time < next.time) next = {time, c.key};
  }
  return next;
}

bool exchange_impacts(StepContext& s, const OnImpulses& on_impulses) {
  const double v_impact = impact_speed(s);
  const double nearest = places_impacts(s.world, s.state) ? kPlaced : s.world.model.settings.touch_distance;
  const bool any = std::any_of(s.constraints.begin(), s.constraints.end(), [&](const Constraint& c) {
    return c.gap <= nearest && c.u.before[0] < -v_impact && is_instant(s.world, c);
  });
  if (!any) return false;
  const Meter::Span span(s.world.meter, Phase::impulses);
  factor_for_impulses(s);
  build_islands(s);
  for (const int root : s.buffers.islands.roots)
    if (choose_members(s, s.buffers.islands.members[root])) exchange(s);
  if (on_impulses) on_impulses(s.constraints, s.state.time, 0);
  return true;
}

}  // namespace engine
