// The step, scheme `stepping`:
//   1 contacts and limits at the start of the step, with the distance bodies can travel as margin
//   2 an impact with restitution: cut the step where surfaces touch, exchange impulses there at all touching points at once
//   3 smooth motion by RK4 through the joints: x', V'
//   4 joint resistance and impulses L of all conditions in one solve: V+ = V' + K^-1 (J^T L + resistance)
//   5 displacement that goes with them: all of the step for an impact, half of it for a force that acts all through the step, so
//     that constant friction stops a body exactly where v^2/(2 mu g) says and a body held on a slope does not creep
//   6 joint drift projected out
//   7 contacts and limits at the end of the step: what it was blind to (curved surfaces, fast turns, neighbouring triangles) shows
//   as
//     penetration there; if that is more than a bound the step is taken again at half its length
#include "engine/step.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "engine/divergence.h"
#include "engine/effects/effect.h"

namespace engine {
namespace {

constexpr double kTouching = 2e-5;         // [m] surfaces nearer than this exchange impulses
constexpr double kSlop = 2e-5;             // [m] penetration that is let be: pushing it out would make resting bodies hum
constexpr double kLimitSlop = 2e-5;        // [rad]
constexpr double kMayPenetrate = 9e-4;     // [m] more after a step than before: the step is halved
constexpr double kMayExceed = 7e-3;        // [rad] the same of joint limits
constexpr int kMaxCuts = 8;                // of one step; then impulses act where the bodies are
constexpr double kRecovery = 0.5;          // [-] share of a penetration that a step left taken out in the next
constexpr double kRecoverySpeed = 0.2;     // [m/s] at which a deeper one, there from the start, is taken out
constexpr double kLimitRecoverySpeed = 2;  // [rad/s]
constexpr double kUnsolved = 0.01;         // [m/s] residual above which the step is halved and taken again
constexpr double kSmoothTurn = 0.1;        // [rad] of any body in one step of the smooth motion
constexpr double kSmoothSwing = 2.0;       // [-] rate of a swing under joint forces times the step: RK4 bears 2.8
constexpr double kLargestTurn = 0.3;       // [rad] in one step of all
constexpr double kMostParts = 20;
constexpr double kMostAdaptiveParts = 1000;
constexpr int kMostPasses = 6;       // through the impulses of one step, while joints are torn loose
constexpr double kCarried = 0.02;    // [s] over which an error of speed counts as one of place: a bounce is short, its speed lasts
constexpr double kSpringStep = 0.3;  // [rad] of a compliant contact's spring in one step: it keeps its energy to 1e-5

bool is_contact(const Constraint& c) {
  return c.kind == ConstraintKind::contact;
}

/// A contact whose depth is a deformation, not an error.
bool is_compliant(const Constraint& c) {
  return c.stiffness > 0;
}

/// Closing speed above which restitution acts and a touch counts as an impact; below, things come to rest.
double impact_speed(const World& world) {
  return std::max(2 * world.model.settings.gravity.norm() * world.step, 0.01);
}

}  // namespace

Stepper::Stepper(World& world)
    : smooth_(world.model),
      force_(world.model.bodies.size(), Vec6::Zero()),
      result_(world.model.bodies.size(), Vec6::Zero()),
      damping_(world.model.bodies.size(), Vec6::Zero()) {
  reserve(world);
  const Settings& settings = world.model.settings;
  if (settings.scheme == Scheme::adaptive) depth_tolerance_ = std::max(10 * settings.adaptive_tolerance, 2 * kSlop);
  if (settings.contact_law != ContactLaw::compliant || settings.scheme == Scheme::stepping) return;
  compliant_.emplace(world.model, [&world](const State& state, double within, std::vector<Constraint>& found) {
    world.constraints.swap(found);
    const double step = world.step;
    world.step = within;
    call(world, &Effect::find_contacts, state);
    world.step = step;
    world.constraints.swap(found);
  });
}

/// Every buffer at the size a step may want.
void Stepper::reserve(const World& world) {
  const std::size_t trees = world.topology.trees.size();
  for (auto* list : {&step_constraints_, &contacts_, &end_contacts_}) list->reserve(kRoom);
  for (auto* list : {&weight_, &allowed_, &targets_}) list->reserve(kRoom);
  islands_.resize(trees);
  for (auto& island : islands_) island.reserve(kRoom);
  island_has_impact_.reserve(trees);
  island_of_tree_.reserve(trees);
  contact_trees_.reserve(trees);
  members_.reserve(kRoom);
  end_.warm.reserve(kRoom);
}

/// What stands inside something else before anything has moved.
void Stepper::warn_of_overlaps(World& world) const {
  constexpr double kTold = 1e-3;  // [m]
  for (const Constraint& c : contacts_) {
    if (c.kind != ConstraintKind::contact || c.gap > -kTold || is_compliant(c)) continue;
    auto name = [&](int body) { return body >= 0 ? world.model.bodies[body].name : std::string("the ground"); };
    world.diagnostics.warnings.push_back(name(c.record_a) + " and " + name(c.record_b) + " overlap by " +
                                         std::to_string(std::lround(-c.gap * 1e3)) +
                                         " mm at the start; they are moved apart gently");
  }
}

void Stepper::choose_trees(World& world, const State& state) {
  world.active_trees.clear();
  for (int tree = 0; tree < static_cast<int>(world.topology.trees.size()); ++tree) {
    const int person = world.topology.trees[tree].person;
    const bool asleep = person >= 0 && !state.released[person];
    const auto& range = world.topology.trees[tree];
    for (int l = range.begin; l < range.end; ++l) world.awake[world.topology.links[l].body] = static_cast<char>(!asleep);
    if (!asleep) world.active_trees.push_back(tree);
  }
}

void Stepper::find_contacts(World& world, const State& state, std::vector<Constraint>& found) {
  world.constraints.clear();
  for (std::size_t e = 0; e < world.plan.active.size(); ++e) {
    const Effect* effect = world.plan.active[e];
    if (!effect->find_contacts && !effect->find_limits) continue;
    if (effect->find_contacts && compliant_) continue;
    const Meter::Span span(world.meter, e);
    (effect->find_contacts ? effect->find_contacts : effect->find_limits)(world, state, static_cast<int>(e));
  }
  world.constraints.swap(found);
}

/// The conditions of a step of length h: the contacts found at its start and what follows the clock, in the order of the plan.
void Stepper::assemble_constraints(World& world, const State& state, double h) {
  world.step = h;
  world.constraints.clear();
  auto contact = contacts_.begin();
  for (std::size_t e = 0; e < world.plan.active.size(); ++e) {
    const Effect* effect = world.plan.active[e];
    while (contact != contacts_.end() && contact->effect == static_cast<int>(e)) world.constraints.push_back(*contact++);
    if (!effect->find) continue;
    const Meter::Span span(world.meter, e);
    effect->find(world, state, static_cast<int>(e));
  }
  for (Constraint& c : world.constraints) c.u_before = row_velocity(c, state.V_WB);
}

double Stepper::time_to_impact(World& world, double h) const {
  double first = h;
  const double v_impact = impact_speed(world);
  for (const Constraint& c : world.constraints) {
    if (!is_contact(c) || c.restitution <= 0 || c.gap <= kTouching || c.u_before[0] > -v_impact) continue;
    first = std::min(first, (c.gap - 0.5 * kTouching) / -c.u_before[0]);
  }
  return first;
}

void Stepper::form_islands(World& world) {
  // trees joined by a constraint form an island; union by smallest index
  const int trees = static_cast<int>(world.topology.trees.size());
  island_of_tree_.resize(trees);
  for (int t = 0; t < trees; ++t) island_of_tree_[t] = t;
  auto find = [&](int t) {
    while (island_of_tree_[t] != t) t = island_of_tree_[t] = island_of_tree_[island_of_tree_[t]];
    return t;
  };
  auto tree_of = [&](int body) { return body < 0 ? -1 : world.topology.tree_of_body[body]; };
  for (const Constraint& c : world.constraints) {
    const int a = tree_of(c.body_a), b = tree_of(c.body_b);
    if (a < 0 || b < 0) continue;
    const int ra = find(a), rb = find(b);
    if (ra != rb) island_of_tree_[std::max(ra, rb)] = std::min(ra, rb);
  }
  for (auto& island : islands_) island.clear();
  islands_.resize(trees);
  for (int i = 0; i < static_cast<int>(world.constraints.size()); ++i) {
    const Constraint& c = world.constraints[i];
    islands_[find(tree_of(c.body_a >= 0 ? c.body_a : c.body_b))].push_back(i);
  }
}

void Stepper::factor_for_impulses(World& world, const State& state, const std::vector<JointDamper>* dampers) {
  for (const int tree : world.active_trees) world.impulse.factor(world.topology, tree, state.X_WB, dampers);
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
  world.response.clear();
  for (const int i : members) {
    const Constraint& c = world.constraints[i];
    if (c.body_a >= 0) world.response.touch(world.topology, c.body_a);
    if (c.body_b >= 0) world.response.touch(world.topology, c.body_b);
  }
  world.response.compute(world.topology, world.impulse);
  world.solver.assemble(world.topology, world.response, world.constraints, members);
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

void Stepper::prepare_resistance(World& world, const State& state, double h) {
  world.any_damper = false;
  world.step = h;
  call(world, &Effect::resist, state);
}

void Stepper::set_targets(World& world, double h) {
  const double v_impact = impact_speed(world);
  weight_.assign(world.constraints.size(), 0.5);
  island_has_impact_.assign(islands_.size(), 0);
  for (std::size_t k = 0; k < islands_.size(); ++k) {
    bool impact = false;
    for (const int i : islands_[k]) {
      const Constraint& c = world.constraints[i];
      const double threshold = c.kind == ConstraintKind::limit ? 0.5 : v_impact;  // [rad/s], [m/s]
      const bool hard = c.kind == ConstraintKind::contact || c.kind == ConstraintKind::limit;
      impact = impact ||
               (hard && !is_compliant(c) && c.u_before[0] < -threshold && c.gap + h * std::min(c.u_before[0], c.u_free[0]) < 0);
    }
    island_has_impact_[k] = impact;
    for (const int i : islands_[k]) {
      Constraint& c = world.constraints[i];
      if (c.kind == ConstraintKind::wheel || c.kind == ConstraintKind::bilateral) continue;  // their effect set it
      if (is_compliant(c)) {
        const double smoothing = std::max(1e-3, h * world.model.settings.gravity.norm());
        const double S = c.gap >= 0 ? c.stiffness
                                    : compliant_normal_force(c.stiffness, std::max(c.hysteresis, 1e-3), 1, c.u_before[0],
                                                             ContactPhase::resting, smoothing);
        if (h * h * S * c.free_response < 1) {
          // the spring at the mean of its depths at both ends, which neither gains nor loses energy of itself:
          // L = -h S (gap + h (u_before + u_after) / 4)
          c.softness = 4 / (h * h * S);
          c.target = -4 * c.gap / h - c.u_before[0];
          weight_[i] = 0.5;
        } else {
          // a step too long to follow the spring: at its end, which is stable however stiff, L = -h S (gap + h u_after)
          c.softness = 1 / (h * h * S);
          c.target = -c.gap / h;
          weight_[i] = 1;
        }
        continue;
      }
      weight_[i] = impact ? 1.0 : 0.5;
      if (impact) {
        c.target = -std::max(0.0, c.gap) / h;
      } else {
        c.target = -std::max(0.0, 2 * c.gap / h + c.u_before[0]);
      }
    }
  }
}

double Stepper::solve_islands(World& world, State& state, double h) {
  double residual = 0;
  for (auto& island : islands_) {
    if (island.empty()) continue;
    // what stays open whatever the others do needs no row; keep those that could close
    for (const int i : island) {
      Constraint& c = world.constraints[i];
      const auto found = std::lower_bound(state.warm.begin(), state.warm.end(), c.key,
                                          [](const WarmStart& w, std::uint64_t key) { return w.key < key; });
      if (found == state.warm.end() || found->key != c.key) continue;
      if (c.rows == 3) {
        c.impulse = c.frame.transpose() * found->impulse_W;
        if (is_contact(c)) c.impulse = project_to_cone(c.impulse, c.friction);
      } else {
        c.impulse[0] = found->impulse_W[0];
      }
    }
    world.response.clear();
    for (const int i : island) {
      const Constraint& c = world.constraints[i];
      if (c.body_a >= 0) world.response.touch(world.topology, c.body_a);
      if (c.body_b >= 0) world.response.touch(world.topology, c.body_b);
    }
    world.response.compute(world.topology, world.impulse);
    world.solver.assemble(world.topology, world.response, world.constraints, island);
    const SolveReport report = world.solver.solve(world.constraints, island, world.model.settings.solver_tolerance);
    world.diagnostics.contact_sweeps += report.sweeps;
    world.diagnostics.newton_steps += report.newton_steps;
    residual = std::max(residual, report.residual);
    push_apart(world, island, h);
  }
  return residual;
}

/// What stands inside each other is moved apart at the level of positions, so that it leaves without speed.
void Stepper::push_apart(World& world, const std::vector<int>& island, double h) {
  bool any = false;
  allowed_.clear();
  for (const int i : island) {
    const Constraint& c = world.constraints[i];
    if (c.kind == ConstraintKind::wheel || c.kind == ConstraintKind::bilateral || is_compliant(c)) {
      allowed_.push_back(-std::numeric_limits<double>::infinity());
      continue;
    }
    const bool limit = c.kind == ConstraintKind::limit;
    const double slop = limit ? kLimitSlop : kSlop;
    const double travel = h * (0.5 * (c.u_before[0] + c.u_smooth[0]) + weight_[i] * (c.u_after[0] - c.u_smooth[0]));
    const double end = c.gap + travel;
    double floor = -slop;
    if (c.gap < -slop) {
      const double fresh = limit ? kMayExceed : kMayPenetrate;  // what a step leaves; deeper was there before: apart gently
      const double most = c.gap > -fresh ? kRecovery * (-c.gap - slop) : h * (limit ? kLimitRecoverySpeed : kRecoverySpeed);
      floor = std::min(c.gap + std::min(most, -c.gap - slop), -slop);
    }
    allowed_.push_back(std::min(floor, 0.0) - end);
    any = any || allowed_.back() > 1e-9;
  }
  if (any) world.solver.push_apart(world.constraints, island, allowed_);
}

void Stepper::keep_impulses(const World& world, State& state) const {
  state.warm.clear();
  for (const Constraint& c : world.constraints) {
    if (c.impulse.squaredNorm() == 0) continue;
    state.warm.push_back({c.key, c.rows == 3 ? Vec3(c.frame * c.impulse) : c.impulse});
  }
  std::sort(state.warm.begin(), state.warm.end(), [](const WarmStart& a, const WarmStart& b) { return a.key < b.key; });
}

void Stepper::apply(World& world, double h) {
  // velocities take the whole impulse, displacements its weighted share
  auto push = [&](bool displacement) {
    for (const int tree : world.active_trees)
      for (int l = world.topology.trees[tree].begin; l < world.topology.trees[tree].end; ++l)
        force_[world.topology.links[l].body].setZero();
    for (std::size_t i = 0; i < world.constraints.size(); ++i) {
      const Constraint& c = world.constraints[i];
      const double share = displacement ? weight_[i] * h : 1;
      for (int r = 0; r < c.rows; ++r) {
        const double amount = share * c.impulse[r] + (displacement && r == 0 ? c.push : 0);
        if (amount == 0) continue;
        if (c.body_a >= 0) force_[c.body_a] += c.J_a.row(r).transpose() * amount;
        if (c.body_b >= 0) force_[c.body_b] += c.J_b.row(r).transpose() * amount;
      }
    }
    for (const int tree : world.active_trees) world.impulse.solve(world.topology, tree, force_, result_, Articulation::Bias::zero);
  };
  push(false);
  for (const int tree : world.active_trees)
    for (int l = world.topology.trees[tree].begin; l < world.topology.trees[tree].end; ++l) {
      const int b = world.topology.links[l].body;
      V_[b].v += result_[b].head<3>();
      V_[b].w += result_[b].tail<3>();
    }
  push(true);
  for (const int tree : world.active_trees)
    for (int l = world.topology.trees[tree].begin; l < world.topology.trees[tree].end; ++l) {
      const int b = world.topology.links[l].body;
      displace(X_[b], result_[b].head<3>(), result_[b].tail<3>());
    }
}

void Stepper::book(World& world) {
  for (std::size_t i = 0; i < world.constraints.size(); ++i) {
    const Constraint& c = world.constraints[i];
    const Vec3 mean = 0.5 * (c.u_smooth + c.u_after) - weight_[i] * (c.u_smooth - c.u_before);
    double work = 0;
    for (int r = 0; r < c.rows; ++r) work += c.impulse[r] * mean[r];
    world.dissipated[c.effect] -= work;
    if (is_contact(c) && !is_compliant(c)) world.diagnostics.max_penetration = std::max(world.diagnostics.max_penetration, -c.gap);
    if (c.kind == ConstraintKind::limit)
      world.diagnostics.max_joint_angle_error = std::max(world.diagnostics.max_joint_angle_error, -c.gap);
  }
}

/// Rows that cannot close within the step are let go before anything is assembled.
void Stepper::drop_open_rows(World& world, double h) {
  const double v_impact = impact_speed(world);
  std::erase_if(world.constraints, [&](Constraint& c) {
    c.impulse.setZero();
    c.push = 0;
    c.u_smooth = row_velocity(c, V_);
    if (c.kind == ConstraintKind::wheel || c.kind == ConstraintKind::bilateral) return false;
    // an impact that the cut step ends at: a row would brake the approach
    if (locating_ && is_contact(c) && c.restitution > 0 && c.gap > 0 && c.u_before[0] < -v_impact) return true;
    const double spare = c.kind == ConstraintKind::limit ? 0.02 + 5 * h : 1e-3 + h;  // [rad], [m]: what other impulses may add
    return c.gap + h * std::min(c.u_before[0], c.u_smooth[0]) > spare;
  });
}

/// Springs, dampers and dry friction of the joints, linearly implicit: their work goes to the books at once.
void Stepper::apply_resistance(World& world, double h) {
  const Topology& topology = world.topology;
  for (const int tree : world.active_trees) {
    const Topology::Tree& range = topology.trees[tree];
    for (int l = range.begin; l < range.end; ++l) force_[topology.links[l].body].setZero();
    for (int l = range.begin; l < range.end; ++l) {
      const int j = topology.links[l].joint;
      if (j < 0 || !world.dampers[j].present) continue;
      const Joint& joint = world.model.joints[j];
      Vec3 w_PC = V_[joint.child].w;
      if (joint.parent >= 0) w_PC -= V_[joint.parent].w;
      world.resistances[j].w_PC = w_PC;
      const Vec3 twist = world.resistances[j].torque_W * h - world.dampers[j].matrix * w_PC;
      force_[joint.child].tail<3>() += twist;
      if (joint.parent >= 0) force_[joint.parent].tail<3>() -= twist;
    }
    world.impulse.solve(topology, tree, force_, result_, Articulation::Bias::zero);
    for (int l = range.begin; l < range.end; ++l) {
      const int b = topology.links[l].body;
      V_[b].v += result_[b].head<3>();
      V_[b].w += result_[b].tail<3>();
      displace(X_[b], 0.5 * h * result_[b].head<3>(), 0.5 * h * result_[b].tail<3>());
    }
  }
}

/// Work of the joint resistance, once the velocities at the end of the step are known.
void Stepper::book_resistance(World& world, double h) {
  for (const int tree : world.active_trees) {
    for (int l = world.topology.trees[tree].begin; l < world.topology.trees[tree].end; ++l) {
      const int j = world.topology.links[l].joint;
      if (j < 0 || !world.dampers[j].present) continue;
      const Joint& joint = world.model.joints[j];
      const Resistance& resistance = world.resistances[j];
      Vec3 w_PC = V_[joint.child].w;
      if (joint.parent >= 0) w_PC -= V_[joint.parent].w;
      const Vec3 twist = resistance.torque_W * h - world.dampers[j].matrix * w_PC;
      world.dissipated[resistance.effect] -= 0.5 * twist.dot(w_PC + resistance.w_PC);
    }
  }
}

/// Angular speed [rad/s] of the fastest body. Joint rows and contact points change by the angle turned, to second order of which a
/// step is blind: a light limb flung at 300 rad/s gets its steps divided, the rest of the run keeps its own.
double Stepper::fastest_turning(const World& world, const State& state) const {
  double fastest = 0;
  for (const int tree : world.active_trees)
    for (int l = world.topology.trees[tree].begin; l < world.topology.trees[tree].end; ++l)
      fastest = std::max(fastest, state.V_WB[world.topology.links[l].body].w.squaredNorm());
  return std::sqrt(fastest);
}

/// Drift of the joints taken out; returns the largest gap [m] there was.
double Stepper::close_joints(World& world) {
  const Meter::Span span(world.meter, Phase::joint_projection);
  return project_joints(world, X_, V_, force_, result_);
}

double Stepper::advance(World& world, State& state, double h) {
  choose_trees(world, state);
  turning_ = fastest_turning(world, state);
  if (turning_ * h > kLargestTurn) {
    ++world.diagnostics.substeps;
    h = std::max(kLargestTurn / turning_, h / kMostParts);
  }
  if (const double swing = smooth_.fastest_swing() * h / kSmoothSwing; swing > 1) {
    ++world.diagnostics.substeps;
    h /= std::max(1.0, swing / kMostParts);
  }
  if (next_step_ > 0) h = std::min(h, next_step_);
  world.step = h;
  call(world, &Effect::before_step, state);
  choose_trees(world, state);
  if (!contacts_known_ || contact_trees_ != world.active_trees) {
    world.step = world.model.settings.step;
    find_contacts(world, state, contacts_);
    if (state.time == 0) warn_of_overlaps(world);
  }
  assemble_constraints(world, state, h);
  if (impact(world, state))
    for (Constraint& c : world.constraints) c.u_before = row_velocity(c, state.V_WB);
  return attempt(world, state, h);
}

/// The smooth motion over h to end_; with scheme `adaptive` in two halves, and returns the estimated error [m] of the one taken
/// whole (Richardson: the halves are closer by 2^4).
double Stepper::integrate(World& world, const State& state, double h) {
  const Meter::Span span(world.meter, Phase::integration);
  CompliantContacts* compliant = compliant_ ? &*compliant_ : nullptr;
  // the error a second of turning leaves goes with w (w h)^4: parts in number with w^(5/4) would keep it what it is at the bound
  const double for_turning = std::pow(turning_ * h / kSmoothTurn, 2.0);
  const double wanted = std::max(for_turning, smooth_.fastest_swing() / kSmoothSwing * h);
  const int parts = static_cast<int>(std::clamp(std::ceil(wanted), 1.0, kMostParts));
  auto advance_over = [&](double length) {
    if (compliant) compliant->next_part(length / parts);
    for (int k = 0; k < parts; ++k) smooth_.advance(world, end_, length / parts, X_, V_, compliant);
  };
  auto begin = [&] {
    end_ = state;
    end_.time = state.time + h;
    world.time = state.time;
    if (compliant) compliant->restart(h);
  };
  begin();
  advance_over(h);
  if (world.model.settings.scheme != Scheme::adaptive) return 0;
  X_whole_ = X_;
  V_whole_ = V_;
  begin();
  advance_over(0.5 * h);
  advance_over(0.5 * h);
  double error = 0;
  for (const int tree : world.active_trees)
    for (int l = world.topology.trees[tree].begin; l < world.topology.trees[tree].end; ++l) {
      const int b = world.topology.links[l].body;
      const double turn = 2 * (X_[b].q.coeffs() - X_whole_[b].q.coeffs()).norm();
      const double place = (X_[b].p - X_whole_[b].p).norm() + world.reach[b] * turn;
      const double speed = (V_[b].v - V_whole_[b].v).norm() + world.reach[b] * (V_[b].w - V_whole_[b].w).norm();
      error = std::max(error, std::max(place, kCarried * speed) / 15);
    }
  return error;
}

/// Shortens the step to the first touch, turn or separation of a compliant contact; regula falsi (Illinois) on the step's length.
bool Stepper::locate_contact_event(World& world, const State& state, double& taken, CompliantContacts::Crossing& crossing) {
  constexpr double kTight = 1e-12;  // [-] of the step
  bool any = false;
  for (int event = 0; event < 8 && compliant_->first_crossing(end_, crossing); ++event) {
    any = true;
    double low = 0, high = taken, f_low = crossing.start, f_high = crossing.end;
    int side = 0;
    for (int k = 0; k < 50 && high - low > kTight * taken; ++k) {
      double middle = f_low < 0 ? (low * f_high - high * f_low) / (f_high - f_low) : 0.5 * (low + high);
      if (!(middle > low && middle < high)) middle = 0.5 * (low + high);
      integrate(world, state, middle);
      const double f = compliant_->crossing_at(end_, crossing);
      if (!std::isfinite(f) || f <= 0) {
        low = middle;
        f_low = std::isfinite(f) ? f : f_low;
        if (side == -1) f_high *= 0.5;
        side = -1;
        if (f > -1e-15 && f <= 0) {
          high = middle;
          break;
        }
      } else {
        high = middle;
        f_high = f;
        if (side == 1) f_low *= 0.5;
        side = 1;
      }
    }
    taken = high;
    integrate(world, state, taken);
    CompliantContacts::Crossing earlier;
    if (!compliant_->first_crossing(end_, earlier) || (earlier.key == crossing.key && earlier.kind == crossing.kind)) break;
  }
  return any;
}

/// Joint resistance and the impulses of all conditions over the step; false when there are none of either. Again, from the smooth
/// motion on, when a joint turned out not to be held by its friction.
bool Stepper::exchange_over_step(World& world, State& state, double h, double& residual) {
  drop_open_rows(world, h);
  if (!world.any_damper && world.constraints.empty()) return false;
  const Meter::Span span(world.meter, Phase::impulses);
  if (world.any_damper) {
    X_smooth_ = X_;
    V_smooth_ = V_;
  }
  for (int pass = 0;; ++pass) {
    factor_for_impulses(world, state, world.any_damper ? &world.dampers : nullptr);
    if (world.any_damper) apply_resistance(world, h);
    for (Constraint& c : world.constraints) c.u_free = row_velocity(c, V_);
    if (pass == 0) form_islands(world);
    set_targets(world, h);
    residual = solve_islands(world, state, h);
    apply(world, h);
    if (!world.any_damper || pass == kMostPasses || !friction_gave_way(world)) return true;
    X_ = X_smooth_;
    V_ = V_smooth_;
  }
}

bool Stepper::friction_gave_way(World& world) const {
  bool any = false;
  for (const Effect* effect : world.plan.active)
    if (effect->gave_way) any = effect->gave_way(world, end_) || any;
  return any;
}

/// A step of at most h from contacts_; halves it until what it leaves at its end is acceptable.
double Stepper::attempt(World& world, State& state, double h) {
  // cut the step where the next impact with restitution happens
  double taken = h;
  locating_ = world.model.settings.locate_events && cuts_ < kMaxCuts;
  if (locating_) taken = std::max(time_to_impact(world, h), 1e-3 * h);
  const bool cut = taken < h;
  if (taken != world.step) assemble_constraints(world, state, taken);
  const bool may_halve = taken > world.model.settings.step / kMostParts;
  prepare_resistance(world, state, taken);
  CompliantContacts::Crossing crossing;
  bool crossed = false;
  if (compliant_) {
    compliant_->begin(world, state, world.model.settings.locate_events);
    if (compliant_->fastest_spring() * taken > kSpringStep)
      taken = std::max(kSpringStep / compliant_->fastest_spring(), h / kMostAdaptiveParts);
  }
  const double error = integrate(world, state, taken);
  if (error > world.model.settings.adaptive_tolerance && taken > world.model.settings.step / kMostAdaptiveParts) {
    ++world.diagnostics.substeps;
    next_step_ = taken * std::clamp(0.9 * std::pow(world.model.settings.adaptive_tolerance / error, 0.2), 0.1, 0.7);
    assemble_constraints(world, state, next_step_);
    return attempt(world, state, next_step_);
  }
  if (compliant_ && world.model.settings.locate_events) crossed = locate_contact_event(world, state, taken, crossing);
  if (taken != world.step) assemble_constraints(world, state, taken);

  double residual = 0;
  const bool impulses = exchange_over_step(world, state, taken, residual);
  const double gap = close_joints(world);
  const int lost = lost_body(end_);

  std::vector<Constraint>& of_step = step_constraints_;
  of_step.swap(world.constraints);
  world.step = world.model.settings.step;
  if (lost < 0) find_contacts(world, end_, end_contacts_);
  world.constraints.swap(of_step);
  world.step = taken;
  if (may_halve && (lost >= 0 || residual > kUnsolved || !acceptable(end_contacts_))) {
    ++world.diagnostics.substeps;
    next_step_ = 0.5 * taken;
    assemble_constraints(world, state, next_step_);
    return attempt(world, state, next_step_);
  }
  if (lost >= 0) {  // the state stays the last that was one
    world.failure = failure_of(world, lost, state.time + taken, kNotANumber);
    return taken;
  }

  cuts_ = cut ? cuts_ + 1 : 0;
  if (cut) ++world.diagnostics.substeps;
  if (next_step_ > 0 && !cut && !crossed) {
    const double tolerance = world.model.settings.adaptive_tolerance;
    const double growth = error > 0 ? std::clamp(0.9 * std::pow(tolerance / error, 0.2), 0.5, 2.0) : 2.0;
    next_step_ = growth * taken < world.model.settings.step ? growth * taken : 0;
  }
  if (impulses) {
    world.diagnostics.max_solver_residual = std::max(world.diagnostics.max_solver_residual, residual);
    keep_impulses(world, state);
    book(world);
    if (world.any_damper) book_resistance(world, taken);
  } else {
    state.warm.clear();
  }
  if (compliant_) compliant_->finish(world, end_, crossed ? &crossing : nullptr, world.constraints);
  if (on_impulses && !world.constraints.empty()) on_impulses(end_.time, taken);
  world.diagnostics.max_joint_gap = std::max(world.diagnostics.max_joint_gap, gap);
  for (const int tree : world.active_trees)
    for (int l = world.topology.trees[tree].begin; l < world.topology.trees[tree].end; ++l) {
      const int b = world.topology.links[l].body;
      state.X_WB[b] = X_[b];
      state.V_WB[b] = V_[b];
    }
  state.time = end_.time;
  contacts_.swap(end_contacts_);
  contact_trees_ = world.active_trees;
  contacts_known_ = true;
  call(world, &Effect::after_step, state);
  return taken;
}

/// Do contacts and limits at the end of a step stand no deeper in each other than the bound, or than at its start?
bool Stepper::acceptable(const std::vector<Constraint>& end) const {
  auto deepest = [](const std::vector<Constraint>& list, ConstraintKind kind) {
    double depth = 0;
    for (const Constraint& c : list)
      if (c.kind == kind && !is_compliant(c)) depth = std::max(depth, -c.gap);
    return depth;
  };
  const double penetrate = std::min(kMayPenetrate, depth_tolerance_);
  return deepest(end, ConstraintKind::contact) < std::max(penetrate, deepest(contacts_, ConstraintKind::contact) + kSlop) &&
         deepest(end, ConstraintKind::limit) < std::max(kMayExceed, deepest(contacts_, ConstraintKind::limit) + kSlop);
}

}  // namespace engine
