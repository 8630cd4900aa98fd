#include "engine/step/integration.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/math/roots.h"
#include "engine/step/bounds.h"
#include "engine/step/step_control.h"

namespace engine {
namespace {

constexpr double kCarried = 0.02;  // [s] over which an error of speed counts as one of place: a bounce is short, its speed lasts

}  // namespace

Integration::Integration(World& world, StepBuffers& buffers) : smooth(world.model), world_(world), buffers_(buffers) {
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

Stages Integration::stages(const StepContext& s, const StepControl& control) {
  if (world_.model.settings.scheme != Scheme::stepping || !control.bears_two_stages(s.length, smooth.fastest_swing()))
    return Stages::four;
  const Topology& topology = world_.topology;
  touched_.assign(topology.trees.size(), 0);
  for (const Constraint& c : s.constraints) {
    if (!is_contact(c) || c.gap + s.length * std::min(0.0, c.u.before[0]) > 0) continue;
    for (const int b : {c.a.body, c.b.body})
      if (b >= 0) touched_[static_cast<std::size_t>(topology.tree_of_body[b])] = 1;
  }
  // a body by itself takes little time
  const auto has_joints = [&topology](int tree) { return topology.links[topology.trees[tree].begin].joint >= 0; };
  bool any = false;
  for (const int tree : world_.active_trees) {
    if (!has_joints(tree)) continue;
    if (!touched_[static_cast<std::size_t>(tree)]) return Stages::four;
    any = true;
  }
  return any ? Stages::two : Stages::four;
}

double Integration::advance(const State& state, const StepControl& control, double length, Stages stages) {
  const Meter::Span span(world_.meter, Phase::integration);
  Motion& end = buffers_.end;
  CompliantContacts* contacts = compliant ? &*compliant : nullptr;
  const int parts = control.parts(length, smooth.fastest_swing());
  FirstStage first{};
  auto begin = [&] {
    const bool all = std::exchange(copied_, world_.still.changes) != world_.still.changes;
    copy_moving(world_, state.X_WB, end.X_WB, all);
    copy_moving(world_, state.V_WB, end.V_WB, all);
    end.time = state.time + length;
    first = FirstStage::where_it_begins;
    if (!world_.topology.loops.empty()) world_.loops.forget();
    if (contacts) contacts->restart(length);
  };
  auto advance_over = [&](double way) {
    if (contacts) contacts->next_part(way / parts);
    for (int k = 0; k < parts; ++k)
      smooth.advance(world_, end, way / parts, end.X_WB, end.V_WB, stages, contacts, std::exchange(first, FirstStage::within_step));
  };
  begin();
  advance_over(length);
  if (world_.model.settings.scheme != Scheme::adaptive) return 0;
  buffers_.whole = end;
  begin();
  advance_over(0.5 * length);
  advance_over(0.5 * length);
  return difference();
}

bool Integration::locate_contact_event(const State& state, const StepControl& control, double& length) {
  constexpr double kTight = 1e-12;  // [-] of the step
  bool any = false;
  for (int event = 0; event < 8 && compliant->first_crossing(buffers_.end, crossing); ++event) {
    any = true;
    const auto crossed = [&](double part) {
      advance(state, control, part, Stages::four);
      return compliant->crossing_at(buffers_.end, crossing);
    };
    const auto met = [](double f) { return f > -1e-15 && f <= 0; };
    length = math::illinois({0, length}, crossing.start, crossing.end, 50, kTight * length, crossed, met).high;
    advance(state, control, length, Stages::four);
    CompliantContacts::Crossing earlier;
    if (!compliant->first_crossing(buffers_.end, earlier) || (earlier.key == crossing.key && earlier.kind == crossing.kind)) break;
  }
  return any;
}

}  // namespace engine
