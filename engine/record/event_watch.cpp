#include "engine/record/event_watch.h"

#include <algorithm>

#include "engine/math/functions.h"
#include "engine/measure/parties.h"

namespace engine {
namespace {

constexpr double kAirborne = 0.05;  // [s] who lay there is off the ground after that long
constexpr double kLies = 0.02;      // [m] over the ground at the start

/// [N] that the least loaded wheel of each vehicle bears at rest.
std::vector<double> least_loads(const World& world, const State& state) {
  std::vector<double> out(world.model.vehicles.size(), 1e300);
  for (const WheelState& wheel : state.wheels) out[wheel.vehicle] = std::min(out[wheel.vehicle], wheel.static_load);
  return out;
}

/// Whether a tyre of a vehicle that heads `forward` stands on the part. One that shoves a part ahead of it, or climbs it, does not
/// yet: seen from the side its push comes from in front. A shoulder on something round never comes from quite above: there the
/// load tells. A wheel's side that rubs a part bears of it no more than that part weighs; half of what it bears on the road is
/// beyond doubt, and left to the wheel where brakes relieve its axle by a third. From straight above a twentieth is enough: the
/// wheel of a bicycle that falls over brushes who lies there with less.
bool stands_on(const Constraint& c, const Vec3& forward, double least_load, double duration) {
  constexpr double kOnTop = 0.9, kShare = 0.5, kLeast = 0.05;  // [-] upright part of the normal: 26 degrees; of the load
  const Vec3 down = -c.frame.col(0);
  const double load = down.z() * c.impulse[0];
  if (duration <= 0 || load < kLeast * least_load * duration) return false;
  if (down.z() > kOnTop) return true;
  const bool over = down.z() > kOnTop * math::hypot(down.z(), down.dot(forward));
  return over && bears(down) && load > kShare * least_load * duration;
}

}  // namespace

EventWatch::EventWatch(const World& world, const State& state)
    : of_trunk_(trunks_of(world.model)),
      hit_vehicle_(world.model.persons.size(), 0),
      hit_head_(world.model.persons.size(), 0),
      hit_ground_(world.model.persons.size(), 0),
      run_over_(world.model.persons.size() * world.model.vehicles.size(), 0),
      least_load_(least_loads(world, state)),
      lying_(world.model.persons.size(), 0),
      last_ground_(world.model.persons.size(), 0),
      last_trunk_(world.model.persons.size(), -1) {
  events_.reserve(kRoom);
  lying_on_.reserve(world.model.persons.size());
  keep(world, state);
  for (std::size_t b = 0; b < of_trunk_.size(); ++b) {
    const auto* shape = std::get_if<HyperEllipsoid>(&world.model.bodies[b].shape);
    if (!of_trunk_[b] || !shape) continue;
    const int p = world.model.bodies[b].person;
    const double lowest = state.X_WB[b].p.z() - aabb_half_widths(*shape, state.X_WB[b].q).z();
    const auto ground = world.model.ground.height_below(state.X_WB[b].p);
    lying_[p] = lying_[p] || (ground && lowest - *ground < kLies);
    if (lying_[p]) last_trunk_[p] = 0;
  }
}

void EventWatch::keep(const World& world, const State& state) {
  if (before_.size() != state.X_WB.size() || kept_ != world.still.changes) {
    before_.resize(state.X_WB.size());
    for (std::size_t b = 0; b < before_.size(); ++b) before_[b] = {state.X_WB[b], state.V_WB[b]};
  }
  for (const int b : world.still.others) before_[b] = {state.X_WB[b], state.V_WB[b]};
  kept_ = world.still.changes;
}

void EventWatch::note(const char* kind, const Constraint& c, double time) {
  events_.push_back({time, kind, c.a.record, c.b.record, c.point, std::max(0.0, -c.u.before[0]), c.frame.col(0), Vec3::Zero()});
}

/// The first touch of a head with a vehicle: how fast its centre came upon the surface there.
void EventWatch::note_head(const Constraint& c, double time) {
  const BodyState& head = before_[c.a.record];
  Vec3 velocity = head.V_WB.v;
  if (c.b.record >= 0) {
    const BodyState& struck = before_[c.b.record];
    velocity -= struck.V_WB.v + struck.V_WB.w.cross(c.point - struck.X_WB.p);
  }
  events_.push_back({time, "head_impact", c.a.record, c.b.record, c.point, velocity.norm(), c.frame.col(0), velocity});
}

void EventWatch::watch_vehicle(const World& world, const Constraint& c, int person, double time, double duration) {
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
  const int vehicle = world.model.bodies[c.b.record].vehicle;
  const Vec3 forward = before_[c.b.record].X_WB.q * Vec3::UnitX();
  if (c.shapes.b != ShapeKind::tyre || vehicle < 0 || !stands_on(c, forward, least_load_[vehicle], duration)) return;
  char& told = run_over_[static_cast<std::size_t>(person) * world.model.vehicles.size() + static_cast<std::size_t>(vehicle)];
  if (!told) note("run_over", c, time);
  told = 1;
}

void EventWatch::watch_ground(const Constraint& c, int person, double time) {
  // feet and hands come and go while a person is being struck, carried or walks: who falls comes down on the trunk
  if (time - last_ground_[person] > kAirborne) lying_[person] = 0;
  if (!hit_ground_[person] && of_trunk_[c.a.record] && !lying_[person]) {
    note("ground_contact", c, time);
    hit_ground_[person] = 1;
  }
  last_ground_[person] = time;
  if (of_trunk_[c.a.record]) last_trunk_[person] = time;
}

void EventWatch::watch(const World& world, const Constraint& c, double time, double duration) {
  const int person = c.a.record >= 0 ? world.model.bodies[c.a.record].person : -1;
  if (person < 0 || world.model.bodies[c.a.record].vehicle >= 0 || c.impulse[0] <= 0) return;
  const bool struck = is_fixture(world.model, c.b.record) ? world.model.persons[person].mount >= 0 : c.shapes.on_vehicle();
  if (struck) watch_vehicle(world, c, person, time, duration);
  if (is_ground(world.model, c.shapes, c.b.record, c.frame.col(0))) watch_ground(c, person, time);
}

void EventWatch::list_lying(const World& world, const State& state) {
  listed_ = world.still.changes;
  lying_on_.clear();
  for (int p = 0; p < static_cast<int>(world.model.persons.size()); ++p) {
    const int tree = world.topology.tree_of_body[world.model.persons[p].bodies.front()];
    const bool waits = !state.released[p] || (tree >= 0 && !state.asleep.empty() && state.asleep[tree]);
    if (waits && last_trunk_[p] >= 0) lying_on_.push_back(p);
  }
}

/// Who lies there in the zero condition, or asleep, goes on lying: its support is in balance, and no contact of it is solved.
void EventWatch::watch_step(const World& world, const State& state) {
  if (listed_ != world.still.changes) list_lying(world, state);
  for (const int p : lying_on_)
    if (watched_ - last_trunk_[p] <= kAirborne) last_ground_[p] = last_trunk_[p] = state.time;
  watched_ = state.time;
  keep(world, state);
}

}  // namespace engine
