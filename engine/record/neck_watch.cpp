#include "engine/record/neck_watch.h"

#include <cmath>
#include <utility>

#include "engine/math/functions.h"

namespace engine {
namespace {

constexpr double kStretch = 3e-3;  // [s] as of the 3 ms criterion

/// Compression [N] that a test dummy's neck may show: 4 kN of a man of 78 kg (49 CFR 571.208 S6.6), of others with mass^(2/3), as
/// cross-sections go. A child of three comes to 1.3 kN (1.38 in S21.5), one of six to 1.8 kN (1.82 in S23.5).
double allowed(const Model& model, const Person& person) {
  double mass = 0;
  for (const int b : person.bodies) mass += model.bodies[b].mass;
  return 4000 * math::pow(mass / 78, 2.0 / 3);
}

/// "14.7 kN".
std::string in_kilonewtons(double force) {
  const long tenths = std::lround(force / 100);
  return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) + " kN";
}

}  // namespace

NeckWatch::NeckWatch(const World& world) {
  if (!yields(world.model.settings.contact_law, true)) return;
  for (const Person& person : world.model.persons)
    of_person_.push_back({.velocity = person.head < 0 ? Vec3(Vec3::Zero()) : world.model.bodies[person.head].V_WB.v});
}

void NeckWatch::note(const World& world, const Constraint& c) {
  if (of_person_.empty() || c.impulse[0] <= 0) return;
  const Model& model = world.model;
  for (const auto& [part, sign] : {std::pair{c.a.record, 1.0}, std::pair{c.b.record, -1.0}}) {
    if (part < 0 || model.bodies[part].person < 0) continue;
    const int p = model.bodies[part].person;
    if (model.persons[p].head != part) continue;
    of_person_[p].pushed = true;
    of_person_[p].impulse += sign * (c.frame * c.impulse);
  }
}

void NeckWatch::follow(const World& world, const State& state) {
  for (std::size_t p = 0; p < of_person_.size(); ++p) {
    const int head = world.model.persons[p].head;
    Stretch& s = of_person_[p];
    if (head < 0) continue;
    const double length = state.time - s.since;
    if (s.pushed && length < kStretch) continue;
    if (s.pushed) {
      const Vec3 own = world.model.bodies[head].mass * (state.V_WB[head].v - s.velocity - length * world.model.settings.gravity);
      if (const double force = (s.impulse - own).norm() / length; force > s.force) s.force = force, s.time = s.since;
    }
    s.pushed = false;
    s.impulse.setZero();
    s.since = state.time;
    s.velocity = state.V_WB[head].v;
  }
}

void NeckWatch::close(const World& world, std::vector<std::string>& warnings) const {
  constexpr double kTold = 2;  // [-] times what a dummy's may: one that takes less may have held
  for (std::size_t p = 0; p < of_person_.size(); ++p) {
    const Person& person = world.model.persons[p];
    const double may = allowed(world.model, person);
    if (of_person_[p].force <= kTold * may) continue;
    warnings.push_back("the neck of " + person.name + " carried " + in_kilonewtons(of_person_[p].force) + " at " +
                       std::to_string(std::lround(1e3 * of_person_[p].time)) + " ms, where a test dummy's may carry " +
                       in_kilonewtons(may) + ": a real one gives way, do not rely on the head criteria of that blow");
  }
}

}  // namespace engine
