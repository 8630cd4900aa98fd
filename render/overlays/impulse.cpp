// The impulse of a collision between vehicles: an arrow at its point, on either side, and the contact plane it acted in. It
// stays long enough to be read.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/matrix.h"
#include "render/overlays/registration.h"

namespace render {
namespace {

constexpr double kShown = 0.4;                           // [s] of simulated time
constexpr double kNewtonSecondsAMetre = 4e3;             // that one metre of arrow stands for
constexpr double kMinor = 0.1;                           // of the run's largest: cars that rub along each other; an arrow is enough
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

LabelItem label_of(const engine::ContactRecord& c) {
  LabelItem label;
  label.lines = {fmt::format("impulse {:.0f} N s", c.impulse.norm()), fmt::format("{:.1f} kJ lost", c.energy_lost / 1000)};
  label.sizes = {20, 20};
  label.colours = {{1, 1, 1, 1}, {1, 0.68f, 0.25f, 1}};
  label.at_world_point = true;
  label.world = to_float(c.point + Vec3(0, 0, 1.2));
  label.pivot = {-0.3f, 1.6f};
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
    for (const auto& c : s.contacts) {
      if (!c.exchange) continue;
      const Vec3 arm = c.impulse / kNewtonSecondsAMetre;
      for (const double side : {1.0, -1.0})
        list.arrows.push_back({to_float(c.point), to_float(c.point + side * arm), {1.00f, 0.58f, 0.10f, 1}, 5.0f});
      list.markers.push_back({to_float(c.point), {1, 1, 1, 1}, 6});
      if (c.impulse.norm() < kMinor * largest) continue;
      add_plane(c, list);
      list.labels.push_back(label_of(c));
    }
  }
}

}  // namespace

struct Impulses {
  static constexpr Overlay kOverlay{"impulse", {}, add_impulse, [](const Frame& f) { return f.stage.overlays.on("contacts"); }};
};
template struct Drawn<Impulses>;

}  // namespace render
