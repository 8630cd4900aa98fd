#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "engine/math/functions.h"
#include "engine/measure/metrics.h"
#include "engine/measure/passage.h"
#include "engine/measure/vehicle_events.h"

namespace engine {

namespace {

/// Highest place [m] of a body's lowest point between its first and second touch of the ground.
std::optional<double> rebound_height(const Model& model, const Recording& recording, int b, const HyperEllipsoid& shape) {
  const auto touched = [&](const Snapshot& s) {  // since the snapshot before
    return std::any_of(s.contacts.begin(), s.contacts.end(),
                       [&](const ContactRecord& c) { return c.body_a == b && c.shapes.on_ground() && c.normal_impulse > 0; });
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

void measure_vehicle(const Model& model, const Recording& recording, const std::vector<Impact>& impacts, int v,
                     std::vector<Metric>& out) {
  const Vehicle& vehicle = model.vehicles[v];
  const auto& all = recording.snapshots;
  double path = 0;
  for (std::size_t i = 1; i < all.size(); ++i)
    path += (all[i].bodies[vehicle.body].X_WB.p - all[i - 1].bodies[vehicle.body].X_WB.p).head<2>().norm();
  out.push_back({"path_m", vehicle.name, path});
  if (const auto rest = rest_of(model, recording, party_of(model, vehicle.body))) {
    const Pose X = recording.at(*rest).bodies[vehicle.body].X_WB;
    const Vec3 ahead = X.q * Vec3::UnitX();
    // a rider's own rest stands under its own name: this is the mount's
    const bool told =
        std::any_of(out.begin(), out.end(), [&](const Metric& m) { return m.key == "rest_s" && m.object == vehicle.name; });
    if (!told) out.push_back({"rest_s", vehicle.name, *rest});
    out.push_back({"rest_x_m", vehicle.name, X.p.x()});
    out.push_back({"rest_y_m", vehicle.name, X.p.y()});
    out.push_back({"rest_heading_deg", vehicle.name, math::atan2(ahead.y(), ahead.x()) * 180 / std::numbers::pi});
  }
  if (model.bodies[vehicle.body].fixed || went_through(model, recording, v)) return;
  const std::optional<ImpactSide> worst = hardest_event(model, recording, impacts, v);
  if (!worst) return;
  out.push_back({"delta_v_mps", vehicle.name, worst->delta_v.norm()});
  if (std::isfinite(worst->ees)) out.push_back({"ees_mps", vehicle.name, worst->ees});
  if (std::isfinite(worst->pdof)) out.push_back({"pdof_deg", vehicle.name, worst->pdof});
}

}  // namespace engine
