#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "engine/math/functions.h"
#include "engine/measure/metrics.h"

namespace engine {

namespace {

/// Highest place [m] of a body's lowest point between its first and second touch of the ground.
std::optional<double> rebound_height(const Model& model, const Recording& recording, int b, const HyperEllipsoid& shape) {
  const auto touched = [&](const Snapshot& s) {  // since the snapshot before
    return std::any_of(s.contacts.begin(), s.contacts.end(), [&](const ContactRecord& c) {
      return c.body_a == b && (c.kind == ContactKind::ground || c.kind == ContactKind::terrain) && c.normal_impulse > 0;
    });
  };
  const auto lowest = [&](const Snapshot& s) {
    const BodyState& body = s.bodies[b];
    return body.X_WB.p.z() - aabb_half_widths(shape, body.X_WB.q).z() - model.ground.height;
  };
  const auto& all = recording.snapshots;
  std::size_t first = 1;  // the first snapshot in the air after a touch
  while (first + 1 < all.size() && !(touched(all[first]) && !touched(all[first + 1]) && all[first].bodies[b].V_WB.v.z() > 0.01))
    ++first;
  std::size_t highest = first;
  std::size_t last = first;  // nothing touches between the snapshots first..last
  while (last + 1 < all.size() && !touched(all[last + 1]))
    if (lowest(all[++last]) > lowest(all[highest])) highest = last;
  if (highest == last) return std::nullopt;  // no bounce, or still rising at the end
  // in the air poses between snapshots are exact: the centre flies a parabola, and the top lies beside the highest snapshot
  double low = all[highest > first ? highest - 1 : first].time, high = all[highest + 1].time;
  while (high - low > 1e-9) {
    const double left = low + (high - low) / 3, right = high - (high - low) / 3;
    if (lowest(recording.at(left)) < lowest(recording.at(right)))
      low = left;
    else
      high = right;
  }
  return lowest(recording.at(low));
}

}  // namespace

void measure_body(const Model& model, const Recording& recording, int b, std::vector<Metric>& out) {
  const std::string& name = model.bodies[b].name;
  const Pose& first = recording.snapshots.front().bodies[b].X_WB;
  const Pose& last = recording.snapshots.back().bodies[b].X_WB;
  out.push_back({"travel_m", name, (last.p - first.p).head<2>().norm()});
  out.push_back({"turned_deg", name, math::angle_between(first.q, last.q) * 180 / std::numbers::pi});
  for (const Event& e : recording.events)
    if (e.kind == "rest" && e.body_a == b) out.push_back({"rest_s", name, e.time});
  if (const auto* shape = std::get_if<HyperEllipsoid>(&model.bodies[b].shape))
    if (const auto height = rebound_height(model, recording, b, *shape)) out.push_back({"rebound_height_m", name, *height});
}

namespace {

/// What contacts with others gave the body over the whole run, and its attitude at the last instant before the first of them.
struct Exchange {
  Vec3 impulse = Vec3::Zero();  // [N s] world
  Quat q_WB = Quat::Identity();
};

Exchange exchange_of(const Recording& recording, int body) {
  Exchange out;
  bool begun = false;
  for (std::size_t i = 0; i < recording.snapshots.size(); ++i)
    for (const ContactRecord& c : recording.snapshots[i].contacts) {
      if (c.kind != ContactKind::vehicle && c.kind != ContactKind::vehicle_pair) continue;
      const double sign = c.body_a == body ? 1 : (c.body_b == body ? -1 : 0);
      if (sign == 0 || c.impulse.isZero(0)) continue;
      // the impulses of a snapshot were exchanged since the one before: that one still has the attitude of the approach
      if (!begun) out.q_WB = recording.snapshots[i > 0 ? i - 1 : 0].bodies[body].X_WB.q;
      begun = true;
      out.impulse += sign * c.impulse;
    }
  return out;
}

/// Share of the deformation energy of its Kudlich-Slibar impacts: two vehicles are pressed together by the same force, taken over
/// the same depth, so each has half; a barrier that is part of the world is rigid and leaves all to the vehicle.
double deformation_energy(const Model& model, const Recording& recording, int body) {
  double sum = 0;
  for (const Snapshot& s : recording.snapshots)
    for (const ContactRecord& c : s.contacts) {
      if (c.energy_lost == 0 || (c.body_a != body && c.body_b != body)) continue;
      const int other = c.body_a == body ? c.body_b : c.body_a;
      sum += model.bodies[other].fixed ? c.energy_lost : 0.5 * c.energy_lost;
    }
  return sum;
}

}  // namespace

void measure_vehicle(const Model& model, const Recording& recording, int v, std::vector<Metric>& out) {
  const Vehicle& vehicle = model.vehicles[v];
  const Exchange exchange = exchange_of(recording, vehicle.body);
  const double delta_v = exchange.impulse.norm() / model.bodies[vehicle.body].mass;
  if (delta_v <= 0) return;
  out.push_back({"delta_v_mps", vehicle.name, delta_v});
  Vec3 push = exchange.q_WB.conjugate() * exchange.impulse;
  if (std::abs(push.y()) < 1e-6 * push.norm()) push.y() = 0;  // square from behind is 180 deg, not now and then -180
  if (const double energy = deformation_energy(model, recording, vehicle.body); energy > 0)
    out.push_back({"ees_mps", vehicle.name, std::sqrt(2 * energy / model.bodies[vehicle.body].mass)});
  out.push_back({"pdof_deg", vehicle.name, math::atan2(push.y(), -push.x()) * 180 / std::numbers::pi});
}

}  // namespace engine
