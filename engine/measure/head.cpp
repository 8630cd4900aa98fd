#include <algorithm>
#include <cmath>

#include "engine/math/functions.h"
#include "engine/measure/metrics.h"

namespace engine {
namespace {

/// Where the head struck, in the axes of the vehicle as its mesh was drawn: the origin of the mesh, x forward, y left, z up.
void measure_place(const Model& model, const Recording& recording, const Event& e, const std::string& name,
                   std::vector<Metric>& out) {
  const auto* shape = std::get_if<MeshShape>(&model.bodies[e.body_b].shape);
  if (!shape) return;
  const Pose X_WB = recording.at(e.time).bodies[e.body_b].X_WB;
  const Vec3 point_B = X_WB.inverse() * e.point, point_M = shape->X_BM.inverse() * point_B;
  if (shape->panels) {
    const Vec3 normal_M = shape->X_BM.q.conjugate() * (X_WB.q.conjugate() * e.normal);
    const Panel panel = panel_at(*shape->mesh, *shape->panels, point_M, normal_M);
    if (panel != Panel::unknown) out.push_back({"head_impact_panel", name, 0, name_of(panel)});
  }
  out.push_back({"head_impact_vehicle_x_m", name, point_M.x()});
  out.push_back({"head_impact_vehicle_y_m", name, point_M.y()});
  out.push_back({"head_impact_vehicle_z_m", name, point_M.z()});
  // a tape from the front has a meaning only for a vehicle whose front runs against the person: who flies at its flank and comes
  // down on the bonnet has none
  const Vec3 velocity_B = X_WB.q.conjugate() * e.velocity;
  const bool forwards = velocity_B.x() < 0 && -velocity_B.x() > std::abs(velocity_B.y());
  const auto tape = wrap_around_distance(model, e.body_b, point_B);
  if (forwards && tape) out.push_back({"wrap_around_distance_m", name, *tape});
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
