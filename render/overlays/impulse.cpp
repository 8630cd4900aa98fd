// The impulse of a collision between vehicles: an arrow at its point, on either side, and the contact plane it acted in. It
// stays long enough to be read, and goes with the vehicle that was struck; its directions are those it acted in.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "render/matrix.h"
#include "render/overlays/registration.h"

namespace render {
namespace {

constexpr double kShown = 0.4;                // [s] of simulated time
constexpr double kNewtonSecondsAMetre = 4e3;  // that one metre of arrow stands for
constexpr double kMinor = 0.1;                // of the run's largest: those of cars that rub along each other are not shown
constexpr double kPlaneWidth = 1.6, kPlaneHeight = 1.0;  // [m]

void add_plane(const engine::ContactRecord& c, DrawList& list) {
  const Vec3 across = std::abs(c.normal.z()) < 0.9 ? Vec3(Vec3::UnitZ().cross(c.normal).normalized()) : Vec3(Vec3::UnitX());
  const Vec3 up = c.normal.cross(across);
  const Vec3 w = 0.5 * kPlaneWidth * across, h = 0.5 * kPlaneHeight * up;
  LineItem border;
  border.points = {to_float(c.point + w + h), to_float(c.point - w + h), to_float(c.point - w - h), to_float(c.point + w - h),
                   to_float(c.point + w + h)};
  border.colour = {0.35f, 0.78f, 1.00f, 0.95f};
  border.width = 2.2f;
  list.lines.push_back(border);
}

/// Where the point of the first body that was struck has come to.
Vec3 moved_on(const engine::ContactRecord& c, const engine::Snapshot& then, const engine::Snapshot& now) {
  const auto body = static_cast<std::size_t>(c.body_a);
  return now.bodies[body].X_WB * (then.bodies[body].X_WB.inverse() * c.point);
}

/// Where a label keeps farthest off the two that met, level, as they stood then.
Vec3 way_out(const engine::ContactRecord& c, const engine::Snapshot& then) {
  constexpr double kAway = 3.2;  // [m]
  constexpr int kWays = 8;
  Vec3 best = Vec3::Zero();
  double most = -1;  // [m]
  for (int i = 0; i < kWays; ++i) {
    const double angle = 2 * std::numbers::pi * i / kWays;
    const Vec3 way = kAway * Vec3(std::cos(angle), std::sin(angle), 0);
    double nearest = std::numeric_limits<double>::infinity();
    for (const int body : {c.body_a, c.body_b})
      nearest = std::min(nearest, (c.point + way - then.bodies[static_cast<std::size_t>(body)].X_WB.p).head<2>().norm());
    if (nearest > most) most = nearest, best = way;
  }
  return best;
}

/// It stands beside the vehicles, at the end of a line from the point.
LabelItem label_of(const engine::ContactRecord& c, const Vec3& out, DrawList& list) {
  list.lines.push_back({});
  list.lines.back().points = {to_float(c.point), to_float(c.point + out)};
  list.lines.back().colour = {1, 1, 1, 0.7f};
  list.lines.back().width = 1.5f;
  LabelItem label;
  label.lines = {fmt::format("impulse {:.0f} N s", c.impulse.norm()), fmt::format("{:.1f} kJ lost", c.energy_lost / 1000)};
  label.sizes = {20, 20};
  label.colours = {{1, 1, 1, 1}, {1, 0.68f, 0.25f, 1}};
  label.at_world_point = true;
  label.world = to_float(c.point + out);
  label.pivot = {0.5f, 0.5f};
  return label;
}

void add_impulse(const Frame& frame, DrawList& list) {
  double largest = 0;  // [N s]
  for (const auto& s : frame.recording.snapshots)
    for (const auto& c : s.contacts)
      if (c.exchange) largest = std::max(largest, c.impulse.norm());
  for (const auto& s : frame.recording.snapshots) {
    if (s.time > frame.now.time) break;
    if (s.time < frame.now.time - kShown) continue;
    for (engine::ContactRecord c : s.contacts) {
      if (!c.exchange || c.impulse.norm() < kMinor * largest) continue;
      const Vec3 out = way_out(c, s);
      c.point = moved_on(c, s, frame.now);
      const Vec3 arm = c.impulse / kNewtonSecondsAMetre;
      for (const double side : {1.0, -1.0})
        list.arrows.push_back({to_float(c.point), to_float(c.point + side * arm), {1.00f, 0.58f, 0.10f, 1}, 5.0f});
      list.markers.push_back({to_float(c.point), {1, 1, 1, 1}, 6});
      add_plane(c, list);
      list.labels.push_back(label_of(c, out, list));
    }
  }
}

}  // namespace

struct Impulses {
  static constexpr Overlay kOverlay{"impulse", {}, add_impulse, [](const Frame& f) { return f.stage.overlays.on("contacts"); }};
};
template struct Drawn<Impulses>;

}  // namespace render
