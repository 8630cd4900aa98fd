#include "engine/record/recorder.h"

#include <algorithm>
#include <utility>

#include "engine/math/functions.h"

namespace engine {
namespace {

ContactState state_of(const Constraint& c, double gap_speed) {
  if (c.impulse[0] <= 0) return gap_speed < 0 ? ContactState::approach : ContactState::separate;
  if (!is_compliant(c) && c.u.before[0] < -0.1) return ContactState::impact;  // what yields has a force, and no instant
  const double slip = math::hypot(c.u.after[1], c.u.after[2]);
  return slip > 1e-3 ? ContactState::slide : ContactState::stick;
}

/// A wheel on somebody as the contact of that body with the vehicle: rows turned about the second tangent, so that they stay
/// right-handed.
Constraint seen_from_below(const Constraint& wheel) {
  Constraint c = wheel;
  c.kind = ConstraintKind::contact;
  c.shapes = {ShapeKind::round, ShapeKind::tyre};
  std::swap(c.a.record, c.b.record);
  c.frame.leftCols<2>() *= -1;
  for (Vec3* row : {&c.impulse, &c.u.before, &c.u.after}) (*row)[2] *= -1;
  c.gap = 0;
  return c;
}

/// [J] of gravity at a body, seen from the origin; 0 of one that is fixed.
double weight_of(const Model& model, const State& state, int b) {
  const Body& body = model.bodies[b];
  return body.fixed ? 0 : body.mass * model.settings.gravity.dot(state.X_WB[b].p);
}

/// An [[impact]] settles the exchange of one pair: one that never came about is a question the run did not answer.
void warn_of_idle_impacts(const World& world, std::vector<std::string>& warnings) {
  const Model& model = world.model;
  for (const ImpactSettings& s : model.impacts) {
    const bool acted = std::any_of(world.log.exchanges.begin(), world.log.exchanges.end(), [&](const ContactRecord& c) {
      return std::minmax(c.body_a, c.body_b) == std::minmax(s.body_a, s.body_b);
    });
    if (acted) continue;
    const Body &A = model.bodies[s.body_a], &B = model.bodies[s.body_b];
    const bool asked = model_between(A.collision_model, B.collision_model) == CollisionModel::kudlich_slibar;
    warnings.push_back("[[impact]] of " + A.name + " with " + B.name + " never acted: " +
                       (asked ? "they exchanged no impulse" : "they do not both have collision = \"kudlich_slibar\""));
  }
}

}  // namespace

Recorder::Recorder(const World& world, const State& state)
    : rest_(world), events_(world, state), necks_(world), tyre_impulse_(world.model.vehicles.size(), Vec3::Zero()) {
  tallies_.reserve(kRoom);
}

void Recorder::tally(const World& world, const std::vector<Constraint>& conditions, double time, double duration) {
  for (const Constraint& c : conditions) {
    bounds_.watch(world, c, time, duration);
    if (c.kind == ConstraintKind::contact)
      tally_contact(world, c, time, duration);
    else if (c.kind == ConstraintKind::wheel && c.b.record >= 0)
      tally_contact(world, seen_from_below(c), time, duration);
    else if (c.kind == ConstraintKind::wheel)
      tyre_impulse_[world.model.bodies[c.a.record].vehicle] += c.frame * c.impulse;
  }
  if (duration > 0) bounds_.watch_squeezes(world, conditions, time);
}

void Recorder::tally_contact(const World& world, const Constraint& c, double time, double duration) {
  events_.watch(world, c, time - duration, duration);  // the push began with the step
  necks_.note(world, c);
  if (c.impulse[0] <= 0 && c.gap > 0) return;
  auto at = std::lower_bound(tallies_.begin(), tallies_.end(), c.key, [](const Tally& t, std::uint64_t k) { return t.key < k; });
  if (at == tallies_.end() || at->key != c.key) at = tallies_.insert(at, Tally{c.key, {}, 0, Vec3::Zero()});
  ContactRecord& r = at->record;
  if (r.normal_impulse == 0) r.begun = time - duration;
  r.shapes = c.shapes;
  r.body_a = c.a.record;
  r.body_b = c.b.record;
  r.point = c.point;
  r.normal = c.frame.col(0);
  const bool rubber = is_compliant(c) && !yields_between(world.model, c.a.record, c.b.record);
  r.depth = rubber ? 0 : -c.gap;
  r.slip = math::hypot(c.u.after[1], c.u.after[2]);
  const ContactState state = state_of(c, c.u.before[0]);
  if (r.state != ContactState::impact || r.normal_impulse == 0) r.state = state;
  r.normal_impulse += c.impulse[0];
  r.tangential_impulse += math::hypot(c.impulse[1], c.impulse[2]);
  r.friction_limit += c.surface.friction * c.impulse[0];
  r.energy_lost -= 0.5 * c.impulse.dot(c.u.before + c.u.after);
  at->impulse += c.frame * c.impulse;
  at->duration += duration;
}

void Recorder::follow(const World& world, const State& state, double left, Recording& recording) {
  necks_.follow(world, state);
  accelerometers_.follow(world, state, left, recording);
}

void Recorder::sample(const World& world, const State& state, Recording& recording) {
  events_.watch_step(world, state);
  rest_.watch_step(world, state);
  necks_.follow(world, state);
  accelerometers_.sample(world, state, recording);
}

/// Somebody has begun or ceased to be still since the last snapshot.
void Recorder::keep_still(const World& world, const State& state) {
  const std::size_t bodies = state.X_WB.size();
  still_ = std::make_shared<BodyStates::Still>();
  still_->place.assign(bodies, -1);
  for (std::size_t i = 0; i < world.still.others.size(); ++i) still_->place[world.still.others[i]] = static_cast<int>(i);
  for (std::size_t b = 0; b < bodies; ++b)
    if (int& place = still_->place[b]; place < 0) {
      place = ~static_cast<int>(still_->states.size());
      still_->states.push_back({state.X_WB[b], state.V_WB[b]});
    }
  weight_.resize(bodies);
  for (std::size_t b = 0; b < bodies; ++b) weight_[b] = weight_of(world.model, state, static_cast<int>(b));
  shared_ = world.still.changes;
}

/// The sum of the potentials is over all bodies in order, to the last bit, though only those that are not still are weighed again.
Energies Recorder::energies(const World& world, const State& state) {
  for (const int b : world.still.others) weight_[b] = weight_of(world.model, state, b);
  double potential = 0;
  for (const double weight : weight_) potential -= weight;
  Energies out;
  out.kinetic = kinetic_energy(world, state);
  out.potential = potential + state.energy.springs;
  out.dissipated = state.energy.dissipated;
  out.added = state.energy.added;
  out.residual = out.kinetic + out.potential - state.energy.initial - state.energy.added;
  for (const double d : state.energy.dissipated) out.residual += d;
  return out;
}

/// All tallied since the last snapshot, `since` [s] ago.
void Recorder::write_contacts(const World& world, double since, std::vector<ContactRecord>& out) {
  for (Tally& t : tallies_) {
    // an exchange at an instant has no force of its own: its mean over the recorded interval is what an arrow can show
    const double over = t.duration > 0 ? t.duration : since;
    if (over > 0) {
      t.record.force = t.impulse / over;
      t.record.normal_force = t.record.normal_impulse / over;
      t.record.tangential_force = t.record.tangential_impulse / over;
    }
    t.record.impulse = t.impulse;
    out.push_back(t.record);
  }
  tallies_.clear();
  for (; exchanges_told_ < world.log.exchanges.size(); ++exchanges_told_) {
    ContactRecord c = world.log.exchanges[exchanges_told_];
    if (since > 0) {
      c.force = c.impulse / since;
      c.normal_force = c.normal_impulse / since;
      c.tangential_force = c.tangential_impulse / since;
    }
    out.push_back(c);
  }
}

void Recorder::snapshot(const World& world, const State& state, Recording& recording) {
  if (shared_ != world.still.changes) keep_still(world, state);
  Snapshot s;
  s.time = state.time;
  std::vector<BodyState> others;
  others.reserve(world.still.others.size());
  for (const int b : world.still.others) others.push_back({state.X_WB[b], state.V_WB[b]});
  s.bodies = {still_, std::move(others)};
  const double since = recording.snapshots.empty() ? 0 : s.time - recording.snapshots.back().time;
  write_contacts(world, since, s.contacts);
  for (std::size_t i = 0; i < state.wheels.size(); ++i) {
    const WheelState& w = state.wheels[i];
    const double h = state.pace.last > 0 ? state.pace.last : 1;
    s.wheels.push_back({w.vehicle, w.wheel, w.hub, w.contact, w.steer, state.wheel_spin[i], w.impulse[0] / h, w.impulse[1] / h,
                        w.impulse[2] / h, w.slip});
  }
  s.tyre_impulse = tyre_impulse_;
  std::fill(tyre_impulse_.begin(), tyre_impulse_.end(), Vec3::Zero());
  s.energies = energies(world, state);
  energy_.weigh(world, state, s.energies);
  recording.snapshots.push_back(std::move(s));
  rest_.watch_snapshot(world, state, since);
}

void Recorder::finish(const World& world, const State& state, Recording& recording) {
  recording.events = world.log.events;
  recording.events.insert(recording.events.end(), events_.events().begin(), events_.events().end());
  rest_.tell(world, state, recording, recording.events);
  std::stable_sort(recording.events.begin(), recording.events.end(),
                   [](const Event& a, const Event& b) { return a.time < b.time; });
  accelerometers_.finish(world, recording);
  recording.diagnostics = world.log.diagnostics;
  energy_.close(world, recording.diagnostics);
  bounds_.close(world, recording.diagnostics);
  necks_.close(world, recording.diagnostics.warnings);
  warn_of_idle_impacts(world, recording.diagnostics.warnings);
  // the depth of a compliant contact is a deformation, not an error
  for (const ContactRecord& c : recording.snapshots.back().contacts)
    if (!yields_between(world.model, c.body_a, c.body_b))
      recording.diagnostics.rest_penetration = std::max(recording.diagnostics.rest_penetration, c.depth);
}

}  // namespace engine
