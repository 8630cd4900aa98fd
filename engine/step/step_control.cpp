#include "engine/step/step_control.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/divergence.h"
#include "engine/effects/effect.h"
#include "engine/math/functions.h"
#include "engine/step/bounds.h"
#include "engine/step/energy_ledger.h"
#include "engine/step/impact.h"
#include "engine/step/slip_end.h"

namespace engine {
namespace {

constexpr double kUnsolved = 2;                // [-] residual over the tolerance above which the step is halved and taken again
constexpr double kBearable = 10 * kMayMislay;  // [J] mislaid where each half of the step has something else wrong
constexpr double kLargestTurn = 0.3;           // [rad] in one step of all
// Of a step by halving: a foot under a wheel, at its stop and on the road at once, comes out where a step moves it less.
constexpr double kMostHalvedParts = 200;
// Of a step by swings, the tolerance of scheme adaptive, events. A taut chain wants 9 at a mass ratio of 2000 and 2 ms; a thousand
// are a ratio of 1e8 at 1 ms, where the joint equations keep half of their digits. No part of an accident is like that.
constexpr double kMostPartsOfAll = 1000;
// Of a step by a contact's spring: a bounce passes in ten of them, what rests on its spring takes them all. A kilogramme on 100
// GN/m, harder than anything, wants 2100 at 2 ms.
constexpr double kMostSpringParts = 5000;
constexpr double kSpringStep = 0.3;  // [rad] of a compliant contact's spring in one step: it keeps its energy to 1e-5
constexpr const char* kSwingsTooFast =
    "it swings so fast under the forces in its joint that a step would be more than 1000 parts; more mass, fixing it or a smaller "
    "step may help";
constexpr const char* kSpringsTooFast =
    "the spring of its contact is so fast that a step would be more than 5000 parts; more mass, a lower stiffness or a smaller "
    "step may help";

/// Head injury criterion [s] of a pulse of half a swing at `rate` [rad/s] whose peak is `peak` [m/s^2].
double criterion_of_pulse(double peak, double rate) {
  constexpr double kShape = 0.41465;  // [-] at the best window, two thirds of the pulse
  return kShape * math::pow(peak / kGravity, 2.5) * std::numbers::pi / rate;
}

/// Longest part [s] of the `length` [s] left of a `step` [s] that follows a pulse on a spring that swings at `rate` [rad/s]. The
/// way to a touch is one. The way to where the pulse turns is in equal parts: there a spring that gives little back lets go at
/// once, and a part that went beyond would blur the largest force.
double part_of_pulse(const Constraint& c, double closing, double force, double rate, double length, double step) {
  constexpr double kTurn = 0.07;  // [rad] of the spring: a criterion is then within 2 % of its limit, as a rule
  constexpr double kLeast = 0.3;  // [-] of that, where the turn is nearer
  const double part = std::clamp(kTurn / rate, step / kMostParts, step);
  if (c.gap > 0) return std::max(part, c.gap / closing);
  double way = length;
  if (closing > 0) way = std::min(way, std::max(kLeast * part, math::atan2(closing, force / c.spring.stiffness * rate) / rate));
  return way / std::ceil(way / part);
}

/// Longest step [s] that follows the blows on heads that yield: pulses of a few milliseconds, whose peak the criteria raise to the
/// power of 2.5. Where a pulse turns it has no speed: steps go on short, and grow from there under what only presses, or comes out
/// far more slowly than the spring would throw it. A press that never was a blow divides none, nor does a pressed head while
/// another is struck.
double longest_for_heads(const World& world, State& state, double length) {
  constexpr double kCriterion = 100;  // [s] a blow from here on
  constexpr double kPressed = 1000;   // [N] and it goes on from here on
  constexpr double kGoesIn = 0.05;    // [m/s] and so a blow goes on: at its deepest a pulse may end at once
  constexpr double kComesOut = 0.3;   // [m/s], [-] and of the speed that goes with the depth in a free swing
  constexpr double kGrowth = 2;       // [-] from step to step
  const Model& model = world.model;
  const double step = model.settings.step;
  std::vector<HeadPace>& heads = state.pace.heads;
  for (HeadPace& head : heads) head.next = std::numeric_limits<double>::infinity();
  const auto is_head = [&model](int b) { return is_part(model, b) && model.persons[model.bodies[b].person].head == b; };
  for (const Constraint& c : state.contacts.list) {
    if (!is_contact(c) || !is_compliant(c) || !(is_head(c.a.record) || is_head(c.b.record))) continue;
    const double closing = -row_velocity(c, state.V_WB)[0];
    const double force = std::min(-c.gap * c.spring.stiffness, c.spring.yield);
    const bool meets = closing > 0 && c.gap < closing * length;
    if (!meets && force <= kPressed) continue;
    const double stiffness = c.spring.reached < 1 ? c.spring.loading : c.spring.stiffness;
    const double rate = std::sqrt(stiffness * c.response.free);
    const double thrown = kComesOut * std::max(1.0, force / c.spring.stiffness * rate);
    for (const int b : {c.a.record, c.b.record}) {
      if (!is_head(b)) continue;
      HeadPace& head = heads[static_cast<std::size_t>(model.bodies[b].person)];
      const double peak = closing * rate / (c.response.free * model.bodies[b].mass);
      const bool strikes = meets && criterion_of_pulse(peak, rate) > kCriterion;
      if (strikes) head.until = std::max(head.until, state.time + std::numbers::pi / rate);
      const bool struck = state.time < head.until;
      if (strikes || (struck && (closing > kGoesIn || -closing > thrown)))
        head.next = std::min(head.next, part_of_pulse(c, closing, force, rate, length, step));
      else if (struck && kGrowth * head.last < step)
        head.next = std::min(head.next, kGrowth * head.last);
    }
  }
  double longest = std::numeric_limits<double>::infinity();
  for (HeadPace& head : heads) {
    longest = std::min(longest, head.next);
    head.last = head.next;
    if (std::isinf(head.next)) head.until = 0;  // the blow is over
  }
  return longest;
}

/// What is bounded by itself: two vehicles may stand centimetres in each other, which is no leave for a limb to.
enum class Bounded { vehicles, surfaces, turns };

Bounded bounded_as(const Constraint& c) {
  if (is_angular_limit(c)) return Bounded::turns;
  return is_contact(c) && c.shapes.between_vehicles() ? Bounded::vehicles : Bounded::surfaces;
}

/// Penetration [m] of rigid contacts and stops of slides, or [rad] of stops of turns.
double deepest(const std::vector<Constraint>& list, Bounded what) {
  double depth = 0;
  for (const Constraint& c : list)
    if ((is_contact(c) || c.kind == ConstraintKind::limit) && bounded_as(c) == what && !is_compliant(c))
      depth = std::max(depth, -c.gap);
  return depth;
}

/// Do contacts and limits at the end of a step stand no deeper in each other than the bound, or than at its start?
bool acceptable(const std::vector<Constraint>& start, const std::vector<Constraint>& end, double tolerance) {
  const double penetrate = std::min(kMayPenetrate, tolerance);
  const auto holds = [&](Bounded what, double bound) {
    const double depth = deepest(end, what);
    return depth < bound || depth < deepest(start, what) + kSlop;
  };
  return holds(Bounded::vehicles, penetrate) && holds(Bounded::surfaces, penetrate) && holds(Bounded::turns, kMayExceed);
}

}  // namespace

StepControl::StepControl(World& world, State& state, double most)
    : world_(world),
      state_(state),
      settings_(world.model.settings),
      shortest_(settings_.step / kMostPartsOfAll),
      depth_tolerance_(settings_.scheme == Scheme::adaptive ? std::max(10 * settings_.adaptive_tolerance, 2 * kSlop) : 1),
      length_(most) {
  if (most == settings_.step) state.pace.events = 0;
  // joint rows and contact points change by the angle turned, to second order of which a step is blind: a light limb flung at 300
  // rad/s gets its steps divided, the rest of the run keeps its own
  if (const double turning = fastest_turning(world, world.active_trees, state); turning * length_ > kLargestTurn) {
    ++world.log.diagnostics.substeps;
    length_ = std::min(length_, std::max(kLargestTurn / turning, settings_.step / kMostParts));
  }
  if (const double swing = state.pace.swing.rate * length_ / kSmoothSwing; swing > 1) {
    ++world.log.diagnostics.substeps;
    length_ /= std::max(1.0, swing / kMostParts);
  }
  if (state.pace.next > 0) length_ = std::min(length_, state.pace.next);
  const double sliver = kSliver * settings_.step, ahead = state.pace.next_instant - state.time;
  if (ahead > sliver && ahead < length_ - sliver) length_ = ahead;
}

void StepControl::follow_blows_on_heads() {
  const double longest = longest_for_heads(world_, state_, length_);
  if (longest >= length_ - kSliver * settings_.step) return;
  ++world_.log.diagnostics.substeps;
  length_ = longest;
}

double StepControl::cut_at_impact(const StepContext& s) {
  constexpr double kShortest = 1e-8;  // [-] of the step: what is nearer acts where it is, nanometres off
  placing_ = places_impacts(world_, state_);
  crossed_ = false;
  double taken = s.length;
  if (placed_ != s.length) {
    placings_ = 0;
    stopping_.reset();
    uncut_ = s.length;
    if (placing_) {
      const NextImpact next = next_impact(s);
      taken = std::max(next.time, kShortest * s.length);
      striking_ = next.key;
    }
    cut_ = taken < s.length;
  }
  may_halve_ = taken > settings_.step / kMostHalvedParts && !settled_;
  return taken;
}

/// An impact that the speeds at the start did not foretell: a force brought it about within the step. Of several the deepest.
bool StepControl::find_crossing(const StepContext& s) {
  if (!placing_) return false;
  double deepest = -kPlaced;
  for (const Constraint& c : s.buffers.end_contacts) {
    if (c.gap >= deepest || !is_instant(world_, c) || row_velocity(c, s.end.V_WB)[0] > -impact_speed(s)) continue;
    const auto& before = state_.contacts.list;
    const auto same = std::find_if(before.begin(), before.end(), [&](const Constraint& b) { return b.key == c.key; });
    if (same != before.end() && same->gap <= kPlaced) continue;
    deepest = c.gap;
    striking_ = c.key;
  }
  return deepest < -kPlaced;
}

/// A cut step ends where the surfaces would touch if they closed as fast as at its start. One that ends short of the touch or
/// beyond it by more than rounding is taken again, by Newton's rule on its length.
Verdict StepControl::place_impact(const StepContext& s) {
  constexpr int kMostPlacings = 4;
  constexpr double kNear = 0.1 * kPlaced;
  if (placings_ == kMostPlacings || !(cut_ || find_crossing(s))) return {};
  const auto& found = s.buffers.end_contacts;
  const auto strikes = std::find_if(found.begin(), found.end(), [this](const Constraint& c) { return c.key == striking_; });
  if (strikes == found.end() || std::abs(strikes->gap) <= kNear) return {};
  const double closing = -row_velocity(*strikes, s.end.V_WB)[0];
  const double better = s.length + strikes->gap / closing;
  if (!(closing > 0 && better > 0 && better < uncut_)) return {};
  cut_ = true;
  ++placings_;
  placed_ = better;
  return {Verdict::Kind::place, better};
}

/// Where a slip ends or turns, the step ends: friction that turns about within it would be off by what it gives in a step.
Verdict StepControl::place_slip_end(const StepContext& s) {
  constexpr int kMostPlacings = 4;
  constexpr double kNear = 1e-6;  // [-] of the length
  if (!placing_ || !s.impulses || placings_ == kMostPlacings) return {};
  const std::optional<SlipEnd> end = slip_end(s, stopping_);
  if (!end || std::abs(end->time - s.length) <= kNear * s.length || !(end->time < uncut_)) return {};
  stopping_ = end->key;
  cut_ = true;
  ++placings_;
  placed_ = end->time;
  return {Verdict::Kind::place, placed_};
}

/// Ends the run for what a step of any length worth taking could not follow; the state stays the last that was followed.
Verdict StepControl::end_run(int body, const char* effect, const char* message) {
  world_.log.failure = Failure{state_.time, world_.model.bodies[body].name, effect, message};
  return {Verdict::Kind::ended, 0};
}

Verdict StepControl::bear_springs(const CompliantContacts& contacts, double& length) {
  const double spring = contacts.fastest_spring();
  if (spring * settings_.step > kMostSpringParts * kSpringStep)
    return end_run(contacts.sprung_body(), world_.plan.active[contacts.sprung_by()]->name, kSpringsTooFast);
  if (spring * length > kSpringStep) length = kSpringStep / spring;
  return {};
}

Verdict StepControl::judge_motion(const Swing& swing, double error, double length) {
  if (swing.rate * shortest_ > kSmoothSwing) return end_run(swing.body, "joints", kSwingsTooFast);
  error_ = error;
  if (!(error > settings_.adaptive_tolerance && length > shortest_)) return {};
  const double share = std::clamp(0.9 * math::pow(settings_.adaptive_tolerance / error, 0.2), 0.1, 0.7);
  return {Verdict::Kind::again, std::max(share * length, shortest_)};
}

bool StepControl::locates_events() const {
  return settings_.locate_events && state_.pace.events < kMostPartsOfAll;
}

Verdict StepControl::judge_end(StepContext& s) {
  const int lost = lost_body(world_, s.end);
  const bool gained = s.impulses && lost < 0 && may_halve_ && largest_rise(s) > kMayRise;
  const double off_the_books = lost < 0 ? mislaid(s) : 0;  // asked of every end: effects book what they see there
  const bool unsolved = s.residual > kUnsolved * settings_.solver_tolerance;
  const bool wrong = lost >= 0 || gained || unsolved || !acceptable(state_.contacts.list, s.buffers.end_contacts, depth_tolerance_);
  if (may_halve_ && (wrong || off_the_books > kMayMislay)) {
    if (!wrong && off_the_books < least_mislaid_) least_mislaid_ = off_the_books, least_mislaid_length_ = s.length;
    return {Verdict::Kind::again, 0.5 * s.length};
  }
  // books a little off, which no halving mended, are better than what the last of them is
  if (wrong && least_mislaid_ < kBearable && !settled_) {
    settled_ = true;
    return {Verdict::Kind::again, least_mislaid_length_};
  }
  if (lost < 0) {
    const Verdict slips = place_slip_end(s);
    return slips.kind == Verdict::Kind::place || stopping_ ? slips : place_impact(s);
  }
  world_.log.failure = failure_of(world_, s.constraints, lost, state_.time + s.length, kNotANumber);
  return {Verdict::Kind::ended, s.length};
}

void StepControl::accept(const StepContext& s) {
  StepPace& pace = state_.pace;
  pace.last = s.length;
  pace.cuts = cut_ ? pace.cuts + 1 : 0;
  if (crossed_) ++pace.events;
  if (cut_) ++world_.log.diagnostics.substeps;
  if (pace.next > 0 && !cut_ && !crossed_) {
    const double tolerance = settings_.adaptive_tolerance;
    const double growth = error_ > 0 ? std::clamp(0.9 * math::pow(tolerance / error_, 0.2), 0.5, 2.0) : 2.0;
    pace.next = growth * s.length < settings_.step ? std::max(growth * s.length, shortest_) : 0;
  }
}

}  // namespace engine
