#include "engine/step/formulation.h"

#include <algorithm>
#include <cmath>

#include "engine/contact/mean_friction.h"
#include "engine/laws/compliant_contact.h"
#include "engine/math/functions.h"
#include "engine/step/bounds.h"
#include "engine/step/impact.h"
#include "engine/step/position_correction.h"

namespace engine {
namespace {

constexpr double kShortestArm = 0.01;  // [m] on which a push turns a joint: a child's foot
constexpr double kFartherOut = 20;     // [-] by how much more a push moves what is far out: a bicycle's wheel by its pedal
constexpr double kLimitImpact = 0.5;   // [rad/s] a stop closed upon faster than this is an impact

/// Wheels and closed loops: their effect has formulated them.
bool is_formulated(const Constraint& c) {
  return c.kind == ConstraintKind::wheel || c.kind == ConstraintKind::bilateral;
}

/// Does the condition close within the step, faster than things that come to rest?
bool strikes(const Constraint& c, double h, double v_impact) {
  const double threshold = is_angular_limit(c) ? kLimitImpact : v_impact;
  const bool hard = c.kind == ConstraintKind::contact || c.kind == ConstraintKind::limit;
  return hard && !is_compliant(c) && c.u.before[0] < -threshold && c.gap + h * std::min(c.u.before[0], c.u.free[0]) < 0;
}

/// Rigid: no deeper than touching at the end of the step. An impulse that acts all through the step displaces by half of what an
/// impact does.
double formulate_rigid(Constraint& c, double h, bool impact) {
  c.target = impact ? -std::max(0.0, c.gap) / h : -std::max(0.0, 2 * c.gap / h + c.u.before[0]);
  return impact ? 1.0 : 0.5;
}

/// A stop that gives way: torque k depth + c rate, never a pull, damped critically for the two bodies were they free.
double formulate_compliant_stop(Constraint& c, double h, bool whole) {
  const double k = c.spring.stiffness, inertia = 1 / c.response.free;
  const double damping = c.gap < 0 ? 2 * std::sqrt(k * inertia) : 0;  // nothing brakes before it is reached
  const bool followed = !whole && h * h * k < 0.5 * inertia;
  // at the mean of both ends, L = -h (k (gap + h (u_before + u_after) / 4) + damping (u_before + u_after) / 2); a step too long
  // for that: at its end, which is stable however stiff, L = -h (k (gap + h u_after) + damping u_after)
  const double slope = followed ? h * k / 4 + damping / 2 : h * k + damping;
  c.softness = 1 / (h * slope);
  c.target = -k * c.gap / slope - (followed ? c.u.before[0] : 0);
  return followed ? 0.5 : 1;
}

/// A wheel's spring and damper are taken at the end of the step, at the place u_after leads to. Over the step they may be stiffer
/// than the lightest thing they push: a bicycle's on its stop, a calf under a van. The impulse must then displace by as much. By
/// half of it, what stops that thing (road, bonnet) would throw it back into the spring and charge it.
double weight_of_wheel(const Constraint& c) {
  const bool followed = c.response.free < c.softness;
  return followed ? 0.5 : 1;
}

/// A wheel that stands on a body. There all impulses of the island displace by their whole: a limb that the wheel displaces by its
/// whole and the road by half sinks by half of what the wheel gives it in a step.
bool stands_on_body(const Constraint& c) {
  return c.kind == ConstraintKind::wheel && c.b.body >= 0;
}

/// Pressed in, or beyond its stop.
bool gives_way(const Constraint& c) {
  return (is_contact(c) || c.kind == ConstraintKind::limit) && is_compliant(c) && c.gap < 0;
}

/// What a unit impulse along the first row of one would do along that of the other, by a body that both act on: below zero, they
/// press on it from two sides.
double coupling(const StepContext& s, const Constraint& one, const Constraint& other) {
  double sum = 0;
  const auto row = [](const Constraint& c, int body) { return Vec6((body == c.a.body ? c.a.J : c.b.J).row(0).transpose()); };
  for (const int b : {one.a.body, one.b.body}) {
    if (b < 0 || (b != other.a.body && b != other.b.body)) continue;
    const Body& body = s.world.model.bodies[b];
    const Vec6 J = row(one, b), K = row(other, b);
    sum += J.head<3>().dot(K.head<3>()) / body.mass;
    sum += J.tail<3>().dot(inertia_W(body, s.state.X_WB[b].q).inverse() * K.tail<3>());
  }
  return sum;
}

/// A part between two springs of which the step follows one. At equal impulses one would displace it by its whole and the other by
/// half: a forearm of 0.5 kg under 150 N went through the road at 15 cm/s at 2 ms, and lay 5 cm deep in it.
bool squeezes_by_unequal_shares(const StepContext& s, const std::vector<int>& island) {
  const std::vector<double>& weight = s.buffers.weight;
  for (const int i : island) {
    if (!gives_way(s.constraints[i]) || weight[i] < 1) continue;
    for (const int k : island)
      if (weight[k] < 1 && gives_way(s.constraints[k]) && coupling(s, s.constraints[i], s.constraints[k]) < 0) return true;
  }
  return false;
}

/// How fast the resting law falls with the separating speed [N s/m], at a speed.
double resting_slope(const Constraint& c, double at, double share, double smoothing) {
  const double tanh = math::tanh(at / smoothing);
  return c.spring.stiffness * -c.gap * (1 - share) * 0.5 * (1 - tanh * tanh) / smoothing;
}

/// Between loading and unloading the spring's force falls with speed, steeply where things rest. Taken at the speed before the step
/// alone it would throw a light limb under a heavy body to and fro. What `rests` takes it at the speed after it, by its slope at
/// `speed`. Under a wheel (`whole`) a limb that comes up faster than the law is wide would have neither force nor slope, and the
/// wheel would press it in unhindered: there the slope is taken where the law still has one.
double formulate_compliant_contact(Constraint& c, double h, double gravity, double speed, bool rests, bool whole) {
  const double smoothing = std::max(1e-3, h * gravity), share = std::max(c.spring.hysteresis, 1e-3);
  const bool pressed = c.gap < 0;
  const double at = whole && rests ? std::clamp(speed, -smoothing, smoothing) : speed;
  const double closing = std::max(0.0, -c.u.before[0]);
  // what has yielded holds its force at the mean depth of the step
  const double loading = pressed ? std::min(c.spring.stiffness, c.spring.yield / (0.5 * h * closing - c.gap)) : c.spring.stiffness;
  const double S = pressed ? compliant_normal_force(loading, share, 1, at, ContactPhase::resting, smoothing) : loading;
  const double damping = rests && pressed ? resting_slope(c, at, share, smoothing) : 0;
  // no more than stops what it stops within the step
  const double extra = c.spring.room > 0
                           ? std::min(bottoming_force(S, c.spring.yield, -c.gap, closing, c.spring.struck_mass, c.spring.room),
                                      c.spring.struck_mass * closing / h)
                           : 0;
  // the spring at the mean of its depths at both ends, which neither gains nor loses energy of itself:
  // L = -h (S (gap + h (u_before + u_after) / 4) + damping (u_after - u_before)); a step too long to follow it: at its end, which
  // is stable however stiff, L = -h (S (gap + h u_after) + damping (u_after - u_before))
  const bool followed = !whole && h * h * S * c.response.free < 1;
  const double slope = (followed ? h * S / 4 : h * S) + damping;
  c.softness = 1 / (h * slope);
  c.target = (damping * at - S * c.gap - (followed ? S * h * c.u.before[0] / 4 : 0)) / slope + h * extra * c.softness;
  return followed ? 0.5 : 1;
}

/// [m] by which surfaces in each other are pushed apart, however short the step.
double most_pushed(const StepContext& s) {
  double most = 0;
  for (const Constraint& c : s.constraints)
    if (is_contact(c) && !is_compliant(c)) most = std::max(most, recovery(c, s.length));
  return most;
}

/// `whole`: all impulses displace by their whole.
void formulate_island(StepContext& s, const std::vector<int>& island, bool whole) {
  const double v_impact = impact_speed(s), h = s.length, gravity = s.world.model.settings.gravity.norm();
  const bool impact = std::any_of(island.begin(), island.end(), [&](int i) { return strikes(s.constraints[i], h, v_impact); });
  for (const int i : island) {
    Constraint& c = s.constraints[i];
    double& weight = s.buffers.weight[i];
    if (is_formulated(c))
      weight = whole ? 1 : c.kind == ConstraintKind::wheel ? weight_of_wheel(c) : 0.5;
    else if (!is_compliant(c))
      weight = formulate_rigid(c, h, impact || whole);
    else if (c.kind == ConstraintKind::limit)
      weight = formulate_compliant_stop(c, h, whole);
    else
      weight = formulate_compliant_contact(c, h, gravity, c.u.before[0], std::abs(c.u.before[0]) < 2 * v_impact, whole);
  }
}

}  // namespace

void drop_open_conditions(StepContext& s) {
  const double v_impact = impact_speed(s), h = s.length;
  const double pushed = most_pushed(s);
  std::erase_if(s.constraints, [&](Constraint& c) {
    c.impulse.setZero();
    c.push = 0;
    c.u.smooth = row_velocity(c, s.end.V_WB);
    if (is_formulated(c)) return false;
    // an impact that the cut step ends at: a row would brake the approach
    if (s.placing && c.gap > 0 && c.u.before[0] < -v_impact && is_instant(s.world, c)) return true;
    // [rad], [m]: what other impulses may add, and pushes
    const double spare = is_angular_limit(c) ? 0.02 + 5 * h + pushed / kShortestArm : 1e-3 + h + kFartherOut * pushed;
    return c.gap + h * std::min(c.u.before[0], c.u.smooth[0]) > spare;
  });
  // the smooth motion keeps closed loops; their rows are there for what other impulses ask of them
  const auto of_loop = [](const Constraint& c) { return c.kind == ConstraintKind::bilateral; };
  if (!s.any_damper && std::all_of(s.constraints.begin(), s.constraints.end(), of_loop)) s.constraints.clear();
}

void take_mean_friction(StepContext& s) {
  const Model& model = s.world.model;
  for (Constraint& c : s.constraints) {
    if (!is_contact(c) || c.a.record < 0 || c.surface.rolls) continue;
    const Twist& V = s.state.V_WB[c.a.record];
    const StepWay way{c.point, V.v + V.w.cross(c.point - s.state.X_WB[c.a.record].p), s.state.time, s.length};
    const Body& body = model.bodies[c.a.record];
    const bool on_tyre = c.shapes.b == ShapeKind::tyre && is_part(model, c.a.record);
    const double friction = on_tyre          ? mean_friction(body.surface.friction_ground, way)
                            : c.b.record < 0 ? mean_friction(body, model.ground, way)
                                             : mean_friction(body, model.bodies[c.b.record], way);
    c.surface.friction = std::min(friction, c.surface.held);
    c.surface.friction += c.surface.ploughing;
  }
}

namespace {

/// As the impulses found so far have shown it.
void take_spring(StepContext& s, int i, bool whole) {
  const SpringShown& shown = s.buffers.shown[i];
  Constraint& c = s.constraints[i];
  const double gravity = s.world.model.settings.gravity.norm();
  switch (shown.as) {
    case SpringShown::As::foretold:
      break;
    case SpringShown::As::rests:
      formulate_compliant_contact(c, s.length, gravity, 0, true, whole);
      break;
    case SpringShown::As::struck:
      formulate_compliant_contact(c, s.length, gravity, shown.speed, false, whole);
      break;
    case SpringShown::As::spent:
      c.softness = 0;
      c.target = shown.speed;
      break;
  }
}

}  // namespace

void formulate(StepContext& s) {
  Islands& islands = s.buffers.islands;
  s.buffers.weight.assign(s.constraints.size(), 0.5);
  for (auto* by : {&islands.by_whole, &islands.to_end}) by->assign(islands.members.size(), 0);
  islands.moved.assign(islands.members.size(), 0);
  for (const int k : islands.roots) {
    const std::vector<int>& island = islands.members[k];
    const bool stands = std::any_of(island.begin(), island.end(), [&](int i) { return stands_on_body(s.constraints[i]); });
    formulate_island(s, island, stands);
    islands.by_whole[k] = stands || squeezes_by_unequal_shares(s, island);
    islands.to_end[k] = islands.by_whole[k] && !stands;
    if (islands.to_end[k]) formulate_island(s, island, true);
    for (const int i : island) take_spring(s, i, islands.by_whole[k]);
  }
}

namespace {

/// A compliant contact that gives back a part of its energy.
bool has_hysteresis(const Constraint& c) {
  return is_contact(c) && is_compliant(c) && c.spring.hysteresis < 1;
}

/// One that was slow, or closed.
bool may_turn(const Constraint& c, double slow) {
  return has_hysteresis(c) && c.u.before[0] < slow;
}

/// One that parted and closes again. For this step it had hardly a force, and for the next it would have all of it: a head on its
/// crown, pressed on by the neck, knocked itself to and fro, and had HIC15 of 274 to 525 by the step.
bool is_pressed_again(const Constraint& c, double slow) {
  return has_hysteresis(c) && c.gap < 0 && c.u.before[0] > 0 && c.u.after[0] < -slow;
}

}  // namespace

bool wake_struck_springs(StepContext& s, int root) {
  const double slow = 2 * impact_speed(s);
  const bool whole = s.buffers.islands.by_whole[root];
  bool any = false;
  for (const int i : s.buffers.islands.members[root]) {
    const Constraint& c = s.constraints[i];
    SpringShown& shown = s.buffers.shown[i];
    if (shown.as != SpringShown::As::foretold) continue;
    if (is_pressed_again(c, slow))
      shown = {SpringShown::As::rests, 0};
    else if (may_turn(c, slow) && c.gap < 0 && c.u.before[0] > -slow && std::abs(c.u.after[0]) > slow)
      shown = {SpringShown::As::struck, whole ? c.u.after[0] : c.u.before[0]};
    else
      continue;
    take_spring(s, i, whole);
    any = true;
  }
  return any;
}

bool hold_spent_springs(StepContext& s, int root) {
  const double slow = 2 * impact_speed(s);
  bool any = false;
  for (const int i : s.buffers.islands.members[root]) {
    const Constraint& c = s.constraints[i];
    SpringShown& shown = s.buffers.shown[i];
    if (shown.as == SpringShown::As::spent || !may_turn(c, slow) || c.u.after[0] <= slow) continue;
    shown = {SpringShown::As::spent, c.spring.hysteresis * c.u.after[0]};
    take_spring(s, i, s.buffers.islands.by_whole[root]);
    any = true;
  }
  return any;
}

}  // namespace engine
