#include "engine/step/solve.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "engine/math/disjoint_sets.h"
#include "engine/solver/one_contact.h"
#include "engine/step/formulation.h"
#include "engine/step/islands.h"
#include "engine/step/joint_friction.h"
#include "engine/step/position_correction.h"
#include "engine/step/smooth_motion.h"

namespace engine {
namespace {

constexpr int kMostPasses = 6;  // through the impulses of one step, while joints are torn loose

/// Solves in a row that Newton has not brought near, after one more. From kInVain on an island is solved by sweeps first, until
/// Newton is tried again.
constexpr double kNear = 0.1;  // [-] of the tolerance
constexpr int kInVain = 5, kTriedAgain = 100;
int count_in_vain(int so_far, bool near) {
  if (so_far < kInVain) return near ? 0 : so_far + 1;
  return so_far < kInVain + kTriedAgain ? so_far + 1 : kInVain - 1;
}

/// The impulse of the last step, found by its key and taken into the cone.
void warm_start(Constraint& c, const std::vector<WarmStart>& warm) {
  const auto found =
      std::lower_bound(warm.begin(), warm.end(), c.key, [](const WarmStart& w, std::uint64_t key) { return w.key < key; });
  if (found == warm.end() || found->key != c.key) return;
  if (c.rows == 3) {
    c.impulse = c.frame.transpose() * found->impulse_W;
    if (is_contact(c)) c.impulse = project_to_cone(c.impulse, c.surface.friction);
  } else {
    c.impulse[0] = found->impulse_W[0];
  }
}

/// From the impulses of the last step, or from those the conditions have by an earlier pass.
enum class From { last_step, last_pass };

/// Does a tree of the island have other dampers than in the pass before?
bool is_loosened(const StepContext& s, const std::vector<int>& island) {
  return std::any_of(island.begin(), island.end(), [&s](int i) {
    const auto [a, b] = s.buffers.islands.ends[i];
    return s.buffers.loosened[a] || s.buffers.loosened[b];
  });
}

void solve_island(StepContext& s, int root, From from) {
  World& world = s.world;
  const std::vector<int>& island = s.buffers.islands.members[root];
  if (from == From::last_step)
    for (const int i : island) warm_start(s.constraints[i], s.state.warm);
  world.solver.assemble(world.topology, world.impulse, s.constraints, island,
                        from == From::last_pass ? &s.buffers.loosened : nullptr);
  const auto solve = [&] {
    SolveReport& report = s.buffers.islands.reports[root];
    int& in_vain = s.state.pace.in_vain[root];
    const double tolerance = world.model.settings.solver_tolerance;
    report = world.solver.solve(s.constraints, island, tolerance, in_vain < kInVain ? Begin::newton : Begin::sweeps);
    in_vain = count_in_vain(in_vain, report.residual < kNear * tolerance);
    world.log.diagnostics.contact_sweeps += report.sweeps;
    world.log.diagnostics.newton_steps += report.newton_steps;
  };
  solve();
  if (wake_struck_springs(s, root)) solve();
  if (hold_spent_springs(s, root)) solve();
  correct_positions(s, island);
}

void solve_islands(StepContext& s, From from) {
  s.residual = 0;
  s.unsettled = -1;
  for (const int root : s.buffers.islands.roots) {
    if (is_loosened(s, s.buffers.islands.members[root])) solve_island(s, root, from);
    const SolveReport& report = s.buffers.islands.reports[root];
    if (report.residual > s.residual) s.residual = report.residual, s.unsettled = report.worst;
  }
}

/// Angular velocity [rad/s] of a free body that impulses turned on from q to `turned`: its angular momentum keeps its direction and
/// its rotation its energy. Left as it was, it would give energy where a spinning body with unequal moments is pushed out of
/// another.
Vec3 carried_on(const Body& body, const Quat& q, const Quat& turned, const Vec3& w) {
  const Vec3 L = q * (body.inertia_B * (q.conjugate() * w));
  const Vec3 w_turned = turned * (body.inertia_B.inverse() * (turned.conjugate() * L));
  const double before = w.dot(L), after = w_turned.dot(L);
  return after > 0 ? Vec3(w_turned * std::sqrt(before / after)) : w;
}

/// Of a tree in a squeezed island, before the impulses displace it: what the smooth motion gained in speed displaces by its whole,
/// as impulses do there. Else friction and joints that hold still at the end of the step are moved by half of it, against the pull:
/// a person slid off a heap at 1.6 cm/s at 2 ms.
void move_to_end(StepContext& s, int tree) {
  const Topology::Tree& range = s.world.topology.trees[tree];
  for (int l = range.begin; l < range.end; ++l) {
    const int b = s.world.topology.links[l].body;
    const Twist &now = s.end.V_WB[b], &then = s.state.V_WB[b];
    const Vec3 by = 0.5 * s.length * (now.v - then.v);
    displace(s.end.X_WB[b], by, 0.5 * s.length * (now.w - then.w));
    s.buffers.islands.moved[tree] -= s.world.model.bodies[b].mass * s.world.model.settings.gravity.dot(by);
  }
}

constexpr double kNoShare = -1, kSeveralShares = -2;

/// J^T L of all conditions: velocities take the whole impulse, displacements its weighted share. Notes by tree which share all of
/// its impulses have.
void gather_impulses(StepContext& s) {
  std::vector<Vec6>&force = s.buffers.force, &displacing = s.buffers.displacing;
  s.buffers.share.assign(s.world.topology.trees.size(), kNoShare);
  const auto note = [&s](int body, double share) {
    if (body < 0) return;
    double& known = s.buffers.share[s.world.topology.tree_of_body[body]];
    known = known == kNoShare || known == share ? share : kSeveralShares;
  };
  for_awake_bodies(s.world, [&](int b) {
    force[b].setZero();
    displacing[b].setZero();
  });
  for (std::size_t i = 0; i < s.constraints.size(); ++i) {
    const Constraint& c = s.constraints[i];
    const auto act = [&c](std::vector<Vec6>& on, int row, double amount) {
      if (amount == 0) return;
      if (c.a.body >= 0) on[c.a.body] += c.a.J.row(row).transpose() * amount;
      if (c.b.body >= 0) on[c.b.body] += c.b.J.row(row).transpose() * amount;
    };
    const double share = s.buffers.weight[i] * s.length;
    if (c.push != 0 || c.impulse != Vec3::Zero())
      for (const int body : {c.a.body, c.b.body}) note(body, c.push != 0 ? kSeveralShares : share);
    for (int r = 0; r < c.rows; ++r) {
      act(force, r, c.impulse[r]);
      act(displacing, r, share * c.impulse[r] + (r == 0 ? c.push : 0));
    }
  }
}

/// V+ = V' + K^-1 J^T L, and the displacement that goes with it.
void apply(StepContext& s) {
  gather_impulses(s);
  const Topology& topology = s.world.topology;
  std::vector<Pose>& X = s.end.X_WB;
  std::vector<Twist>& V = s.end.V_WB;
  std::vector<Vec6>& result = s.buffers.result;
  for (const int tree : s.world.active_trees) {
    const double share = s.buffers.share[tree];
    if (share == kNoShare) continue;
    const Topology::Tree& range = topology.trees[tree];
    const bool free = range.end - range.begin == 1 && topology.links[range.begin].joint < 0;
    if (s.buffers.islands.to_end[math::representative(s.buffers.islands.of_tree, tree)]) move_to_end(s, tree);
    s.world.impulse.solve(topology, tree, s.buffers.force, result, Articulation::Bias::zero);
    for (int l = range.begin; l < range.end; ++l) {
      const int b = topology.links[l].body;
      V[b].v += result[b].head<3>();
      V[b].w += result[b].tail<3>();
    }
    if (share == kSeveralShares) {
      s.world.impulse.solve(topology, tree, s.buffers.displacing, result, Articulation::Bias::zero);
    } else {
      for (int l = range.begin; l < range.end; ++l) result[topology.links[l].body] *= share;
    }
    for (int l = range.begin; l < range.end; ++l) {
      const int b = topology.links[l].body;
      const Quat q = X[b].q;
      displace(X[b], result[b].head<3>(), result[b].tail<3>());
      if (free) V[b].w = carried_on(s.world.model.bodies[b], q, X[b].q, V[b].w);
    }
  }
}

/// With the joints' dampers; of trees whose own have not changed since the last pass the factors stand.
void factor_with_dampers(StepContext& s) {
  for (const int tree : s.world.active_trees)
    if (s.buffers.loosened[tree]) s.world.impulse.factor(s.world.topology, tree, s.state.X_WB, &s.buffers.dampers);
}

}  // namespace

void factor_for_impulses(StepContext& s) {
  for (const int tree : s.world.active_trees) s.world.impulse.factor_unless_known(s.world.topology, tree, s.state.X_WB);
}

void exchange_over_step(StepContext& s) {
  drop_open_conditions(s);
  if (!s.any_damper && s.constraints.empty()) return;
  s.impulses = true;
  const Meter::Span span(s.world.meter, Phase::impulses);
  Motion& smooth = s.buffers.smooth;
  smooth = s.end;
  s.buffers.loosened.assign(s.world.topology.trees.size(), 1);
  for (int pass = 0;; ++pass) {
    if (s.any_damper) {
      factor_with_dampers(s);
      apply_resistance(s);
    }
    for (Constraint& c : s.constraints) c.u.free = row_velocity(c, s.end.V_WB);
    if (pass == 0) {
      build_islands(s);
      s.buffers.shown.assign(s.constraints.size(), {});
    }
    formulate(s);
    solve_islands(s, pass == 0 ? From::last_step : From::last_pass);
    apply(s);
    if (!s.any_damper) return;
    note_motion_after(s);
    if (pass == kMostPasses || !friction_gave_way(s)) return;
    s.end = smooth;
  }
}

void close_joints(StepContext& s) {
  const Meter::Span span(s.world.meter, Phase::joint_projection);
  s.joint_gap = project_joints(s.world, s.end.X_WB, s.end.V_WB, s.buffers.force, s.buffers.result, true);
}

void keep_impulses(StepContext& s) {
  std::vector<WarmStart>& warm = s.state.warm;
  warm.clear();
  for (const Constraint& c : s.constraints) {
    if (c.impulse.squaredNorm() == 0) continue;
    warm.push_back({c.key, c.rows == 3 ? Vec3(c.frame * c.impulse) : c.impulse});
  }
  std::sort(warm.begin(), warm.end(), [](const WarmStart& a, const WarmStart& b) { return a.key < b.key; });
}

}  // namespace engine
