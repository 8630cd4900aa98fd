// Joint resistance and the impulses of all conditions over a step: from the smooth motion to its end.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/effects/effect.h"
#include "engine/solver/one_contact.h"
#include "engine/step.h"
#include "engine/step_bounds.h"

namespace engine {
namespace {

constexpr double kLimitSlop = 2e-5;        // [rad]
constexpr double kRecovery = 0.5;          // [-] share of a penetration that a step left taken out in the next
constexpr double kRecoverySpeed = 0.2;     // [m/s] at which a deeper one, there from the start, is taken out
constexpr double kLimitRecoverySpeed = 2;  // [rad/s]
constexpr int kMostPasses = 6;             // through the impulses of one step, while joints are torn loose

}  // namespace

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
  // the smooth motion keeps closed loops; their rows are there for what other impulses ask of them
  const auto of_loop = [](const Constraint& c) { return c.kind == ConstraintKind::bilateral; };
  if (!world.any_damper && std::all_of(world.constraints.begin(), world.constraints.end(), of_loop)) world.constraints.clear();
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
    if (world.any_damper) {
      factor_for_impulses(world, state, &world.dampers);
      apply_resistance(world, h);
    }
    for (Constraint& c : world.constraints) c.u_free = row_velocity(c, V_);
    if (pass == 0) form_islands(world);
    set_targets(world, h);
    residual = solve_islands(world, state, h);
    apply(world, h);
    if (!world.any_damper) return true;
    note_turning(world, &Resistance::w_after);
    if (pass == kMostPasses || !friction_gave_way(world)) return true;
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

/// How the constraints named answer to each other's impulses.
void Stepper::assemble_solver(World& world, const std::vector<int>& members) {
  world.solver.assemble(world.topology, world.impulse, world.constraints, members);
}

void Stepper::factor_for_impulses(World& world, const State& state, const std::vector<JointDamper>* dampers) {
  for (const int tree : world.active_trees) world.impulse.factor(world.topology, tree, state.X_WB, dampers);
}

void Stepper::prepare_resistance(World& world, const State& state, double h) {
  world.any_damper = false;
  world.step = h;
  call(world, &Effect::resist, state);
}

/// How fast the joints that resist turn now.
void Stepper::note_turning(World& world, Vec3 Resistance::*when) const {
  for (const int tree : world.active_trees)
    for (int l = world.topology.trees[tree].begin; l < world.topology.trees[tree].end; ++l) {
      const int j = world.topology.links[l].joint;
      if (j < 0 || !world.dampers[j].present) continue;
      const Joint& joint = world.model.joints[j];
      const Vec3 w_P = joint.parent < 0 ? Vec3(Vec3::Zero()) : V_[joint.parent].w;
      world.resistances[j].*when = V_[joint.child].w - w_P;
    }
}

/// Springs, dampers and dry friction of the joints, linearly implicit: their work goes to the books at once.
void Stepper::apply_resistance(World& world, double h) {
  note_turning(world, &Resistance::w_before);
  const Topology& topology = world.topology;
  for (const int tree : world.active_trees) {
    const Topology::Tree& range = topology.trees[tree];
    for (int l = range.begin; l < range.end; ++l) force_[topology.links[l].body].setZero();
    for (int l = range.begin; l < range.end; ++l) {
      const int j = topology.links[l].joint;
      if (j < 0 || !world.dampers[j].present) continue;
      const Joint& joint = world.model.joints[j];
      const Vec3 twist = world.resistances[j].torque_W * h - world.dampers[j].matrix * world.resistances[j].w_before;
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

namespace {

/// A stop that gives way: torque k depth + c rate, never a pull, damped critically for the two bodies were they free. Returns the
/// share of the step that its impulse displaces over.
double set_damped_spring(Constraint& c, double h) {
  const double k = c.stiffness, inertia = 1 / c.free_response;
  const double damping = c.gap < 0 ? 2 * std::sqrt(k * inertia) : 0;  // nothing brakes before it is reached
  const bool followed = h * h * k < 0.5 * inertia;
  // at the mean of both ends, L = -h (k (gap + h (u_before + u_after) / 4) + damping (u_before + u_after) / 2); a step too long
  // for that: at its end, which is stable however stiff, L = -h (k (gap + h u_after) + damping u_after)
  const double slope = followed ? h * k / 4 + damping / 2 : h * k + damping;
  c.softness = 1 / (h * slope);
  c.target = -k * c.gap / slope - (followed ? c.u_before[0] : 0);
  return followed ? 0.5 : 1;
}

}  // namespace

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
      if (c.kind == ConstraintKind::limit && is_compliant(c)) {
        weight_[i] = set_damped_spring(c, h);
        continue;
      }
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
  unsettled_ = -1;
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
    assemble_solver(world, island);
    const SolveReport report = world.solver.solve(world.constraints, island, world.model.settings.solver_tolerance);
    world.diagnostics.contact_sweeps += report.sweeps;
    world.diagnostics.newton_steps += report.newton_steps;
    if (report.residual > residual) residual = report.residual, unsettled_ = report.worst;
    push_apart(world, island, h);
  }
  return residual;
}

/// What stands inside each other is moved apart at the level of positions, so that it leaves without speed.
void Stepper::push_apart(World& world, const std::vector<int>& island, double h) {
  bool any = false;
  allowed_.clear();
  for (const int i : island) {
    Constraint& c = world.constraints[i];
    c.push = 0;  // an earlier pass pushed against joints that held then
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

namespace {

/// Angular velocity [rad/s] of a free body that impulses turned on from q to `turned`: its angular momentum keeps its direction and
/// its rotation its energy. Left as it was, it would give energy where a spinning body with unequal moments is pushed out of
/// another.
Vec3 carried_on(const Body& body, const Quat& q, const Quat& turned, const Vec3& w) {
  const Vec3 L = q * (body.inertia_B * (q.conjugate() * w));
  const Vec3 w_turned = turned * (body.inertia_B.inverse() * (turned.conjugate() * L));
  const double before = w.dot(L), after = w_turned.dot(L);
  return after > 0 ? Vec3(w_turned * std::sqrt(before / after)) : w;
}

}  // namespace

void Stepper::apply(World& world, double h) {
  // velocities take the whole impulse, displacements its weighted share
  for (const int tree : world.active_trees)
    for (int l = world.topology.trees[tree].begin; l < world.topology.trees[tree].end; ++l) {
      force_[world.topology.links[l].body].setZero();
      displacing_[world.topology.links[l].body].setZero();
    }
  for (std::size_t i = 0; i < world.constraints.size(); ++i) {
    const Constraint& c = world.constraints[i];
    const auto act = [&c](std::vector<Vec6>& on, int row, double amount) {
      if (amount == 0) return;
      if (c.body_a >= 0) on[c.body_a] += c.J_a.row(row).transpose() * amount;
      if (c.body_b >= 0) on[c.body_b] += c.J_b.row(row).transpose() * amount;
    };
    const double share = weight_[i] * h;
    for (int r = 0; r < c.rows; ++r) {
      act(force_, r, c.impulse[r]);
      act(displacing_, r, share * c.impulse[r] + (r == 0 ? c.push : 0));
    }
  }
  for (const int tree : world.active_trees) {
    const Topology::Tree& range = world.topology.trees[tree];
    const bool free = range.end - range.begin == 1 && world.topology.links[range.begin].joint < 0;
    world.impulse.solve(world.topology, tree, force_, result_, Articulation::Bias::zero);
    for (int l = range.begin; l < range.end; ++l) {
      const int b = world.topology.links[l].body;
      V_[b].v += result_[b].head<3>();
      V_[b].w += result_[b].tail<3>();
    }
    world.impulse.solve(world.topology, tree, displacing_, result_, Articulation::Bias::zero);
    for (int l = range.begin; l < range.end; ++l) {
      const int b = world.topology.links[l].body;
      const Quat q = X_[b].q;
      displace(X_[b], result_[b].head<3>(), result_[b].tail<3>());
      if (free) V_[b].w = carried_on(world.model.bodies[b], q, X_[b].q, V_[b].w);
    }
  }
}

void Stepper::keep_impulses(const World& world, State& state) const {
  state.warm.clear();
  for (const Constraint& c : world.constraints) {
    if (c.impulse.squaredNorm() == 0) continue;
    state.warm.push_back({c.key, c.rows == 3 ? Vec3(c.frame * c.impulse) : c.impulse});
  }
  std::sort(state.warm.begin(), state.warm.end(), [](const WarmStart& a, const WarmStart& b) { return a.key < b.key; });
}

/// Work [J] of a condition over the step on the bodies it acts on.
double Stepper::work_of(const World& world, std::size_t i) const {
  const Constraint& c = world.constraints[i];
  // what it displaces the smooth forces' potential gains or loses; the work of compliant contacts in the stages is booked there
  const double displaced = compliant_ && c.kind == ConstraintKind::limit ? 0 : weight_[i];
  const Vec3 mean = 0.5 * (c.u_smooth + c.u_after) - displaced * (c.u_smooth - c.u_before);
  double work = 0;
  for (int r = 0; r < c.rows; ++r) work += c.impulse[r] * mean[r];
  return work;
}

void Stepper::book(World& world) {
  for (std::size_t i = 0; i < world.constraints.size(); ++i) {
    const Constraint& c = world.constraints[i];
    world.dissipated[c.effect] -= work_of(world, i);
    if (is_contact(c) && !is_compliant(c)) world.diagnostics.max_penetration = std::max(world.diagnostics.max_penetration, -c.gap);
    if (c.kind == ConstraintKind::limit && !is_compliant(c))
      world.diagnostics.max_joint_angle_error = std::max(world.diagnostics.max_joint_angle_error, -c.gap);
  }
}

/// Work [J] of a joint's resistance over the step on the two bodies it joins, once the velocities at its end are known.
double Stepper::resistance_work(const World& world, int j, double h) const {
  const Resistance& resistance = world.resistances[j];
  const Vec3 twist = resistance.torque_W * h - world.dampers[j].matrix * resistance.w_after;
  return 0.5 * twist.dot(resistance.w_before + resistance.w_after);
}

void Stepper::book_resistance(World& world, double h) {
  for (const int tree : world.active_trees)
    for (int l = world.topology.trees[tree].begin; l < world.topology.trees[tree].end; ++l) {
      const int j = world.topology.links[l].joint;
      if (j >= 0 && world.dampers[j].present) world.dissipated[world.resistances[j].effect] -= resistance_work(world, j, h);
    }
}

/// The most [J] that the mechanical energy of an island rose over the step beyond what its joints' resistance gave. Rigid contacts
/// and stops give none; but two segments that press on each other near a dead centre of the joints between them (chin and chest)
/// exchange impulses so large that the levers they turn meanwhile matter. Wheels and springs may give energy: of islands that have
/// any it is the work of the rigid contacts and stops that counts.
double Stepper::largest_rise(const World& world, const State& start, double h) {
  const std::size_t count = islands_.size();
  island_rise_.assign(count, 0);
  for (const int tree : world.active_trees) {
    int root = tree;
    while (island_of_tree_[root] != root) root = island_of_tree_[root];
    double& rise = island_rise_[root];
    for (int l = world.topology.trees[tree].begin; l < world.topology.trees[tree].end; ++l) {
      const int b = world.topology.links[l].body, j = world.topology.links[l].joint;
      const Body& body = world.model.bodies[b];
      const Twist &from = start.V_WB[b], &to = V_[b];
      rise += 0.5 * body.mass * (to.v - from.v).dot(to.v + from.v);
      rise -= body.mass * world.model.settings.gravity.dot(X_[b].p - start.X_WB[b].p);
      rise += 0.5 * (to.w.dot(inertia_W(body, X_[b].q) * to.w) - from.w.dot(inertia_W(body, start.X_WB[b].q) * from.w));
      if (world.any_damper && j >= 0 && world.dampers[j].present) rise -= resistance_work(world, j, h);
    }
  }
  double largest = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const bool rigid = std::none_of(islands_[k].begin(), islands_[k].end(), [&](int i) {
      const Constraint& c = world.constraints[i];
      return c.kind == ConstraintKind::wheel || is_compliant(c);
    });
    if (!rigid) {
      island_rise_[k] = 0;
      for (const int i : islands_[k]) {
        const Constraint& c = world.constraints[i];
        const bool hard = (c.kind == ConstraintKind::contact || c.kind == ConstraintKind::limit) && !is_compliant(c);
        if (hard) island_rise_[k] += work_of(world, static_cast<std::size_t>(i));
      }
    }
    if (!islands_[k].empty()) largest = std::max(largest, island_rise_[k]);
  }
  return largest;
}

}  // namespace engine
