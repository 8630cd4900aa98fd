#include "engine/step/compliant_contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/step/find_contacts.h"

namespace engine {
namespace {

constexpr double kSlipSpeed = 1e-3;      // [m/s] below it friction is in proportion to the slip
constexpr double kAdaptiveSlip = 5e-3;   // [m/s]
constexpr double kSlowestRest = 0.01;    // [m/s]
constexpr double kSlowestSmooth = 1e-3;  // [m/s]
constexpr double kStable = 2.0;          // [-] rate times step that the classic Runge-Kutta scheme holds with room to spare (2.78)

/// How the two bodies of a contact, were they free, answer an impulse along `d` at its point [1/kg].
double free_response(const World& world, const Motion& state, const Constraint& c, const Vec3& d) {
  double response = 0;
  for (const int b : {c.a.body, c.b.body}) {
    if (b < 0) continue;
    const Body& body = world.model.bodies[b];
    const Vec3 lever_B = state.X_WB[b].q.conjugate() * (c.point - state.X_WB[b].p).cross(d);
    response += 1 / body.mass + lever_B.dot(body.inertia_B.inverse() * lever_B);
  }
  return response;
}

}  // namespace

CompliantContacts::CompliantContacts(World& world) : world_(world), model_(world.model) {
  const Model& model = world.model;
  const double g = model.settings.gravity.norm();
  // a scheme that chooses its own steps takes short ones where surfaces rest
  const double step = model.settings.scheme == Scheme::adaptive ? std::min(model.settings.step, 1e-3) : model.settings.step;
  found_.reserve(kRoom);
  next_touches_.reserve(kRoom);
  exchanged_.reserve(kRoom);
  rest_speed_ = std::max(kSlowestRest, 2 * g * step);
  smoothing_ = std::max(kSlowestSmooth, g * step);
  for (const Body& body : model.bodies) {
    double mass = body.mass;
    if (body.person >= 0) {
      mass = 0;
      for (const int b : model.persons[body.person].bodies) mass += model.bodies[b].mass;
    }
    carried_.push_back(mass);
  }
}

CompliantContacts::Touch* CompliantContacts::known(std::uint64_t key) {
  std::vector<Touch>& touches = state_->phases;
  const auto at = std::lower_bound(touches.begin(), touches.end(), key, [](const Touch& t, std::uint64_t k) { return t.key < k; });
  return at != touches.end() && at->key == key ? &*at : nullptr;
}

void CompliantContacts::look(const Motion& at, double within) {
  find_stage_contacts(world_, *state_, at, within, found_);
  std::erase_if(found_, [](const Constraint& c) { return c.kind != ConstraintKind::contact; });
}

/// Slow and no deeper than `share` times under its weight at rest: it will not leave any more.
bool CompliantContacts::slow(const Constraint& c, double separating, double share) const {
  double mass = std::numeric_limits<double>::infinity();
  for (const int b : {c.a.body, c.b.body})
    if (b >= 0) mass = std::min(mass, carried_[b]);
  return std::abs(separating) < share * rest_speed_ &&
         -c.gap < 3 * share * mass * model_.settings.gravity.norm() / c.spring.stiffness;
}

ContactPhase CompliantContacts::phase_now(const Constraint& c, double separating) const {
  if (c.gap >= 0) return ContactPhase::open;
  if (slow(c, separating, 1)) return ContactPhase::resting;
  return separating > 0 ? ContactPhase::separate : ContactPhase::approach;
}

void CompliantContacts::begin(State& state, bool keep_phases) {
  state_ = &state;
  keep_phases_ = keep_phases;
  look(state, keep_phases ? model_.settings.step : 0);
  next_touches_.clear();
  fastest_spring_ = 0;
  for (const Constraint& c : found_) {
    const double speed = row_velocity(c, state.V_WB)[0];
    const Touch* before = known(c.key);
    // what a located event has decided stands; what is new or was not watched is told from where it is
    next_touches_.push_back({c.key, keep_phases && before ? before->phase : phase_now(c, speed), c.gap, speed});
    if (next_touches_.back().phase == ContactPhase::open) continue;
    const double rate = std::sqrt(c.spring.stiffness * free_response(world_, state, c, c.frame.col(0)));
    if (!(rate > fastest_spring_)) continue;
    fastest_spring_ = rate;
    const bool first = c.b.body < 0 || (c.a.body >= 0 && carried_[c.a.body] <= carried_[c.b.body]);
    sprung_body_ = first ? c.a.body : c.b.body;
    sprung_by_ = c.effect;
  }
  std::sort(next_touches_.begin(), next_touches_.end(), [](const Touch& a, const Touch& b) { return a.key < b.key; });
  state_->phases.swap(next_touches_);
}

/// Force in the rows of a contact that closes and slips at u.
Vec3 CompliantContacts::force_of(const Constraint& c, const Vec3& u, ContactPhase phase) const {
  const bool adaptive = model_.settings.scheme == Scheme::adaptive;
  double smoothing = smoothing_;
  if (phase == ContactPhase::resting && !adaptive) {
    // the resting law is a damper of S depth / 2 smoothing: no harder than fixed steps can follow on a light part under load
    const double load = c.spring.stiffness * std::max(0.0, -c.gap) * (1 - c.spring.hysteresis);
    smoothing = std::max(smoothing_, 0.5 * load * free_response(world_, stage_, c, c.frame.col(0)) * h_ / kStable);
  }
  const double normal = compliant_normal_force(c.spring.stiffness, c.spring.hysteresis, -c.gap, u[0], phase, smoothing);
  Vec3 f(normal, 0, 0);
  const double slip = std::sqrt(u[1] * u[1] + u[2] * u[2]);
  if (c.surface.friction > 0 && slip > 0 && normal > 0) {
    const Vec3 along = (u[1] * c.frame.col(1) + u[2] * c.frame.col(2)) / slip;
    // the adaptive scheme follows friction down to a slip that its tolerance is blind to; fixed steps need a width they can follow
    const double regular =
        adaptive ? kAdaptiveSlip
                 : std::max(kSlipSpeed, c.surface.friction * normal * free_response(world_, stage_, c, along) * h_ / kStable);
    const double tangential = c.surface.friction * normal * regularised_friction(slip, regular);
    f[1] = -tangential * u[1] / slip;
    f[2] = -tangential * u[2] / slip;
  }
  return f;
}

void CompliantContacts::exchange(const Constraint& c, const Vec3& f, double weight) {
  auto at = std::find_if(exchanged_.begin(), exchanged_.end(), [&](const Exchange& e) { return e.contact.key == c.key; });
  if (at == exchanged_.end()) at = exchanged_.insert(at, Exchange{c});
  at->impulse_W += weight * h_ * (c.frame * f);
  at->pressed += weight * h_ * std::abs(f[0]);
  for (int r = 0; r < 3; ++r) {
    if (c.a.body >= 0) at->on_a += weight * h_ * f[r] * c.a.J.row(r).transpose();
    if (c.b.body >= 0) at->on_b += weight * h_ * f[r] * c.b.J.row(r).transpose();
  }
}

void CompliantContacts::end_part(const std::vector<Twist>& V_start, const std::vector<Twist>& V_end, double lifted) {
  // the work of an impulse on a body is exactly its product with the mean velocity of both ends. The sum of force times velocity
  // over the stages is not: a hard contact damps its body within them, and the stages end elsewhere than the step
  const auto work_on = [&](int body, const Vec6& impulse) {
    if (body < 0) return 0.0;
    const Twist &from = V_start[body], &to = V_end[body];
    return 0.5 * (impulse.head<3>().dot(from.v + to.v) + impulse.tail<3>().dot(from.w + to.w));
  };
  double pressed = 0;
  for (const Exchange& e : exchanged_) pressed += e.pressed;
  for (Exchange& e : exchanged_) {
    e.work += work_on(e.contact.a.body, e.on_a) + work_on(e.contact.b.body, e.on_b);
    if (pressed > 0) e.work += e.pressed / pressed * lifted;
    e.on_a.setZero();
    e.on_b.setZero();
    e.pressed = 0;
  }
}

void CompliantContacts::add_forces(const std::vector<Pose>& X, const std::vector<Twist>& V, double weight,
                                   std::vector<Vec6>& force) {
  stage_.X_WB = X;
  stage_.V_WB = V;
  stage_.time = state_->time;
  look(stage_);
  for (const Constraint& c : found_) {
    const Vec3 u = row_velocity(c, V);
    const Touch* touch = keep_phases_ ? known(c.key) : nullptr;
    const ContactPhase phase = touch ? touch->phase : phase_now(c, u[0]);
    if (phase == ContactPhase::open) continue;
    const Vec3 f = force_of(c, u, phase);
    for (int r = 0; r < 3; ++r) {
      if (c.a.body >= 0) force[c.a.body] += c.a.J.row(r).transpose() * f[r];
      if (c.b.body >= 0) force[c.b.body] += c.b.J.row(r).transpose() * f[r];
    }
    exchange(c, f, weight);
  }
}

namespace {

/// The event functions of a phase, negative until the event: the gap when touching or parting, the speed at the turn.
struct Functions {
  double gap, speed;
};
Functions functions_of(ContactPhase phase, double gap, double speed) {
  constexpr double kNone = -1;
  switch (phase) {
    case ContactPhase::open:
      return {-gap, kNone};
    case ContactPhase::approach:
      return {gap, speed};
    case ContactPhase::separate:
      return {gap, -speed};
    case ContactPhase::resting:
      return {gap, kNone};
  }
  return {kNone, kNone};
}

}  // namespace

bool CompliantContacts::first_crossing(const Motion& end, Crossing& first) {
  look(end, model_.settings.step);  // what has parted since is some way off
  double earliest = std::numeric_limits<double>::infinity();
  for (const Constraint& c : found_) {
    const Touch* touch = known(c.key);
    if (!touch) continue;  // seen only now, it was out of sight at the start: its touch is told in the next step
    const double speed = row_velocity(c, end.V_WB)[0];
    // what moves this slowly changes its force by nothing that a step would feel
    if (std::abs(touch->speed) < rest_speed_ && slow(c, speed, 1)) continue;
    const Functions a = functions_of(touch->phase, touch->gap, touch->speed), b = functions_of(touch->phase, c.gap, speed);
    auto weigh = [&](int kind, double start, double last) {
      if (!(last > 0)) return;
      const double share = start < 0 ? start / (start - last) : 0;
      if (share >= earliest) return;
      earliest = share;
      first = {c.key, kind, std::min(start, 0.0), last};
    };
    weigh(0, a.gap, b.gap);
    weigh(1, a.speed, b.speed);
  }
  return std::isfinite(earliest);
}

double CompliantContacts::crossing_at(const Motion& end, const Crossing& crossing) {
  look(end, model_.settings.step);
  const Touch* touch = known(crossing.key);
  for (const Constraint& c : found_) {
    if (c.key != crossing.key || !touch) continue;
    const Functions f = functions_of(touch->phase, c.gap, row_velocity(c, end.V_WB)[0]);
    return crossing.kind == 0 ? f.gap : f.speed;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

/// The phase in which a contact goes on from the end of a step.
ContactPhase CompliantContacts::phase_after(const Constraint& c, double speed, const Crossing* crossing) {
  const Touch* touch = keep_phases_ ? known(c.key) : nullptr;
  if (!touch) return phase_now(c, speed);
  if (crossing && c.key == crossing->key) {
    // at the event itself gap or speed is zero but for rounding: the event decides, not the sign. What turns back before it has
    // left is held down (e S depth is less than its load): the two phases would take turns for ever
    const bool rests = slow(c, speed, 1);
    if (crossing->kind == 0)
      return touch->phase != ContactPhase::open ? ContactPhase::open : rests ? ContactPhase::resting : ContactPhase::approach;
    return rests || touch->phase == ContactPhase::separate ? ContactPhase::resting : ContactPhase::separate;
  }
  if (touch->phase == ContactPhase::resting)  // left later than it was entered
    return c.gap < 0 && std::abs(speed) < 2 * rest_speed_ ? ContactPhase::resting : phase_now(c, speed);
  const Functions f = functions_of(touch->phase, c.gap, speed);
  return f.gap <= 0 && f.speed <= 0 ? touch->phase : phase_now(c, speed);
}

void CompliantContacts::finish(const Motion& end, const Crossing* crossing, std::vector<Constraint>& done) {
  look(end);
  next_touches_.clear();
  for (const Constraint& c : found_) {
    const double speed = row_velocity(c, end.V_WB)[0];
    next_touches_.push_back({c.key, phase_after(c, speed, crossing), c.gap, speed});
  }
  std::sort(next_touches_.begin(), next_touches_.end(), [](const Touch& a, const Touch& b) { return a.key < b.key; });
  state_->phases.swap(next_touches_);
  for (Exchange& e : exchanged_) {
    if (e.impulse_W.squaredNorm() == 0) continue;
    Constraint c = e.contact;
    c.impulse = c.frame.transpose() * e.impulse_W;
    c.u.before = c.u.after = row_velocity(c, end.V_WB);
    state_->energy.dissipated[c.effect] -= e.work;
    done.push_back(c);
  }
}

}  // namespace engine
