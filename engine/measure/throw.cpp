#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/measure/metrics.h"

namespace engine {
namespace {

Vec3 centre_of_mass(const Model& model, const Person& person, const Snapshot& s) {
  Vec3 sum = Vec3::Zero();
  double mass = 0;
  for (const int b : person.bodies) {
    sum += model.bodies[b].mass * s.bodies[b].X_WB.p;
    mass += model.bodies[b].mass;
  }
  return sum / mass;
}

std::optional<Event> first_event(const Model& model, const Recording& recording, int person, const std::string& kind) {
  for (const Event& e : recording.events)
    if (e.kind == kind && e.body_a >= 0 && model.bodies[e.body_a].person == person) return e;
  return std::nullopt;
}

/// Last time a vehicle pushed the person before `until`.
double last_vehicle_contact(const Model& model, const Recording& recording, int person, double until) {
  double last = 0;
  for (const Snapshot& s : recording.snapshots) {
    if (s.time > until) break;
    for (const ContactRecord& c : s.contacts)
      if (c.kind == ContactKind::vehicle && c.normal_impulse > 0 && model.bodies[c.body_a].person == person) last = s.time;
  }
  return last;
}

}  // namespace

void measure_throw(const Model& model, const Recording& recording, int p, std::vector<Metric>& out) {
  const Person& person = model.persons[p];
  auto add = [&](const char* key, double value) { out.push_back({key, person.name, value}); };
  const auto rest = first_event(model, recording, p, "rest");
  const double end = rest ? rest->time : recording.end_time();
  if (rest) add("rest_s", rest->time);
  const auto ground = first_event(model, recording, p, "ground_contact");
  if (ground) add("first_ground_contact_s", ground->time);
  const auto hit = first_event(model, recording, p, "first_contact");
  if (!hit) {  // nobody struck: how far it slid
    const Vec3 travelled =
        centre_of_mass(model, person, recording.snapshots.back()) - centre_of_mass(model, person, recording.snapshots.front());
    add("travel_m", travelled.head<2>().norm());
    return;
  }
  const Snapshot at_hit = recording.at(hit->time);
  const Vec3 from = centre_of_mass(model, person, at_hit);
  const Vec3 thrown = centre_of_mass(model, person, recording.at(end)) - from;
  add("throw_distance_m", thrown.head<2>().norm());
  Vec3 heading = at_hit.bodies[hit->body_b].X_WB.q * Vec3::UnitX();
  heading.z() = 0;
  heading.normalize();
  add("throw_along_m", thrown.dot(heading));
  add("throw_across_m", thrown.dot(Vec3::UnitZ().cross(heading)));
  if (!ground) return;
  const double released = std::min(last_vehicle_contact(model, recording, p, ground->time), ground->time);
  const Vec3 landed = centre_of_mass(model, person, recording.at(ground->time));
  add("airborne_m", (landed - centre_of_mass(model, person, recording.at(released))).head<2>().norm());
  add("slide_m", (centre_of_mass(model, person, recording.at(end)) - landed).head<2>().norm());
}

}  // namespace engine
