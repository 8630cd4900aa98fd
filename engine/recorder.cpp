#include "engine/recorder.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>

#include "engine/math/functions.h"
#include "engine/measure/parties.h"

namespace engine {
namespace {

constexpr double kStillSpeed = 0.05;  // [m/s]
constexpr double kStillTurn = 0.3;    // [rad/s]
constexpr double kStillTime = 0.25;   // [s] that long below both: at rest
constexpr double kAirborne = 0.05;    // [s] who lay there is off the ground after that long

// What a run says by itself: less than this is asked of every hard case.
constexpr double kDegree = std::numbers::pi / 180;  // [rad]
constexpr double kToldUnsettled = 1e-3;             // [m/s] a hundred times the solver's tolerance
constexpr double kToldInside = 2e-3;                // [m]
constexpr double kToldBeyond = 0.5 * kDegree;       // [rad]
constexpr double kToldCrossed = 0.05;               // [m] two vehicles: half the way between the points by which they are felt

ContactState state_of(const Constraint& c, double gap_speed) {
  if (c.impulse[0] <= 0) return gap_speed < 0 ? ContactState::approach : ContactState::separate;
  if (!is_compliant(c) && c.u_before[0] < -0.1) return ContactState::impact;  // what yields has a force, and no instant
  const double slip = math::hypot(c.u_after[1], c.u_after[2]);
  return slip > 1e-3 ? ContactState::slide : ContactState::stick;
}

/// A wheel on somebody as the contact of that body with the vehicle: rows turned about the second tangent, so that they stay
/// right-handed.
Constraint seen_from_below(const Constraint& wheel) {
  Constraint c = wheel;
  c.kind = ConstraintKind::contact;
  c.shapes = {ShapeKind::round, ShapeKind::tyre};
  std::swap(c.record_a, c.record_b);
  c.frame.leftCols<2>() *= -1;
  for (Vec3* row : {&c.impulse, &c.u_before, &c.u_after}) (*row)[2] *= -1;
  c.gap = 0;
  return c;
}

}  // namespace

Recorder::Recorder(const World& world, const State& state)
    : still_since_(world.topology.trees.size(), -1),
      halted_(world.topology.trees.size(), 0),
      motion_(world.topology.trees.size(), 0),
      hit_vehicle_(world.model.persons.size(), 0),
      hit_head_(world.model.persons.size(), 0),
      hit_ground_(world.model.persons.size(), 0),
      trunk_(world.model.bodies.size(), 0),
      lying_(world.model.persons.size(), 0),
      tyre_impulse_(world.model.vehicles.size(), Vec3::Zero()),
      last_ground_(world.model.persons.size(), 0) {
  tallies_.reserve(kRoom);
  events_.reserve(kRoom);
  keep(state);
  for (std::size_t p = 0; p < world.model.persons.size(); ++p)
    for (const int b : trunk_of(world.model, static_cast<int>(p))) {
      trunk_[b] = 1;
      const auto* shape = std::get_if<HyperEllipsoid>(&world.model.bodies[b].shape);
      if (!shape) continue;
      const double lowest = state.X_WB[b].p.z() - aabb_half_widths(*shape, state.X_WB[b].q).z();
      lying_[p] = lying_[p] || lowest - world.model.ground.height < 0.02;
    }
}

void Recorder::keep(const State& state) {
  before_.resize(state.X_WB.size());
  for (std::size_t b = 0; b < before_.size(); ++b) before_[b] = {state.X_WB[b], state.V_WB[b]};
}

/// The first touch of a head with a vehicle: how fast its centre came upon the surface there.
void Recorder::note_head(const Constraint& c, double time) {
  const BodyState& head = before_[c.record_a];
  Vec3 velocity = head.V_WB.v;
  if (c.record_b >= 0) {
    const BodyState& struck = before_[c.record_b];
    velocity -= struck.V_WB.v + struck.V_WB.w.cross(c.point - struck.X_WB.p);
  }
  events_.push_back({time, "head_impact", c.record_a, c.record_b, c.point, velocity.norm(), c.frame.col(0), velocity});
}

void Recorder::watch_events(const World& world, const Constraint& c, double time) {
  const int person = c.record_a >= 0 ? world.model.bodies[c.record_a].person : -1;
  if (person < 0 || world.model.bodies[c.record_a].vehicle >= 0 || c.impulse[0] <= 0) return;
  const double closing = std::max(0.0, -c.u_before[0]);
  auto note = [&](const char* kind) {
    events_.push_back({time, kind, c.record_a, c.record_b, c.point, closing, c.frame.col(0), Vec3::Zero()});
  };
  if (c.shapes.on_vehicle()) {
    if (!hit_vehicle_[person]) note("first_contact");
    hit_vehicle_[person] = 1;
    if (c.record_a == world.model.persons[person].head && !hit_head_[person]) {
      note_head(c, time);
      hit_head_[person] = 1;
    }
  }
  if (c.shapes.on_ground()) {
    // feet and hands come and go while a person is being struck, carried or walks: who falls comes down on the trunk
    if (time - last_ground_[person] > kAirborne) lying_[person] = 0;
    if (!hit_ground_[person] && trunk_[c.record_a] && !lying_[person]) {
      note("ground_contact");
      hit_ground_[person] = 1;
    }
    last_ground_[person] = time;
  }
}

/// A part pressed in by all its thickness has slipped through: its law no longer knows from which side it came.
void Recorder::watch_compression(const World& world, const Constraint& c, double time, double duration) {
  const double depth = -c.gap;
  if (duration <= 0 || c.impulse[0] < 0.5 * c.stiffness * depth * duration) return;  // slack: it springs back
  compression_ = std::max(compression_, depth);
  double thinner = std::numeric_limits<double>::infinity();
  for (const int b : {c.record_a, c.record_b})
    if (const auto* shape = b >= 0 ? std::get_if<HyperEllipsoid>(&world.model.bodies[b].shape) : nullptr)
      thinner = std::min(thinner, 2 * shape->semi_axes.minCoeff());
  if (depth > thinner) too_deep_.note(depth, time, c);
}

/// What rigid contacts and joints promise to keep. What overlaps at the start is told by itself, and takes its time to part.
void Recorder::watch_bounds(const World& world, const Constraint& c, double time) {
  if (is_compliant(c)) return;
  if (c.kind == ConstraintKind::limit) (c.slides ? overslid_ : overturned_).note(-c.gap, time, c);
  if (is_contact(c) && -c.gap > world.log.overlap_at_start(c.record_a, c.record_b) + kToldInside)
    (c.shapes.between_vehicles() ? crossed_ : stood_inside_).note(-c.gap, time, c);
}

void Recorder::tally(const World& world, const std::vector<Constraint>& conditions, double time, double duration) {
  for (const Constraint& c : conditions) {
    watch_bounds(world, c, time);
    if (c.kind == ConstraintKind::contact)
      tally_contact(world, c, time, duration);
    else if (c.kind == ConstraintKind::wheel && c.record_b >= 0)
      tally_contact(world, seen_from_below(c), time, duration);
    else if (c.kind == ConstraintKind::wheel)
      tyre_impulse_[world.model.bodies[c.record_a].vehicle] += c.frame * c.impulse;
  }
}

void Recorder::tally_contact(const World& world, const Constraint& c, double time, double duration) {
  watch_events(world, c, time);
  if (c.impulse[0] <= 0 && c.gap > 0) return;
  if (is_compliant(c)) watch_compression(world, c, time, duration);
  auto at = std::lower_bound(tallies_.begin(), tallies_.end(), c.key, [](const Tally& t, std::uint64_t k) { return t.key < k; });
  if (at == tallies_.end() || at->key != c.key) at = tallies_.insert(at, Tally{c.key, {}, 0, Vec3::Zero()});
  ContactRecord& r = at->record;
  if (r.normal_impulse == 0) r.begun = time - duration;
  r.shapes = c.shapes;
  r.body_a = c.record_a;
  r.body_b = c.record_b;
  r.point = c.point;
  r.normal = c.frame.col(0);
  r.depth = -c.gap;
  r.slip = math::hypot(c.u_after[1], c.u_after[2]);
  const ContactState state = state_of(c, c.u_before[0]);
  if (r.state != ContactState::impact || r.normal_impulse == 0) r.state = state;
  r.normal_impulse += c.impulse[0];
  r.tangential_impulse += math::hypot(c.impulse[1], c.impulse[2]);
  r.energy_lost -= 0.5 * c.impulse.dot(c.u_before + c.u_after);
  at->impulse += c.frame * c.impulse;
  at->duration += duration;
}

void Recorder::sample(const World& world, const State& state, Recording& recording) {
  keep(state);
  if (!yields(world.model.settings.contact_law, true) || world.model.persons.empty()) return;
  if (recording.heads.empty()) {
    // one sample a step, and more where steps are divided; a run longer than this grows
    constexpr double kLeast = 4096, kMost = 1e6;
    const Settings& settings = world.model.settings;
    const auto room = static_cast<std::size_t>(std::clamp(1.2 * settings.duration / settings.step, kLeast, kMost));
    for (int p = 0; p < static_cast<int>(world.model.persons.size()); ++p) {
      recording.heads.push_back({p, {}, {}});
      recording.heads.back().time.reserve(room);
      recording.heads.back().acceleration.reserve(room);
    }
    recording.peak_acceleration.assign(world.model.bodies.size(), 0);
    for (const Body& body : world.model.bodies) velocity_.push_back(body.fixed ? Vec3(Vec3::Zero()) : body.V_WB.v);
  }
  const double step = state.time - sampled_;
  for (std::size_t p = 0; p < world.model.persons.size(); ++p) {
    const int head = world.model.persons[p].head;
    if (head < 0) continue;
    recording.heads[p].time.push_back(state.time - 0.5 * step);
    recording.heads[p].acceleration.push_back((state.V_WB[head].v - velocity_[head]).norm() / step);
  }
  for (std::size_t b = 0; b < velocity_.size(); ++b) {
    recording.peak_acceleration[b] = std::max(recording.peak_acceleration[b], (state.V_WB[b].v - velocity_[b]).norm() / step);
    velocity_[b] = state.V_WB[b].v;
  }
  sampled_ = state.time;
}

void Recorder::watch_rest(const World& world, const State& state, double since) {
  for (std::size_t t = 0; t < world.topology.trees.size(); ++t) {
    double motion = 0;
    for (int l = world.topology.trees[t].begin; l < world.topology.trees[t].end; ++l) {
      const Twist& V = state.V_WB[world.topology.links[l].body];
      motion = std::max({motion, V.v.norm() / kStillSpeed, V.w.norm() / kStillTurn});
    }
    if (!(motion < 1)) {
      still_since_[t] = -1;
    } else if (still_since_[t] < 0) {
      still_since_[t] = state.time;
      // it slows down as it has since the instant before: that is when it stops, and not at the first instant it is slow
      const double slowing = since > 0 ? (motion_[t] - motion) / since : 0;
      halted_[t] = state.time + (slowing > 0 ? std::min(motion / slowing, kStillTime) : 0);
    }
    motion_[t] = motion;
  }
}

bool Recorder::all_at_rest(const World& world, const State& state) const {
  for (std::size_t t = 0; t < world.topology.trees.size(); ++t)
    if (still_since_[t] < 0 || state.time - still_since_[t] < kStillTime) return false;
  return !world.topology.trees.empty();
}

void Recorder::snapshot(const World& world, const State& state, Recording& recording) {
  Snapshot s;
  s.time = state.time;
  s.bodies.reserve(state.X_WB.size());
  for (std::size_t b = 0; b < state.X_WB.size(); ++b) s.bodies.push_back({state.X_WB[b], state.V_WB[b]});
  const double since = recording.snapshots.empty() ? 0 : s.time - recording.snapshots.back().time;
  for (Tally& t : tallies_) {
    // an exchange at an instant has no force of its own: its mean over the recorded interval is what an arrow can show
    const double over = t.duration > 0 ? t.duration : since;
    if (over > 0) {
      t.record.force = t.impulse / over;
      t.record.normal_force = t.record.normal_impulse / over;
      t.record.tangential_force = t.record.tangential_impulse / over;
    }
    t.record.impulse = t.impulse;
    s.contacts.push_back(t.record);
  }
  tallies_.clear();
  for (; exchanges_told_ < world.log.exchanges.size(); ++exchanges_told_) {
    ContactRecord c = world.log.exchanges[exchanges_told_];
    if (since > 0) {
      c.force = c.impulse / since;
      c.normal_force = c.normal_impulse / since;
      c.tangential_force = c.tangential_impulse / since;
    }
    s.contacts.push_back(c);
  }
  for (std::size_t i = 0; i < state.wheels.size(); ++i) {
    const WheelState& w = state.wheels[i];
    const double h = state.pace.last > 0 ? state.pace.last : 1;
    s.wheels.push_back({w.vehicle, w.wheel, w.hub, w.contact, w.steer, state.wheel_spin[i], w.impulse[0] / h, w.impulse[1] / h,
                        w.impulse[2] / h, w.slip});
  }
  s.tyre_impulse = tyre_impulse_;
  std::fill(tyre_impulse_.begin(), tyre_impulse_.end(), Vec3::Zero());
  s.energies.kinetic = kinetic_energy(world.model, state);
  s.energies.potential = potential_energy(world.model, state) + state.energy.springs;
  s.energies.dissipated = state.energy.dissipated;
  s.energies.added = state.energy.added;
  s.energies.residual = s.energies.kinetic + s.energies.potential - state.energy.initial - state.energy.added;
  for (const double d : state.energy.dissipated) s.energies.residual += d;
  energy_.weigh(state, s.energies);
  recording.snapshots.push_back(std::move(s));
  watch_rest(world, state, since);
}

void Recorder::warn_of_shortfalls(const World& world, std::vector<std::string>& warnings) const {
  auto name = [&](int body) { return body >= 0 ? world.model.bodies[body].name : std::string("the ground"); };
  auto at = [](const Shortfall& s) { return " at " + std::to_string(std::lround(1e3 * s.time)) + " ms"; };
  auto told = [](double value) {
    std::ostringstream text;
    text << std::setprecision(value < 99.5 ? 2 : 4) << value;
    return text.str();
  };
  constexpr const char* kCompare = "; see whether runs of other steps say the same of what follows";
  if (too_deep_.amount > 0)
    warnings.push_back(name(too_deep_.body_a) + " was pressed " + told(1e3 * too_deep_.amount) + " mm into " +
                       name(too_deep_.body_b) + at(too_deep_) +
                       ", more than its thickness: too soft for this blow; give them more stiffness");
  if (world.log.unsettled.amount > kToldUnsettled)
    warnings.push_back("the forces between " + name(world.log.unsettled.body_a) + " and " + name(world.log.unsettled.body_b) +
                       at(world.log.unsettled) + " were solved to " + told(world.log.unsettled.amount) +
                       " m/s only, something is jammed" + kCompare);
  for (const auto& [inside, most] : {std::pair(stood_inside_, kToldInside), std::pair(crossed_, kToldCrossed)})
    if (inside.amount > most)
      warnings.push_back(name(inside.body_a) + " stood " + told(1e3 * inside.amount) + " mm inside " + name(inside.body_b) +
                         at(inside) + kCompare);
  if (overturned_.amount > kToldBeyond)
    warnings.push_back(name(overturned_.body_a) + " was turned " + told(overturned_.amount / kDegree) +
                       " deg beyond its range against " + name(overturned_.body_b) + at(overturned_) + kCompare);
  if (overslid_.amount > kToldInside)
    warnings.push_back(name(overslid_.body_a) + " slid " + told(1e3 * overslid_.amount) + " mm beyond its range against " +
                       name(overslid_.body_b) + at(overslid_) + kCompare);
}

namespace {

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

void Recorder::finish(const World& world, const State& state, Recording& recording) {
  for (std::size_t t = 0; t < world.topology.trees.size(); ++t) {
    if (still_since_[t] < 0 || state.time - still_since_[t] < 0.9 * kStillTime) continue;
    const int root = world.topology.links[world.topology.trees[t].end - 1].body;
    const int person = world.model.bodies[root].person;
    if (person >= 0 && !state.released[person]) continue;
    events_.push_back({std::min(halted_[t], state.time), "rest", root, -1, state.X_WB[root].p, 0});
  }
  recording.events = world.log.events;
  recording.events.insert(recording.events.end(), events_.begin(), events_.end());
  std::stable_sort(recording.events.begin(), recording.events.end(),
                   [](const Event& a, const Event& b) { return a.time < b.time; });
  recording.diagnostics = world.log.diagnostics;
  energy_.close(world, recording.diagnostics);
  recording.diagnostics.max_compression = compression_;
  warn_of_shortfalls(world, recording.diagnostics.warnings);
  warn_of_idle_impacts(world, recording.diagnostics.warnings);
  // the depth of a compliant contact is a deformation, not an error
  const auto part = [&](int b) { return b >= 0 && world.model.bodies[b].person >= 0 && world.model.bodies[b].vehicle < 0; };
  for (const ContactRecord& c : recording.snapshots.back().contacts)
    if (!yields(world.model.settings.contact_law, part(c.body_a) || part(c.body_b)))
      recording.diagnostics.rest_penetration = std::max(recording.diagnostics.rest_penetration, c.depth);
}

}  // namespace engine
