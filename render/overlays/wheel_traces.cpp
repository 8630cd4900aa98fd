// Where each wheel rolled: a thin line through its contacts while it carried load. Where it slid its mark tells.
#include "render/matrix.h"
#include "render/overlays/on_ground.h"
#include "render/overlays/registration.h"

namespace render {
namespace {

constexpr double kWheelTraceSpacing = 0.1;  // [m] between points
constexpr double kWheelTraceLift = 0.015;   // [m] over the ground, so that it is seen

void add_wheel_traces(const Frame& frame, DrawList& list) {
  for (std::size_t w = 0; w < frame.now.wheels.size(); ++w) {
    LineItem line;
    line.colour = {0.98f, 0.98f, 0.92f, 0.9f};
    line.width = 1.4f;
    line.occluded = Occluded::hidden;
    Vec3 last = Vec3::Constant(1e9);
    auto close = [&] {
      if (line.points.size() > 1) list.lines.push_back(line);
      line.points.clear();
      line.normals.clear();
      last = Vec3::Constant(1e9);
    };
    for (const engine::Snapshot& s : frame.recording.snapshots) {
      if (s.time > frame.now.time || w >= s.wheels.size()) break;
      const engine::WheelRecord& wheel = s.wheels[w];
      if ((wheel.load <= 0 && s.time > 0) || wheel.slip >= kMarkingSlip) {  // in the air (the first instant has no loads yet)
        close();
        continue;
      }
      if ((wheel.contact - last).norm() < kWheelTraceSpacing) continue;
      last = wheel.contact;
      lay_on_ground(frame.stage.road, wheel.contact, kWheelTraceLift, line);
    }
    close();
  }
}

}  // namespace

struct WheelTraces {
  static constexpr OverlayKey kKeys[] = {
      {"wheel_traces", 0, "Where each wheel rolled. (Skid marks, where tyres slid, are always drawn.)"}};
  static constexpr Overlay kOverlay{"wheel_traces", kKeys, add_wheel_traces};
};
template struct Drawn<WheelTraces>;

}  // namespace render
