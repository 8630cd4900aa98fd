#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/measure/metrics.h"

namespace engine {

void measure_body(const Model& model, const Recording& recording, int b, std::vector<Metric>& out) {
  const std::string& name = model.bodies[b].name;
  const auto& first = recording.snapshots.front().bodies[b];
  const auto& last = recording.snapshots.back().bodies[b];
  out.push_back({"travel_m", name, (last.X_WB.p - first.X_WB.p).head<2>().norm()});
  for (const Event& e : recording.events)
    if (e.kind == "rest" && e.body_a == b) out.push_back({"rest_s", name, e.time});
  // first rebound: highest place between the first and the second touch of the ground
  const auto* shape = std::get_if<HyperEllipsoid>(&model.bodies[b].shape);
  if (!shape) return;
  int stage = 0;   // 0 before the first touch, 1 rising, 2 past the top
  double top = 0;
  for (std::size_t i = 1; i < recording.snapshots.size() && stage < 2; ++i) {
    const Snapshot& s = recording.snapshots[i];
    const BodyState& body = s.bodies[b];
    const bool touched = std::any_of(s.contacts.begin(), s.contacts.end(), [&](const ContactRecord& c) {
      return c.body_a == b && (c.kind == ContactKind::ground || c.kind == ContactKind::terrain) && c.normal_impulse > 0;
    });
    const double lowest = body.X_WB.p.z() - aabb_half_widths(*shape, body.X_WB.q).z() - model.ground.height;
    if (stage == 0 && touched && body.V_WB.v.z() > 0.01) stage = 1;
    if (stage != 1) continue;
    // between snapshots the top is where the vertical velocity vanishes
    const double g = model.settings.gravity.norm();
    const double v = body.V_WB.v.z();
    if (v > 0 && g > 0) top = lowest + v * v / (2 * g);
    if (v <= 0) stage = 2;
  }
  if (stage == 2) out.push_back({"rebound_height_m", name, top});
}

void measure_vehicle(const Model& model, const Recording& recording, int v, std::vector<Metric>& out) {
  const Vehicle& vehicle = model.vehicles[v];
  Vec3 impulse = Vec3::Zero();
  for (const Snapshot& s : recording.snapshots)
    for (const ContactRecord& c : s.contacts) {
      if (c.kind != ContactKind::vehicle && c.kind != ContactKind::vehicle_pair) continue;
      const double sign = c.body_a == vehicle.body ? 1 : (c.body_b == vehicle.body ? -1 : 0);
      const double force = c.force.norm();
      const double size = std::hypot(c.normal_impulse, c.tangential_impulse);
      if (sign != 0 && force > 0) impulse += sign * size / force * c.force;
    }
  const double delta_v = impulse.norm() / model.bodies[vehicle.body].mass;
  if (delta_v <= 0) return;
  out.push_back({"delta_v_mps", vehicle.name, delta_v});
  // principal direction of force in the vehicle's axes at the start, 0 deg: pushed backwards by a hit on the front
  const Vec3 push = model.bodies[vehicle.body].X_WB.q.conjugate() * impulse;
  out.push_back({"pdof_deg", vehicle.name, std::atan2(push.y(), -push.x()) * 180 / std::numbers::pi});
}

}  // namespace engine
