#include "engine/measure/parties.h"

#include <algorithm>
#include <cmath>

namespace engine {

Party party_of(const Model& model, int body) {
  const Body& it = model.bodies[body];
  Party party;
  party.vehicle = it.vehicle;
  party.person = it.vehicle >= 0 ? -1 : it.person;
  party.bodies = party.person >= 0 ? model.persons[party.person].bodies : std::vector<int>{body};
  return party;
}

bool holds(const Party& party, int body) {
  return std::find(party.bodies.begin(), party.bodies.end(), body) != party.bodies.end();
}

bool is_two_wheeler(const Model& model, const Party& party) {
  return party.vehicle >= 0 && model.vehicles[party.vehicle].wheels.size() == 2 && !has_track(model.vehicles[party.vehicle]);
}

double mass_of(const Model& model, const Party& party) {
  double mass = 0;
  for (const int b : party.bodies) mass += model.bodies[b].mass;
  return mass;
}

Vec3 centre_of_mass(const Model& model, const Party& party, const Snapshot& s) {
  Vec3 sum = Vec3::Zero();
  for (const int b : party.bodies) sum += model.bodies[b].mass * s.bodies[b].X_WB.p;
  return sum / mass_of(model, party);
}

Vec3 velocity_of(const Model& model, const Party& party, const Snapshot& s) {
  Vec3 sum = Vec3::Zero();
  for (const int b : party.bodies) sum += model.bodies[b].mass * s.bodies[b].V_WB.v;
  return sum / mass_of(model, party);
}

std::vector<int> trunk_of(const Model& model, int p) {
  const Person& person = model.persons[p];
  std::vector<int> trunk;
  const auto add = [&trunk](int b) {
    if (b >= 0 && std::find(trunk.begin(), trunk.end(), b) == trunk.end()) trunk.push_back(b);
  };
  add(person.hips);
  add(person.torso);
  // from the head downwards, joint by joint, to the root
  for (int b = person.head; b >= 0 && b != person.hips;) {
    add(b);
    const auto above =
        std::find_if(model.joints.begin(), model.joints.end(), [b](const Joint& j) { return j.child == b && j.parent >= 0; });
    b = above == model.joints.end() ? -1 : above->parent;
  }
  return trunk;
}

std::vector<char> trunks_of(const Model& model) {
  std::vector<char> of_trunk(model.bodies.size(), 0);
  for (int p = 0; p < static_cast<int>(model.persons.size()); ++p)
    for (const int b : trunk_of(model, p)) of_trunk[b] = 1;
  return of_trunk;
}

std::vector<int> joined_for_good(const Model& model, std::vector<int> joined) {
  for (std::size_t i = 0; i < joined.size(); ++i)
    for (const Joint& j : model.joints) {
      if (std::isfinite(j.breaking_force) || j.parent < 0 || (j.parent != joined[i] && j.child != joined[i])) continue;
      const int other = j.parent == joined[i] ? j.child : j.parent;
      if (std::find(joined.begin(), joined.end(), other) == joined.end()) joined.push_back(other);
    }
  return joined;
}

std::optional<double> joined_until(const Model& model, const Recording& recording, const Party& a, const Party& b) {
  const auto between = [&](int x, int y) { return (holds(a, x) && holds(b, y)) || (holds(b, x) && holds(a, y)); };
  const auto joints =
      std::count_if(model.joints.begin(), model.joints.end(), [&](const Joint& j) { return between(j.parent, j.child); });
  if (joints == 0) return std::nullopt;
  long broken = 0;
  double last = 0;
  for (const Event& e : recording.events)
    if (e.kind == "joint_broken" && between(e.body_a, e.body_b)) ++broken, last = e.time;
  return broken < joints ? recording.end_time() : last;
}

std::optional<double> rest_of(const Model& model, const Recording& recording, const Party& party) {
  // a trailer rests with what tows it: what is joined for good has one rest, named by one of its bodies
  const std::vector<int> joined = joined_for_good(model, party.bodies);
  for (const Event& e : recording.events)
    if (e.kind == "rest" && std::find(joined.begin(), joined.end(), e.body_a) != joined.end()) return e.time;
  return std::nullopt;
}

const Snapshot& found_at(const Recording& recording, double time) {
  // a time that was reckoned may fall a rounding behind the snapshot it means
  const double until = time + 1e-9 * recording.interval;
  const auto& all = recording.snapshots;
  const auto after = std::upper_bound(all.begin(), all.end(), until, [](double t, const Snapshot& s) { return t < s.time; });
  return after == all.begin() ? *after : *(after - 1);
}

bool is_fixture(const Model& model, int body) {
  return body >= 0 && model.bodies[body].fixed && model.bodies[body].vehicle < 0;
}

Vec3 push_on(const Party& party, const ContactRecord& c) {
  const bool a = holds(party, c.body_a), b = c.body_b >= 0 && holds(party, c.body_b);
  if (a == b) return Vec3::Zero();
  return a ? c.impulse : Vec3(-c.impulse);
}

}  // namespace engine
