// Impacts with restitution: when the next one happens, and the exchange of impulses at that instant.
#include <algorithm>

#include "engine/effects/effect.h"
#include "engine/step.h"
#include "engine/step_bounds.h"

namespace engine {
namespace {

constexpr double kTouching = 2e-5;  // [m] surfaces nearer than this exchange impulses

}  // namespace

double Stepper::time_to_impact(World& world, double h) const {
  double first = h;
  const double v_impact = impact_speed(world);
  for (const Constraint& c : world.constraints) {
    if (!is_contact(c) || c.restitution <= 0 || c.gap <= kTouching || c.u_before[0] > -v_impact) continue;
    first = std::min(first, (c.gap - 0.5 * kTouching) / -c.u_before[0]);
  }
  return first;
}

bool Stepper::impact(World& world, State& state) {
  const double v_impact = impact_speed(world);
  bool any = false;
  for (const Constraint& c : world.constraints)
    any = any || (is_contact(c) && c.restitution > 0 && c.gap <= kTouching && c.u_before[0] < -v_impact);
  if (!any) return false;

  const Meter::Span span(world.meter, Phase::impulses);
  factor_for_impulses(world, state, nullptr);
  form_islands(world);
  std::vector<int>& members = members_;
  for (const auto& island : islands_) {
    members.clear();
    bool has_impact = false;
    for (const int i : island) {
      Constraint& c = world.constraints[i];
      if (c.kind == ConstraintKind::wheel || c.gap > kTouching) continue;
      members.push_back(i);
      const bool closing = is_contact(c) && c.u_before[0] < -v_impact;
      has_impact = has_impact || (closing && c.restitution > 0);
      c.target = closing ? -c.restitution * c.u_before[0] : 0;
      c.u_free = c.u_smooth = c.u_before;
      c.impulse.setZero();
    }
    if (!has_impact) continue;
    double energy_change = 0;
    exchange_impulses(world, state, members, energy_change);
    for (const int i : members) {
      const Constraint& c = world.constraints[i];
      world.dissipated[c.effect] -= c.impulse.dot(0.5 * (c.u_before + c.u_after));
    }
  }
  if (on_impulses) on_impulses(state.time, 0);
  return true;
}

void Stepper::exchange_impulses(World& world, State& state, const std::vector<int>& members, double& energy_change) {
  assemble_solver(world, members);
  SolveReport report = world.solver.solve(world.constraints, members, 1e-3 * world.model.settings.solver_tolerance);
  energy_change = world.solver.kinetic_energy_change(world.constraints, members);

  // Newton's rule at several points with friction can create energy (Kane 1984): scale all restitutions until it does not
  double energy_before = 0;
  for (const int i : members)
    for (int r = 0; r < world.constraints[i].rows; ++r)
      energy_before += std::abs(world.constraints[i].impulse[r] * world.constraints[i].u_free[r]);
  if (energy_change > 1e-12 * energy_before) {
    std::vector<double>& targets = targets_;
    targets.clear();
    for (const int i : members) targets.push_back(world.constraints[i].target);
    double low = 0, high = 1;
    for (int k = 0; k < 30; ++k) {
      const double share = k == 29 ? low : 0.5 * (low + high);
      for (std::size_t i = 0; i < members.size(); ++i) world.constraints[members[i]].target = share * targets[i];
      report = world.solver.solve(world.constraints, members, 1e-3 * world.model.settings.solver_tolerance);
      energy_change = world.solver.kinetic_energy_change(world.constraints, members);
      (energy_change > 0 ? high : low) = share;
    }
    ++world.diagnostics.restitution_scaled;
  }
  world.diagnostics.max_solver_residual = std::max(world.diagnostics.max_solver_residual, report.residual);
  if (report.worst >= 0) world.unsettled.note(report.residual, state.time, world.constraints[report.worst]);
  world.diagnostics.contact_sweeps += report.sweeps;

  for (const int tree : world.active_trees)
    for (int l = world.topology.trees[tree].begin; l < world.topology.trees[tree].end; ++l)
      force_[world.topology.links[l].body].setZero();
  for (const int i : members) {
    const Constraint& c = world.constraints[i];
    for (int r = 0; r < c.rows; ++r) {
      if (c.body_a >= 0) force_[c.body_a] += c.J_a.row(r).transpose() * c.impulse[r];
      if (c.body_b >= 0) force_[c.body_b] += c.J_b.row(r).transpose() * c.impulse[r];
    }
  }
  for (const int tree : world.active_trees) {
    world.impulse.solve(world.topology, tree, force_, result_, Articulation::Bias::zero);
    for (int l = world.topology.trees[tree].begin; l < world.topology.trees[tree].end; ++l) {
      const int b = world.topology.links[l].body;
      state.V_WB[b].v += result_[b].head<3>();
      state.V_WB[b].w += result_[b].tail<3>();
    }
  }
}

}  // namespace engine
