#include "engine/step/integration.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Eigenvalues>

#include "engine/math/roots.h"
#include "engine/step/bounds.h"

namespace engine {
namespace {

constexpr double kCarried = 0.02;  // [s] over which an error of speed counts as one of place: a bounce is short, its speed lasts

}  // namespace

double fastest_turning(const World& world, std::span<const int> trees, const Motion& at) {
  double fastest = 0;
  for_bodies_of(world, trees, [&](int b) { fastest = std::max(fastest, at.V_WB[b].w.squaredNorm()); });
  return std::sqrt(fastest);
}

Integration::Integration(World& world, StepBuffers& buffers) : world_(world), buffers_(buffers), smooth_(world.model) {
  for (const Body& body : world.model.bodies)
    middle_inertia_.push_back(Eigen::SelfAdjointEigenSolver<Mat3>(body.inertia_B, Eigen::EigenvaluesOnly).eigenvalues()[1]);
  if (contacts_in_stages(world.model.settings)) compliant.emplace(world);
}

/// Of the step taken whole from the one in halves, as a way [m] of the body that has most of it.
double Integration::difference() const {
  const Motion &halves = buffers_.end, &whole = buffers_.whole;
  double most = 0;
  for_awake_bodies(world_, [&](int b) {
    const double turn = 2 * (halves.X_WB[b].q.coeffs() - whole.X_WB[b].q.coeffs()).norm();
    const double place = (halves.X_WB[b].p - whole.X_WB[b].p).norm() + world_.reach[b] * turn;
    const double speed =
        (halves.V_WB[b].v - whole.V_WB[b].v).norm() + world_.reach[b] * (halves.V_WB[b].w - whole.V_WB[b].w).norm();
    most = std::max(most, std::max(place, kCarried * speed) / 15);
  });
  return most;
}

void Integration::note_touched(const StepContext& s) {
  const Topology& topology = world_.topology;
  touched_.assign(topology.trees.size(), 0);
  for (const Constraint& c : s.constraints) {
    const bool closes = c.kind == ConstraintKind::wheel || (is_contact(c) && c.gap + s.length * std::min(0.0, c.u.before[0]) <= 0);
    if (!closes) continue;
    for (const int b : {c.a.body, c.b.body})
      if (b >= 0) touched_[static_cast<std::size_t>(topology.tree_of_body[b])] = 1;
  }
}

/// How fast axes turn [rad/s], of the body where they do so fastest: L over the middle principal moment of inertia. A slim limb
/// that spins about its length has hardly any, a disc twice its spin, a ball its spin.
double Integration::fastest_precession(std::span<const int> trees, const Motion& at) const {
  double fastest = 0;
  for_bodies_of(world_, trees, [&](int b) {
    const Vec3 w_B = at.X_WB[b].q.conjugate() * at.V_WB[b].w;
    fastest = std::max(fastest, (world_.model.bodies[b].inertia_B * w_B).norm() / middle_inertia_[static_cast<std::size_t>(b)]);
  });
  return fastest;
}

Integration::Pace Integration::pace(std::span<const int> trees, const State& state, double length) const {
  constexpr double kTurn = 0.1;  // [rad] of any body in a part
  // Verlet turns a body about a fixed axis to the fifth order of its turn. It bears a swing of 2, and is off by a twelfth of the
  // square of that or of the precession. The swing is the fastest of all trees
  constexpr double kPrecessionByTwo = 0.05, kSwingByTwo = 0.5;  // [rad], [-]
  const auto whole = [](double parts) { return static_cast<int>(std::clamp(std::ceil(parts), 1.0, kMostParts)); };
  const double turn = fastest_turning(world_, trees, state) * length, swings = state.pace.swing.rate * length;
  // the error a second of turning leaves goes with w (w h)^4: parts in number with w^(5/4) would keep it what it is at the bound
  const Pace by_four{whole(std::max(turn / kTurn * (turn / kTurn), swings / kSmoothSwing)), Stages::four};
  const auto touched = [this](int tree) { return touched_[static_cast<std::size_t>(tree)] != 0; };
  if (world_.plan.integrated_by != Scheme::stepping || !std::all_of(trees.begin(), trees.end(), touched)) return by_four;
  const double precession =
      2 * turn < kPrecessionByTwo ? turn : fastest_precession(trees, state) * length;  // at most twice the turn
  const Pace by_two{whole(std::max(precession / kPrecessionByTwo, swings / kSwingByTwo)), Stages::two};
  return by_two.parts <= 2 * by_four.parts ? by_two : by_four;
}

/// A way of the step, from StepBuffers::end.
void Integration::advance_over(const State& state, double way, double length, FirstStage first) {
  CompliantContacts* contacts = compliant ? &*compliant : nullptr;
  swing = {};
  const auto advance_trees = [&](std::span<const int> trees, bool looped) {
    const Pace pace = this->pace(trees, state, length);
    if (contacts) contacts->next_part(way / pace.parts);
    Swing fastest;
    FirstStage stage = first;
    for (int k = 0; k < pace.parts; ++k)
      fastest = smooth_.advance(world_, trees, looped, buffers_.end, way / pace.parts, pace.stages, contacts,
                                std::exchange(stage, FirstStage::within_step));
    if (fastest.rate > swing.rate) swing = fastest;
  };
  if (world_.plan.integrated_by == Scheme::stepping)
    for_joined_trees(world_, advance_trees);
  else
    advance_trees(world_.active_trees, world_.loops.any());
}

double Integration::advance(const State& state, double length) {
  const Meter::Span span(world_.meter, Phase::integration);
  Motion& end = buffers_.end;
  const auto begin = [&] {
    const bool all = std::exchange(copied_, world_.still.changes) != world_.still.changes;
    copy_moving(world_, state.X_WB, end.X_WB, all);
    copy_moving(world_, state.V_WB, end.V_WB, all);
    end.time = state.time + length;
    smooth_.take_over(world_, state);
    if (!world_.topology.loops.empty()) world_.loops.forget();
    if (compliant) compliant->restart(length);
  };
  begin();
  advance_over(state, length, length, FirstStage::where_it_begins);
  if (world_.model.settings.scheme != Scheme::adaptive) return 0;
  buffers_.whole = end;
  begin();
  advance_over(state, 0.5 * length, length, FirstStage::where_it_begins);
  advance_over(state, 0.5 * length, length, FirstStage::within_step);
  return difference();
}

bool Integration::locate_contact_event(const State& state, double& length) {
  constexpr double kTight = 1e-12;  // [-] of the step
  bool any = false;
  for (int event = 0; event < 8 && compliant->first_crossing(buffers_.end, crossing); ++event) {
    any = true;
    const auto crossed = [&](double part) {
      advance(state, part);
      return compliant->crossing_at(buffers_.end, crossing);
    };
    const auto met = [](double f) { return f > -1e-15 && f <= 0; };
    length = math::illinois({0, length}, crossing.start, crossing.end, 50, kTight * length, crossed, met).high;
    advance(state, length);
    CompliantContacts::Crossing earlier;
    if (!compliant->first_crossing(buffers_.end, earlier) || (earlier.key == crossing.key && earlier.kind == crossing.kind)) break;
  }
  return any;
}

}  // namespace engine
