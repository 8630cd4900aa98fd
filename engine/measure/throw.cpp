#include <algorithm>
#include <cmath>

#include "engine/measure/metrics.h"
#include "engine/measure/phases.h"

namespace engine {
namespace {

void add_throw(const Throw& t, const std::string& name, std::vector<Metric>& out) {
  if (t.rest) out.push_back({"rest_s", name, *t.rest});
  out.push_back({"throw_distance_m", name, t.thrown.norm()});
  out.push_back({"throw_along_m", name, t.thrown.dot(t.along)});
  out.push_back({"throw_across_m", name, t.thrown.dot(Vec3::UnitZ().cross(t.along))});
}

const char* key_of(const std::string& phase) {
  if (phase == "contact") return "contact_m";
  if (phase == "carried") return "carried_m";
  if (phase == "flight") return "airborne_m";
  if (phase == "fall") return "fall_m";
  return phase == "landing" ? "landing_m" : "slide_m";
}

/// Nobody struck it: how far it moved, and when it fell and came to rest.
void measure_unstruck(const Model& model, const Recording& recording, const Party& party, std::vector<Metric>& out) {
  const std::string& name = model.persons[party.person].name;
  if (const auto rest = rest_of(model, recording, party)) out.push_back({"rest_s", name, *rest});
  for (const Event& e : recording.events)
    if (e.kind == "ground_contact" && holds(party, e.body_a)) {
      out.push_back({"first_ground_contact_s", name, e.time});
      break;
    }
  const Vec3 travelled =
      centre_of_mass(model, party, recording.snapshots.back()) - centre_of_mass(model, party, recording.snapshots.front());
  out.push_back({"travel_m", name, travelled.head<2>().norm()});
}

/// First instant after `from` at which a vehicle that is not its own mount is above the hips: these are within the box of its
/// bodywork seen from above, and lower than who lies on any bonnet.
std::optional<double> passed_over(const Model& model, const Recording& recording, const Person& person, double from) {
  constexpr double kLow = 0.4;  // [m] over the ground as the mesh stands on it
  for (const Snapshot& s : recording.snapshots) {
    if (s.time < from || person.hips < 0) continue;
    for (const Vehicle& v : model.vehicles) {
      const auto* shape = std::get_if<MeshShape>(&model.bodies[v.body].shape);
      if (!shape || v.body == person.mount) continue;
      const Aabb box = shape->mesh->bounds();
      const Vec3 hips_M = (s.bodies[v.body].X_WB * shape->X_BM).inverse() * s.bodies[person.hips].X_WB.p;
      const bool within =
          hips_M.x() > box.lower.x() && hips_M.x() < box.upper.x() && hips_M.y() > box.lower.y() && hips_M.y() < box.upper.y();
      if (within && hips_M.z() < kLow) return s.time;
    }
  }
  return std::nullopt;
}

}  // namespace

void measure_throw(const Model& model, const Recording& recording, int p, std::vector<Metric>& out) {
  const Person& person = model.persons[p];
  if (const auto mount = throw_of_mount(model, recording, p)) {
    add_throw(*mount, model.bodies[person.mount].name, out);
  }
  const auto t = throw_of_person(model, recording, p);
  if (!t) return measure_unstruck(model, recording, {p, -1, person.bodies}, out);
  add_throw(*t, person.name, out);
  // who lies there from the start does not land
  if (const auto over = passed_over(model, recording, person, t->landed.value_or(t->hit)))
    out.push_back({"passed_over_s", person.name, *over});
  for (const Event& e : recording.events)
    if (e.kind == "run_over" && model.bodies[e.body_a].person == p) {
      out.push_back({"run_over_s", person.name, e.time});
      const std::string& part = model.bodies[e.body_a].name;
      out.push_back({"run_over_part", person.name, 0, part.substr(part.find('/') + 1) + " by " + model.bodies[e.body_b].name});
      break;
    }
  for (const ThrowPhase& phase : t->phases)
    if (phase.name != std::string("rest")) out.push_back({key_of(phase.name), person.name, phase.distance});
  if (!t->landed) return;
  for (const char* phase : {"landing", "slide"})  // it came down without a bounce, or stayed where it came down
    if (std::none_of(t->phases.begin(), t->phases.end(), [&](const ThrowPhase& there) { return there.name == std::string(phase); }))
      out.push_back({key_of(phase), person.name, 0});
  out.push_back({"landing_s", person.name, *t->landed});
  out.push_back({"first_ground_contact_s", person.name, *t->landed});
}

}  // namespace engine
