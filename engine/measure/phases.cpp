#include "engine/measure/phases.h"

#include <algorithm>
#include <cmath>

namespace engine {
namespace {

constexpr double kGoes = 0.3;  // [m/s] slower, a vehicle stands

constexpr double kBreak = 0.05;  // [s] that long off the ground is a flight or a bounce, less is rolling over an edge

struct Touch {
  double time = 0;
  int other = -1;  // body
};

/// First push between the party and a vehicle or mesh that is neither its rider nor its mount; of who is on foot no wall or kerb.
std::optional<Touch> first_touch(const Model& model, const Recording& recording, const Party& party) {
  const auto own = [&](int b) {
    return b >= 0 && std::any_of(party.bodies.begin(), party.bodies.end(), [&](int own_body) {
             return model.bodies[b].person >= 0 && model.bodies[b].person == model.bodies[own_body].person;
           });
  };
  const bool on_foot = party.person >= 0 && model.persons[party.person].mount < 0;
  for (const Event& e : recording.events)
    if (e.kind == "first_contact" && holds(party, e.body_a)) return Touch{e.time, e.body_b};
  for (const Snapshot& s : recording.snapshots) {
    std::optional<Touch> first;
    for (const ContactRecord& c : s.contacts) {
      if (!c.shapes.with_vehicle() || push_on(party, c).isZero(0)) continue;
      const int other = holds(party, c.body_a) ? c.body_b : c.body_a;
      if (on_foot && is_fixture(model, other)) continue;
      if (!own(other) && (!first || c.begun < first->time)) first = Touch{c.begun, other};
    }
    if (first) return first;
  }
  return std::nullopt;
}

/// A door, a load: as long as it hangs there it pushes as the vehicle does.
bool hangs_on_vehicle(const Model& model, const Recording& recording, int body, double time) {
  if (body < 0 || model.bodies[body].person >= 0) return false;
  return std::any_of(model.vehicles.begin(), model.vehicles.end(), [&](const Vehicle& v) {
    const auto until = joined_until(model, recording, party_of(model, body), party_of(model, v.body));
    return until && time <= *until;
  });
}

/// By a vehicle, or by what the party ran into first. A wall that it flies against later ends no throw.
bool pushed_by_vehicle(const Model& model, const Recording& recording, const Party& party, const Snapshot& s, int struck_by,
                       bool moving = false) {
  constexpr double kStands = 0.05;  // [m/s] slower, as at rest, it pushes nobody along
  return std::any_of(s.contacts.begin(), s.contacts.end(), [&](const ContactRecord& c) {
    if (!(c.normal_impulse > 0) || push_on(party, c).isZero(0)) return false;
    const int other = holds(party, c.body_a) ? c.body_b : c.body_a;
    const bool by =
        is_fixture(model, other) ? other == struck_by : c.shapes.on_vehicle() || hangs_on_vehicle(model, recording, other, s.time);
    return by && (!moving || s.bodies[other].V_WB.v.norm() > kStands);
  });
}

/// On the ground, or on what stands on it for good.
bool on_ground(const Model& model, const Party& party, const Snapshot& s) {
  return std::any_of(s.contacts.begin(), s.contacts.end(), [&](const ContactRecord& c) {
    return is_ground(model, c.shapes, c.body_b, c.normal) && c.normal_impulse > 0 && holds(party, c.body_a);
  });
}

/// Whether the trunk is on the ground when it is touched: before it, or just after, since nothing holds who waits until then.
bool lies_at(const Model& model, const Recording& recording, const Party& trunk, double hit) {
  const double around = kBreak + recording.interval;
  return std::any_of(recording.snapshots.begin(), recording.snapshots.end(),
                     [&](const Snapshot& s) { return std::abs(s.time - hit) <= around && on_ground(model, trunk, s); });
}

/// By anything but itself.
bool touched(const Party& party, const Snapshot& s) {
  return std::any_of(s.contacts.begin(), s.contacts.end(),
                     [&](const ContactRecord& c) { return c.normal_impulse > 0 && !push_on(party, c).isZero(0); });
}

/// Level direction in which the faster of the vehicle that touched first and of what the person rides goes at the touch, which a
/// vehicle that backs or skids does not do along its own axis. Of one that stands its axis.
Vec3 heading_of(const Model& model, const Snapshot& s, int struck_by, int mount) {
  int body = struck_by;
  const auto speed = [&](int b) { return b < 0 ? -1.0 : s.bodies[b].V_WB.v.norm(); };
  if (speed(mount) > speed(struck_by)) body = mount;
  // a barrier goes nowhere: what runs against it does
  if (body >= 0 && model.bodies[body].vehicle < 0 && mount >= 0) body = mount;
  Vec3 heading = body < 0 ? Vec3(Vec3::UnitX()) : Vec3(s.bodies[body].X_WB.q * Vec3::UnitX());
  if (body >= 0 && s.bodies[body].V_WB.v.head<2>().norm() > kGoes) heading = s.bodies[body].V_WB.v;
  heading.z() = 0;
  return heading.norm() > 1e-6 ? Vec3(heading.normalized()) : Vec3(Vec3::UnitX());
}

/// First instant up to `to` at which the party goes along the throw as fast as the vehicle does. One that stood when it was touched
/// carries nobody.
std::optional<double> as_fast(const Model& model, const Recording& recording, const Party& party, const Throw& t, double to) {
  if (t.vehicle < 0 || model.bodies[t.vehicle].fixed) return std::nullopt;
  const auto faster = [&](const Snapshot& s) {
    return velocity_of(model, party, s).dot(t.along) >= s.bodies[t.vehicle].V_WB.v.dot(t.along);
  };
  // who was as fast before, a rider that runs into the vehicle, is not taken along by it
  const Snapshot& before = found_at(recording, t.hit);
  if (faster(before) || before.bodies[t.vehicle].V_WB.v.norm() < kGoes) return std::nullopt;
  for (const Snapshot& s : recording.snapshots) {
    if (s.time >= to) break;
    if (s.time > before.time && faster(s)) return s.time;
  }
  return std::nullopt;
}

/// Whether nothing touched the party for a break's time between two instants.
bool flew_between(const Recording& recording, const Party& party, double from, double to) {
  double since = from;
  for (const Snapshot& s : recording.snapshots) {
    if (s.time <= from || s.time > to) continue;
    if (s.time - since >= kBreak) return true;
    if (touched(party, s)) since = s.time;
  }
  return to - since >= kBreak;
}

/// When it had stopped bouncing: it touches the ground from there on without a break.
double settled_after(const Model& model, const Recording& recording, const Party& party, double landed, double end) {
  double settled = landed, last = landed;
  for (const Snapshot& s : recording.snapshots) {
    if (s.time <= landed || s.time > end || !on_ground(model, party, s)) continue;
    if (s.time - last > kBreak) settled = s.time;
    last = s.time;
  }
  return settled;
}

void add_phases(const Model& model, const Recording& recording, const Party& party, Throw& t) {
  const double off = t.separated.value_or(t.end);
  const std::optional<double> carried = as_fast(model, recording, party, t, off);
  std::vector<std::pair<const char*, double>> begins{{"contact", t.hit}};
  if (carried) begins.emplace_back("carried", *carried);
  if (t.landed) {
    begins.emplace_back(t.flew ? "flight" : "fall", off);
    begins.emplace_back("landing", *t.landed);
    begins.emplace_back("slide", settled_after(model, recording, party, *t.landed, t.end));
  }
  if (t.lay && t.separated) begins.emplace_back("slide", *t.separated);
  if (t.rest) begins.emplace_back("rest", *t.rest);
  const double length = t.thrown.norm();
  const Vec3 line = length > 0 ? Vec3(t.thrown / length) : t.along;
  const auto place = [&](double time) { return centre_of_mass(model, party, recording.at(time)); };
  for (std::size_t i = 0; i < begins.size(); ++i) {
    const bool last = i + 1 == begins.size();
    const double from = begins[i].second, to = last ? std::max(from, t.end) : begins[i + 1].second;
    const bool rests = last && t.rest;  // to the end of the run, and no more of the throw
    if (!last && to <= from) continue;
    const Vec3 start = place(from);
    t.phases.push_back({begins[i].first, from, rests ? recording.end_time() : to, start, line.dot(place(to) - start)});
  }
}

Throw thrown_from(const Model& model, const Recording& recording, const Party& party, const Touch& touch, int mount) {
  Throw t;
  t.hit = touch.time;
  t.vehicle = touch.other;
  t.rest = rest_of(model, recording, party);
  if (t.rest && *t.rest < t.hit) t.rest.reset();
  t.end = t.rest.value_or(recording.end_time());
  const Snapshot at_hit = recording.at(t.hit);
  t.along = heading_of(model, found_at(recording, t.hit), touch.other, mount);
  t.thrown = centre_of_mass(model, party, recording.at(t.end)) - centre_of_mass(model, party, at_hit);
  t.thrown.z() = 0;
  return t;
}

}  // namespace

std::optional<Throw> throw_of_person(const Model& model, const Recording& recording, int p) {
  const Person& person = model.persons[p];
  const Party party{p, -1, person.bodies};
  std::optional<Touch> touch = first_touch(model, recording, party);
  if (person.mount >= 0) {
    const auto of_mount = first_touch(model, recording, party_of(model, person.mount));
    if (of_mount && (!touch || of_mount->time < touch->time)) touch = of_mount;
  }
  if (!touch) return std::nullopt;
  Throw t = thrown_from(model, recording, party, *touch, person.mount);
  for (const Event& e : recording.events)
    if (e.kind == "ground_contact" && !t.landed && holds(party, e.body_a) && e.time >= t.hit && e.time <= t.end) t.landed = e.time;
  bool came_down = false;
  for (const Snapshot& s : recording.snapshots) {
    if (s.time < t.hit) continue;
    const bool pushed = pushed_by_vehicle(model, recording, party, s, t.vehicle), down = s.time >= t.landed.value_or(t.end);
    // the push of the interval in which it landed may be older than that
    if (s.time - recording.interval >= t.landed.value_or(t.end) && s.time <= t.end &&
        pushed_by_vehicle(model, recording, party, s, t.vehicle, true))
      t.dragged = true;
    if (pushed && !came_down) t.separated = std::min(s.time, t.landed.value_or(t.end));
    came_down = down;
  }
  // a rider that nothing but its mount was struck with leaves when that lets go of it
  if (!t.separated && t.landed) t.separated = t.hit;
  const auto off = person.mount >= 0 ? joined_until(model, recording, party, party_of(model, person.mount)) : std::nullopt;
  if (off && t.separated) t.separated = std::min(std::max(*t.separated, *off), t.landed.value_or(t.end));
  t.lay = !t.landed && lies_at(model, recording, {p, -1, trunk_of(model, p)}, t.hit);
  t.flew = t.landed && flew_between(recording, party, *t.separated, *t.landed);
  add_phases(model, recording, party, t);
  return t;
}

std::optional<Throw> throw_of_mount(const Model& model, const Recording& recording, int p) {
  const int mount = model.persons[p].mount;
  if (mount < 0) return std::nullopt;
  const Party party = party_of(model, mount);
  const auto touch = first_touch(model, recording, party);
  if (!touch) return std::nullopt;
  return thrown_from(model, recording, party, *touch, mount);
}

}  // namespace engine
