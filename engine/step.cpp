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
//     penetration there; if that is more than a bound, or if rigid contacts gave energy, the step is taken again at half its length
#include "engine/step.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "engine/divergence.h"
#include "engine/effects/effect.h"
#include "engine/effects/effects.h"
#include "engine/math/functions.h"
#include "engine/step_bounds.h"

namespace engine {
namespace {

constexpr int kMaxCuts = 8;           // of one step; then impulses act where the bodies are
constexpr double kUnsolved = 2;       // [-] residual over the tolerance above which the step is halved and taken again
constexpr double kSmoothTurn = 0.1;   // [rad] of any body in one step of the smooth motion
constexpr double kSmoothSwing = 2.0;  // [-] rate of a swing under joint forces times the step: RK4 bears 2.8
constexpr double kLargestTurn = 0.3;  // [rad] in one step of all
constexpr double kMostParts = 20;     // of the smooth motion in one step, and of a step by turning and halving
// Of a step by swings, the tolerance of scheme adaptive, events. A taut chain wants 9 at a mass ratio of 2000 and 2 ms; a thousand
// are a ratio of 1e8 at 1 ms, where the joint equations keep half of their digits. No part of an accident is like that.
constexpr double kMostPartsOfAll = 1000;
// Of a step by a contact's spring: a bounce passes in ten of them, what rests on its spring takes them all. A kilogramme on 100
// GN/m, harder than anything, wants 2100 at 2 ms.
constexpr double kMostSpringParts = 5000;
constexpr const char* kSwingsTooFast =
    "it swings so fast under the forces in its joint that a step would be more than 1000 parts; more mass, fixing it or a smaller "
    "step may help";
constexpr const char* kSpringsTooFast =
    "the spring of its contact is so fast that a step would be more than 5000 parts; more mass, a lower stiffness or a smaller "
    "step may help";
constexpr double kCarried = 0.02;    // [s] over which an error of speed counts as one of place: a bounce is short, its speed lasts
constexpr double kSpringStep = 0.3;  // [rad] of a compliant contact's spring in one step: it keeps its energy to 1e-5

}  // namespace

Stepper::Stepper(World& world)
    : smooth_(world.model), force_(world.model.bodies.size(), Vec6::Zero()), displacing_(force_), result_(force_) {
  reserve(world);
  const Settings& settings = world.model.settings;
  if (settings.scheme == Scheme::adaptive) depth_tolerance_ = std::max(10 * settings.adaptive_tolerance, 2 * kSlop);
  if (settings.contact_law != ContactLaw::compliant || settings.scheme == Scheme::stepping) return;
  compliant_.emplace(world.model, [&world](const State& state, double within, std::vector<Constraint>& found) {
    if (lost_body(state) >= 0) return;  // a stage gone astray: the end of its step will tell
    world.constraints.swap(found);
    const double step = world.step;
    world.step = within;
    world.nearness.look(world, state);
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
  X_smooth_.resize(world.model.bodies.size());
  V_smooth_.resize(world.model.bodies.size());
  islands_.resize(trees);
  for (auto& island : islands_) island.reserve(kRoom);
  island_has_impact_.reserve(trees);
  island_rise_.reserve(trees);
  island_of_tree_.reserve(trees);
  contact_trees_.reserve(trees);
  members_.reserve(kRoom);
  end_.warm.reserve(kRoom);
}

/// What stands inside something else before anything has moved.
void Stepper::warn_of_overlaps(World& world) const {
  for (const Constraint& c : contacts_)
    if (c.kind == ConstraintKind::contact && !is_compliant(c)) warn_of_overlap(world, c.record_a, c.record_b, c.gap);
}

void Stepper::choose_trees(World& world, const State& state) {
  world.active_trees.clear();
  for (int tree = 0; tree < static_cast<int>(world.topology.trees.size()); ++tree) {
    const int person = world.topology.trees[tree].person;
    const bool waits = person >= 0 && !state.released[person];
    const bool asleep = waits || (!world.sleep.asleep.empty() && world.sleep.asleep[tree]);
    const auto& range = world.topology.trees[tree];
    for (int l = range.begin; l < range.end; ++l) world.awake[world.topology.links[l].body] = static_cast<char>(!asleep);
    if (!asleep) world.active_trees.push_back(tree);
  }
  if (!world.topology.loops.empty()) world.loops.choose(world.topology, state.broken, world.awake);
}

void Stepper::find_contacts(World& world, const State& state, std::vector<Constraint>& found) {
  world.constraints.clear();
  if (!compliant_) world.nearness.look(world, state);
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
  if (h == world.model.settings.step) events_ = 0;
  choose_trees(world, state);
  turning_ = fastest_turning(world, state);
  if (turning_ * h > kLargestTurn) {
    ++world.diagnostics.substeps;
    h = std::min(h, std::max(kLargestTurn / turning_, world.model.settings.step / kMostParts));
  }
  if (const double swing = smooth_.fastest_swing() * h / kSmoothSwing; swing > 1) {
    ++world.diagnostics.substeps;
    h /= std::max(1.0, swing / kMostParts);
  }
  if (next_step_ > 0) h = std::min(h, next_step_);
  const double sliver = kSliver * world.model.settings.step, ahead = world.next_instant - state.time;
  if (ahead > sliver && ahead < h - sliver) h = ahead;
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
  const double for_turning = turning_ * h / kSmoothTurn * (turning_ * h / kSmoothTurn);
  const double wanted = std::max(for_turning, smooth_.fastest_swing() / kSmoothSwing * h);
  const int parts = static_cast<int>(std::clamp(std::ceil(wanted), 1.0, kMostParts));
  FirstStage first;  // stands where impulses act
  auto advance_over = [&](double length) {
    if (compliant) compliant->next_part(length / parts);
    for (int k = 0; k < parts; ++k) smooth_.advance(world, end_, length / parts, X_, V_, compliant, std::exchange(first, {}));
  };
  auto begin = [&](bool factored) {
    end_ = state;
    end_.time = state.time + h;
    world.time = state.time;
    first = {&world.impulse, factored};
    world.loops.forget();
    if (compliant) compliant->restart(h);
  };
  begin(false);
  advance_over(h);
  if (world.model.settings.scheme != Scheme::adaptive) return 0;
  X_whole_ = X_;
  V_whole_ = V_;
  begin(true);
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

/// Ends the run for what a step of any length worth taking could not follow; the state stays the last that was followed.
double Stepper::stop(World& world, const State& state, int body, const char* effect, const char* message) {
  world.failure = Failure{state.time, world.model.bodies[body].name, effect, message};
  return 0;
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
  const double shortest = world.model.settings.step / kMostPartsOfAll;
  CompliantContacts::Crossing crossing;
  bool crossed = false;
  if (compliant_) {
    compliant_->begin(world, state, world.model.settings.locate_events);
    const double spring = compliant_->fastest_spring();
    if (spring * world.model.settings.step > kMostSpringParts * kSpringStep)
      return stop(world, state, compliant_->sprung_body(), world.plan.active[compliant_->sprung_by()]->name, kSpringsTooFast);
    if (spring * taken > kSpringStep) taken = kSpringStep / spring;
  }
  const double error = integrate(world, state, taken);
  if (smooth_.fastest_swing() * shortest > kSmoothSwing)
    return stop(world, state, smooth_.swinging_body(), kJointsEffect.name, kSwingsTooFast);
  if (error > world.model.settings.adaptive_tolerance && taken > shortest) {
    ++world.diagnostics.substeps;
    const double share = std::clamp(0.9 * math::pow(world.model.settings.adaptive_tolerance / error, 0.2), 0.1, 0.7);
    next_step_ = std::max(share * taken, shortest);
    assemble_constraints(world, state, next_step_);
    return attempt(world, state, next_step_);
  }
  if (compliant_ && world.model.settings.locate_events && events_ < kMostPartsOfAll)
    crossed = locate_contact_event(world, state, taken, crossing);
  if (taken != world.step) assemble_constraints(world, state, taken);

  prepare_resistance(world, state, taken);  // only now is the step's length known
  double residual = 0;
  const bool impulses = exchange_over_step(world, state, taken, residual);
  const double gap = close_joints(world);
  const int lost = lost_body(end_);
  const bool gained = impulses && lost < 0 && may_halve && largest_rise(world, state, taken) > kMayRise;

  std::vector<Constraint>& of_step = step_constraints_;
  of_step.swap(world.constraints);
  world.step = world.model.settings.step;
  if (lost < 0) find_contacts(world, end_, end_contacts_);
  world.constraints.swap(of_step);
  world.step = taken;
  if (may_halve &&
      (lost >= 0 || gained || residual > kUnsolved * world.model.settings.solver_tolerance || !acceptable(end_contacts_))) {
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
  if (crossed) ++events_;
  if (cut) ++world.diagnostics.substeps;
  if (next_step_ > 0 && !cut && !crossed) {
    const double tolerance = world.model.settings.adaptive_tolerance;
    const double growth = error > 0 ? std::clamp(0.9 * math::pow(tolerance / error, 0.2), 0.5, 2.0) : 2.0;
    next_step_ = growth * taken < world.model.settings.step ? std::max(growth * taken, shortest) : 0;
  }
  if (impulses) {
    world.diagnostics.max_solver_residual = std::max(world.diagnostics.max_solver_residual, residual);
    if (unsettled_ >= 0) world.unsettled.note(residual, end_.time, world.constraints[unsettled_]);
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
