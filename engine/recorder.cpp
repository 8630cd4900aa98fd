#include "engine/recorder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/math/functions.h"
#include "engine/measure/parties.h"

namespace engine {
namespace {

constexpr double kStillSpeed = 0.05;  // [m/s]
constexpr double kStillTurn = 0.3;    // [rad/s]
constexpr double kAirborne = 0.05;    // [s] who lay there is off the ground after that long

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

/// How fast a body of that motion is, by what counts as still.
double pace_of(const Twist& V) {
  return std::max(V.v.norm() / kStillSpeed, V.w.norm() / kStillTurn);
}

/// Of the fastest body of a tree, whatever it does.
double motion_of(const World& world, const State& state, std::size_t tree) {
  double motion = 0;
  for (int l = world.topology.trees[tree].begin; l < world.topology.trees[tree].end; ++l)
    motion = std::max(motion, pace_of(state.V_WB[world.topology.links[l].body]));
  return motion;
}

}  // namespace

Twist travel_of(const Model& model, int b, const Pose& X, const Twist& V) {
  constexpr double kUpright = 0.7;                // [-] cosine: leaning by 45 deg it is about to fall on its side
  constexpr double kRocks = 0.5, kBounces = 0.3;  // [rad/s], [m/s] more is no rocking on springs
  const int v = model.bodies[b].vehicle;
  if (v < 0 || model.vehicles[v].body != b || model.vehicles[v].wheels.empty()) return V;
  const Vec3 up = X.q * Vec3::UnitZ();
  const double yaw = up.dot(V.w);
  if (up.z() < kUpright || (V.w - yaw * up).norm() > kRocks || std::abs(up.dot(V.v)) > kBounces) return V;
  double height = 0;  // of the road, from the centre
  for (const Wheel& wheel : model.vehicles[v].wheels) height += wheel.hub_B.z() - wheel.radius;
  const Vec3 at_road = V.v + height / static_cast<double>(model.vehicles[v].wheels.size()) * V.w.cross(up);
  return {yaw * up, at_road - up.dot(at_road) * up};
}

Recorder::Recorder(const World& world, const State& state)
    : still_since_(world.topology.trees.size(), -1),
      rest_since_(world.topology.trees.size(), -1),
      has_trunk_(world.topology.trees.size(), 0),
      halted_(world.topology.trees.size(), 0),
      motion_(world.topology.trees.size(), 0),
      step_motion_(world.topology.trees.size(), 0),
      hit_vehicle_(world.model.persons.size(), 0),
      hit_head_(world.model.persons.size(), 0),
      hit_ground_(world.model.persons.size(), 0),
      run_over_(world.model.persons.size() * world.model.vehicles.size(), 0),
      trunk_(world.model.bodies.size(), 0),
      lying_(world.model.persons.size(), 0),
      tyre_impulse_(world.model.vehicles.size(), Vec3::Zero()),
      last_ground_(world.model.persons.size(), 0),
      last_trunk_(world.model.persons.size(), -1) {
  tallies_.reserve(kRoom);
  events_.reserve(kRoom);
  for (auto* list : {&moving_, &lying_on_}) list->reserve(world.model.persons.size());
  for (int t = 0; t < static_cast<int>(world.topology.trees.size()); ++t)
    if (world.topology.trees[t].end - world.topology.trees[t].begin == 1) alone_.push_back(t);
  keep(world, state);
  for (std::size_t p = 0; p < world.model.persons.size(); ++p)
    for (const int b : trunk_of(world.model, static_cast<int>(p))) {
      trunk_[b] = 1;
      const auto* shape = std::get_if<HyperEllipsoid>(&world.model.bodies[b].shape);
      if (!shape) continue;
      const double lowest = state.X_WB[b].p.z() - aabb_half_widths(*shape, state.X_WB[b].q).z();
      lying_[p] = lying_[p] || lowest - world.model.ground.height < 0.02;
      if (lying_[p]) last_trunk_[p] = 0;
    }
  for (std::size_t t = 0; t < has_trunk_.size(); ++t)
    for (int l = world.topology.trees[t].begin; l < world.topology.trees[t].end; ++l)
      has_trunk_[t] = has_trunk_[t] || trunk_[world.topology.links[l].body];
}

void Recorder::keep(const World& world, const State& state) {
  if (before_.size() != state.X_WB.size() || kept_ != world.still.changes) {
    before_.resize(state.X_WB.size());
    for (std::size_t b = 0; b < before_.size(); ++b) before_[b] = {state.X_WB[b], state.V_WB[b]};
  }
  for (const int b : world.still.others) before_[b] = {state.X_WB[b], state.V_WB[b]};
  kept_ = world.still.changes;
}

/// The first touch of a head with a vehicle: how fast its centre came upon the surface there.
void Recorder::note_head(const Constraint& c, double time) {
  const BodyState& head = before_[c.a.record];
  Vec3 velocity = head.V_WB.v;
  if (c.b.record >= 0) {
    const BodyState& struck = before_[c.b.record];
    velocity -= struck.V_WB.v + struck.V_WB.w.cross(c.point - struck.X_WB.p);
  }
  events_.push_back({time, "head_impact", c.a.record, c.b.record, c.point, velocity.norm(), c.frame.col(0), velocity});
}

void Recorder::note(const char* kind, const Constraint& c, double time) {
  events_.push_back({time, kind, c.a.record, c.b.record, c.point, std::max(0.0, -c.u.before[0]), c.frame.col(0), Vec3::Zero()});
}

void Recorder::watch_vehicle(const World& world, const Constraint& c, int person, double time) {
  if (!hit_vehicle_[person]) {
    note("first_contact", c, time);
    // who has fallen before is thrown from where it lies, and comes down anew
    hit_ground_[person] = 0;
    lying_[person] = time - last_trunk_[person] <= kAirborne;
  }
  hit_vehicle_[person] = 1;
  if (is_fixture(world.model, c.b.record)) return;
  if (c.a.record == world.model.persons[person].head && !hit_head_[person]) {
    note_head(c, time);
    hit_head_[person] = 1;
  }
  // a wheel that shoves a limb ahead of it, or climbs it, does not stand on it yet
  constexpr double kOnTop = 0.9;  // [-] upright part of the normal: 26 degrees
  const int vehicle = world.model.bodies[c.b.record].vehicle;
  if (c.shapes.b != ShapeKind::tyre || vehicle < 0 || !(-c.frame.col(0).z() > kOnTop)) return;
  char& told = run_over_[static_cast<std::size_t>(person) * world.model.vehicles.size() + static_cast<std::size_t>(vehicle)];
  if (!told) note("run_over", c, time);
  told = 1;
}

void Recorder::watch_ground(const Constraint& c, int person, double time) {
  // feet and hands come and go while a person is being struck, carried or walks: who falls comes down on the trunk
  if (time - last_ground_[person] > kAirborne) lying_[person] = 0;
  if (!hit_ground_[person] && trunk_[c.a.record] && !lying_[person]) {
    note("ground_contact", c, time);
    hit_ground_[person] = 1;
  }
  last_ground_[person] = time;
  if (trunk_[c.a.record]) last_trunk_[person] = time;
}

void Recorder::watch_events(const World& world, const Constraint& c, double time) {
  const int person = c.a.record >= 0 ? world.model.bodies[c.a.record].person : -1;
  if (person < 0 || world.model.bodies[c.a.record].vehicle >= 0 || c.impulse[0] <= 0) return;
  const bool fixture = c.shapes.on_vehicle() && is_fixture(world.model, c.b.record);
  if (c.shapes.on_vehicle() && (!fixture || world.model.persons[person].mount >= 0)) watch_vehicle(world, c, person, time);
  if (c.shapes.on_ground() || (fixture && bears(c.frame.col(0)))) watch_ground(c, person, time);
}

/// A part pressed in by all its thickness has slipped through: its law no longer knows from which side it came.
void Recorder::watch_compression(const Constraint& c, double time, double duration) {
  const double depth = -c.gap;
  if (duration <= 0) return;
  // whatever it carries: what is pressed deeper than it is thick is told
  if (depth > c.spring.thickness) too_deep_.note(depth, time, c);
  if (c.impulse[0] < 0.5 * c.spring.stiffness * depth * duration) return;  // slack: it springs back
  compression_ = std::max(compression_, depth);
}

/// What rigid contacts and joints promise to keep. What overlaps at the start is told by itself, and takes its time to part.
void Recorder::watch_bounds(const World& world, const Constraint& c, double time) {
  if (is_compliant(c)) return;
  if (c.kind == ConstraintKind::limit) (c.slides ? overslid_ : overturned_).note(-c.gap, time, c);
  if (is_contact(c) && -c.gap > world.log.overlap_at_start(c.a.record, c.b.record) + kToldInside)
    (c.shapes.between_vehicles() ? crossed_ : stood_inside_).note(-c.gap, time, c);
}

void Recorder::tally(const World& world, const std::vector<Constraint>& conditions, double time, double duration) {
  for (const Constraint& c : conditions) {
    watch_bounds(world, c, time);
    if (c.kind == ConstraintKind::contact)
      tally_contact(world, c, time, duration);
    else if (c.kind == ConstraintKind::wheel && c.b.record >= 0)
      tally_contact(world, seen_from_below(c), time, duration);
    else if (c.kind == ConstraintKind::wheel)
      tyre_impulse_[world.model.bodies[c.a.record].vehicle] += c.frame * c.impulse;
  }
}

void Recorder::tally_contact(const World& world, const Constraint& c, double time, double duration) {
  watch_events(world, c, time - duration);  // the push began with the step
  if (c.impulse[0] <= 0 && c.gap > 0) return;
  if (is_compliant(c)) watch_compression(c, time, duration);
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

void Recorder::sample(const World& world, const State& state, Recording& recording) {
  const bool listed = listed_ == world.still.changes;
  if (!listed) list_parties(world, state);
  watch_waiting(state);
  watch_halt(world, state);
  keep(world, state);
  if (!yields(world.model.settings.contact_law, true) || world.model.persons.empty()) return;
  if (recording.heads.empty()) {
    // one sample a step, and more where steps are divided; a run longer than this grows
    constexpr double kLeast = 4096, kMost = 1e6;
    const Settings& settings = world.model.settings;
    const auto room = static_cast<std::size_t>(std::clamp(1.2 * settings.duration / settings.step, kLeast, kMost));
    for (int p = 0; p < static_cast<int>(world.model.persons.size()); ++p) {
      recording.heads.push_back({p, {}, {}});
      recording.heads.back().acceleration.reserve(room);
    }
    times_.reserve(room);
    recording.peak_acceleration.assign(world.model.bodies.size(), 0);
    for (const Body& body : world.model.bodies) velocity_.push_back(body.fixed ? Vec3(Vec3::Zero()) : body.V_WB.v);
  }
  const double step = state.time - sampled_;
  const auto note_head = [&](int p) {
    const int head = world.model.persons[p].head;
    if (head < 0 || state.V_WB[head].v == velocity_[head]) return;  // of who waits noughts are put in once it matters
    std::vector<double>& acceleration = recording.heads[p].acceleration;
    acceleration.resize(times_.size());
    acceleration.push_back((state.V_WB[head].v - velocity_[head]).norm() / step);
  };
  if (listed) {
    for (const int p : moving_) note_head(p);
  } else {
    for (int p = 0; p < static_cast<int>(world.model.persons.size()); ++p) note_head(p);
  }
  times_.push_back(state.time - 0.5 * step);
  const auto note_peak = [&](std::size_t b) {
    recording.peak_acceleration[b] = std::max(recording.peak_acceleration[b], (state.V_WB[b].v - velocity_[b]).norm() / step);
    velocity_[b] = state.V_WB[b].v;
  };
  if (listed) {
    for (const int b : world.still.others) note_peak(static_cast<std::size_t>(b));
  } else {
    for (std::size_t b = 0; b < velocity_.size(); ++b) note_peak(b);
  }
  sampled_ = state.time;
}

/// Lists who is to be looked at each step: who is still costs nothing.
void Recorder::list_parties(const World& world, const State& state) {
  listed_ = world.still.changes;
  moving_.clear();
  lying_on_.clear();
  for (int p = 0; p < static_cast<int>(world.model.persons.size()); ++p) {
    const Person& person = world.model.persons[p];
    const int tree = world.topology.tree_of_body[person.bodies.front()];
    const bool waits = !state.released[p] || (tree >= 0 && !state.asleep.empty() && state.asleep[tree]);
    if (waits && last_trunk_[p] >= 0) lying_on_.push_back(p);
    if (std::any_of(person.bodies.begin(), person.bodies.end(),
                    [&](int b) { return std::binary_search(world.still.others.begin(), world.still.others.end(), b); }))
      moving_.push_back(p);
  }
}

/// Who lies there in the zero condition, or asleep, goes on lying: its support is in balance, and no contact of it is solved.
void Recorder::watch_waiting(const State& state) {
  for (const int p : lying_on_)
    if (watched_ - last_trunk_[p] <= kAirborne) last_ground_[p] = last_trunk_[p] = state.time;
}

/// Of the fastest body that tells when the tree rests, by its way. A person rests with its trunk: a foot may go on sinking.
double Recorder::travel_of_tree(const World& world, const State& state, std::size_t tree) const {
  double motion = 0;
  for (int l = world.topology.trees[tree].begin; l < world.topology.trees[tree].end; ++l) {
    const int b = world.topology.links[l].body;
    if (has_trunk_[tree] && !trunk_[b]) continue;
    motion = std::max(motion, pace_of(travel_of(world.model, b, state.X_WB[b], state.V_WB[b])));
  }
  return motion;
}

/// A body by itself slides to rest at once, and friction may change on its last steps: the step after which it would stop within
/// two more tells when, but not the one in which it stops. Limbs settle for long: of them the recorded interval tells.
void Recorder::watch_halt(const World& world, const State& state) {
  constexpr double kHum = 3e-4;  // [-] what the solver may leave of a speed that is none
  const double step = state.time - watched_;
  watched_ = state.time;
  for (const int tree : alone_) {
    const auto t = static_cast<std::size_t>(tree);
    const double motion = travel_of_tree(world, state, t), slowed = step_motion_[t] - motion;
    step_motion_[t] = motion;
    if (motion < 1 && motion > std::max(0.5 * slowed, kHum) && motion < 2 * slowed)
      halted_[t] = state.time + motion / slowed * step;
  }
}

void Recorder::watch_rest(const World& world, const State& state, double since) {
  for (std::size_t t = 0; t < world.topology.trees.size(); ++t) {
    if (!stirs_[t] && rest_since_[t] >= 0 && still_since_[t] >= 0 && motion_[t] == 0) continue;  // nothing new
    const double any = motion_of(world, state, t);
    if (!(any < 1))
      still_since_[t] = -1;
    else if (still_since_[t] < 0)
      still_since_[t] = state.time;
    const double motion = travel_of_tree(world, state, t);
    if (!(motion < 1)) {
      rest_since_[t] = -1;
    } else if (rest_since_[t] < 0) {
      rest_since_[t] = state.time;
      // it slows down as it has since the instant before: that is when it stops, and not at the first instant it is slow
      const double slowing = since > 0 && !has_trunk_[t] ? (motion_[t] - motion) / since : 0;
      const bool seen = since > 0 && halted_[t] > state.time - since;   // step by step
      const double wait = slowing > 0 ? motion / slowing : kStillTime;  // long where it rocks or creeps: not by this slowing
      if (!seen) halted_[t] = state.time + (wait < kStillTime ? wait : 0);
    }
    motion_[t] = motion;
  }
}

bool Recorder::all_at_rest(const World& world, const State& state) const {
  for (std::size_t t = 0; t < world.topology.trees.size(); ++t)
    if (still_since_[t] < 0 || state.time - still_since_[t] < kStillTime) return false;
  return !world.topology.trees.empty();
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
  stirs_.assign(world.topology.trees.size(), 0);
  for (const int b : world.still.others)
    if (const int tree = world.topology.tree_of_body[b]; tree >= 0) stirs_[tree] = 1;
  weight_.resize(bodies);
  for (std::size_t b = 0; b < bodies; ++b) weight_[b] = weight_of(world.model, state, static_cast<int>(b));
  shared_ = world.still.changes;
}

/// The sum is over all bodies in order, to the last bit, though only those that are not still are weighed again.
double Recorder::potential(const World& world, const State& state) {
  for (const int b : world.still.others) weight_[b] = weight_of(world.model, state, b);
  double energy = 0;
  for (const double weight : weight_) energy -= weight;
  return energy;
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
  s.energies.kinetic = kinetic_energy(world, state);
  s.energies.potential = potential(world, state) + state.energy.springs;
  s.energies.dissipated = state.energy.dissipated;
  s.energies.added = state.energy.added;
  s.energies.residual = s.energies.kinetic + s.energies.potential - state.energy.initial - state.energy.added;
  for (const double d : state.energy.dissipated) s.energies.residual += d;
  energy_.weigh(state, s.energies);
  recording.snapshots.push_back(std::move(s));
  watch_rest(world, state, since);
}

}  // namespace engine
