// The impulse of a collision between vehicles: an arrow at its point, on either side, and the contact plane it acted in. It
// stays long enough to be read, and goes with the vehicle that was struck; its directions are those it acted in.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

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

/// Where in the picture, in halves of its height from the middle; across it less, as labels are wider than high.
Eigen::Vector2d in_picture(const Frame& frame, const View& view, const Vec3& p) {
  constexpr double kWide = 0.4;
  const Eigen::Vector4d c = from_gl(view.eye_to_clip) * from_gl(view.world_to_eye) * Eigen::Vector4d(p.x(), p.y(), p.z(), 1);
  const double w = std::max(c.w(), 1e-3);
  return {kWide * frame.aspect * c.x() / w, c.y() / w};
}

/// From the point to where a label keeps farthest off the two that met, as they are seen now: on a side, or above.
Vec3 way_out(const Frame& frame, const View& view, const engine::ContactRecord& c) {
  constexpr double kAway = 3.2, kAbove = 2.4;         // [m]
  constexpr double kHalfLength = 1.8, kHeight = 0.8;  // [m] of a car, from its centre of mass
  constexpr int kWays = 8;
  std::vector<Eigen::Vector2d> taken;
  for (const int body : {c.body_a, c.body_b})
    for (const double x : {-kHalfLength, 0.0, kHalfLength})
      for (const double z : {0.0, kHeight})
        taken.push_back(in_picture(frame, view, frame.now.bodies[static_cast<std::size_t>(body)].X_WB * Vec3(x, 0, z)));
  Vec3 best = kAbove * Vec3::UnitZ();
  const auto clearance = [&](const Vec3& way) {
    const Eigen::Vector2d at = in_picture(frame, view, c.point + way);
    double nearest = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector2d& p : taken) nearest = std::min(nearest, (at - p).norm());
    return nearest;
  };
  for (int i = 0; i < kWays; ++i) {
    const double angle = 2 * std::numbers::pi * i / kWays;
    const Vec3 way = kAway * Vec3(std::cos(angle), std::sin(angle), 0);
    if (clearance(way) > clearance(best)) best = way;
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
      c.point = moved_on(c, s, frame.now);
      const Vec3 arm = c.impulse / kNewtonSecondsAMetre;
      for (const double side : {1.0, -1.0})
        list.arrows.push_back({to_float(c.point), to_float(c.point + side * arm), {1.00f, 0.58f, 0.10f, 1}, 5.0f});
      list.markers.push_back({to_float(c.point), {1, 1, 1, 1}, 6});
      add_plane(c, list);
      list.labels.push_back(label_of(c, way_out(frame, list.view, c), list));
    }
  }
}

}  // namespace

struct Impulses {
  static constexpr Overlay kOverlay{"impulse", {}, add_impulse, [](const Frame& f) { return f.stage.overlays.on("contacts"); }};
};
template struct Drawn<Impulses>;

}  // namespace render
