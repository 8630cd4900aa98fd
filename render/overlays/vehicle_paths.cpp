// The way of each vehicle's centre of mass up to now, laid on the ground it drove over.
#include "render/matrix.h"
#include "render/overlays/on_ground.h"
#include "render/overlays/registration.h"

namespace render {
namespace {

constexpr double kPathSpacing = 0.1;  // [m] between points
constexpr double kPathLift = 0.02;    // [m] over the ground, so that it is seen

/// The centre of mass of a vehicle over the mean height of its wheels' contacts.
Vec3 foot_of(const engine::Snapshot& s, int vehicle, int body) {
  Vec3 p = s.bodies[static_cast<std::size_t>(body)].X_WB.p;
  double height = 0;
  int count = 0;
  for (const engine::WheelRecord& w : s.wheels)
    if (w.vehicle == vehicle) height += w.contact.z(), ++count;
  if (count > 0) p.z() = height / count;
  return p;
}

void add_vehicle_paths(const Frame& frame, DrawList& list) {
  for (std::size_t v = 0; v < frame.stage.vehicles.size(); ++v) {
    const int vehicle = static_cast<int>(v), body = frame.stage.vehicles[v];
    LineItem line;
    line.colour = {0.35f, 0.78f, 1.00f, 0.95f};
    line.width = 2.5f;
    line.occluded = Occluded::hidden;
    Vec3 last = Vec3::Constant(1e9);
    for (const engine::Snapshot& s : frame.recording.snapshots) {
      if (s.time > frame.now.time) break;
      const Vec3 at = foot_of(s, vehicle, body);
      if ((at - last).norm() < kPathSpacing) continue;
      last = at;
      lay_on_ground(frame.stage.road, at, kPathLift, line);
    }
    lay_on_ground(frame.stage.road, foot_of(frame.now, vehicle, body), kPathLift, line);
    if (line.points.size() > 1) list.lines.push_back(std::move(line));
  }
}

}  // namespace

struct VehiclePaths {
  static constexpr OverlayKey kKeys[] = {{"vehicle_paths", 0, "The way of each vehicle, on the ground."}};
  static constexpr Overlay kOverlay{"vehicle_paths", kKeys, add_vehicle_paths};
};
template struct Drawn<VehiclePaths>;

}  // namespace render
