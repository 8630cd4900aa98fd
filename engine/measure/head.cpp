#include <algorithm>
#include <cmath>

#include "engine/math/functions.h"
#include "engine/measure/metrics.h"
#include "engine/measure/parties.h"

namespace engine {
namespace {

/// Whether the vehicle came with its front: how it and the person neared each other before they first touched, not as the head came
/// down. That may be upright, or across, on a car that has lost its speed by then.
bool came_with_its_front(const Model& model, const Recording& recording, const Event& head) {
  const int p = model.bodies[head.body_a].person;
  const Party person{p, -1, model.persons[p].bodies};
  double first = head.time;
  for (const Event& e : recording.events)
    if (e.kind == "first_contact" && e.body_b == head.body_b && holds(person, e.body_a)) first = std::min(first, e.time);
  const Snapshot& before = found_at(recording, first);
  const BodyState& vehicle = before.bodies[head.body_b];
  const Vec3 person_B = vehicle.X_WB.q.conjugate() * (velocity_of(model, person, before) - vehicle.V_WB.v);
  constexpr double kNears = 0.3;  // [m/s] slower, it rides along: who slides off a roof did not wrap round the front
  return -person_B.x() > std::max(kNears, std::abs(person_B.y()));
}

bool is_beside(Panel panel) {
  return panel == Panel::side || panel == Panel::side_window || panel == Panel::rear || panel == Panel::rear_window;
}

/// Whether it was a wheel that the head met: what is said of the bodywork about it is none of it.
bool by_wheel(const Recording& recording, const Event& e) {
  for (const Snapshot& s : recording.snapshots)
    for (const ContactRecord& c : s.contacts)
      if (s.time >= e.time && c.body_a == e.body_a && c.body_b == e.body_b && c.normal_impulse > 0)
        return c.shapes.b == ShapeKind::tyre;
  return false;
}

/// Where the head struck, in the axes of the vehicle as its mesh was drawn: the origin of the mesh, x forward, y left, z up.
void measure_place(const Model& model, const Recording& recording, const Event& e, const std::string& name,
                   std::vector<Metric>& out) {
  const auto* shape = std::get_if<MeshShape>(&model.bodies[e.body_b].shape);
  if (!shape) return;
  const Pose X_WB = recording.at(e.time).bodies[e.body_b].X_WB;
  const Vec3 point_B = X_WB.inverse() * e.point, point_M = shape->X_BM.inverse() * point_B;
  const bool wheel = by_wheel(recording, e);
  Panel panel = Panel::unknown;
  if (shape->panels && !wheel) {
    const Vec3 normal_M = shape->X_BM.q.conjugate() * (X_WB.q.conjugate() * e.normal);
    panel = panel_at(*shape->mesh, *shape->panels, point_M, normal_M);
    // the names are those of cars: a handlebar is no lid of a boot
    if (panel != Panel::unknown && !is_two_wheeler(model, party_of(model, e.body_b)))
      out.push_back({"head_impact_panel", name, 0, name_of(panel)});
  }
  out.push_back({"head_impact_vehicle_x_m", name, point_M.x()});
  out.push_back({"head_impact_vehicle_y_m", name, point_M.y()});
  out.push_back({"head_impact_vehicle_z_m", name, point_M.z()});
  // a tape from the front has a meaning only for a vehicle whose front runs against the person: who flies at its flank and comes
  // down on the bonnet has none, nor has a place of its flanks or behind that leans enough to be seen from above
  const auto tape = wrap_around_distance(model, e.body_b, point_B);
  if (tape && !wheel && !is_beside(panel) && came_with_its_front(model, recording, e))
    out.push_back({"wrap_around_distance_m", name, *tape});
}

}  // namespace

void measure_head(const Model& model, const Recording& recording, int p, std::vector<Metric>& out) {
  const Person& person = model.persons[p];
  for (const Event& e : recording.events) {
    if (e.kind != "head_impact" || e.body_a != person.head) continue;
    const double normal = -e.velocity.dot(e.normal);
    out.push_back({"head_impact_s", person.name, e.time});
    out.push_back({"head_impact_speed_mps", person.name, e.value});
    out.push_back({"head_impact_normal_mps", person.name, normal});
    out.push_back({"head_impact_tangential_mps", person.name, (e.velocity + normal * e.normal).norm()});
    if (e.body_b >= 0) measure_place(model, recording, e, person.name, out);
    break;
  }
  measure_injury(model, recording, p, out);
}

std::string why_no_head_injury(const Model& model) {
  if (yields(model.settings.contact_law, true)) return "";
  return "Default-Auto exchanges impulses in an instant: there is no acceleration to integrate or to have a peak";
}

}  // namespace engine
