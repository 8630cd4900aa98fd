// Where each wheel rolled, slid or not: a thin line through its contacts while it carried load.
#include "render/matrix.h"
#include "render/overlays/overlay.h"

namespace render {
namespace {

constexpr double kSpacing = 0.1;  // [m] between points
constexpr double kLift = 0.015;   // [m] over the ground, so that it is seen

void add(const Frame& frame, DrawList& list) {
  for (std::size_t w = 0; w < frame.now.wheels.size(); ++w) {
    LineItem line;
    line.colour = {0.98f, 0.98f, 0.92f, 0.9f};
    line.width = 1.4f;
    line.hidden_behind = true;
    Vec3 last = Vec3::Constant(1e9);
    auto close = [&] {
      if (line.points.size() > 1) list.lines.push_back(line);
      line.points.clear();
      last = Vec3::Constant(1e9);
    };
    for (const engine::Snapshot& s : frame.recording.snapshots) {
      if (s.time > frame.now.time || w >= s.wheels.size()) break;
      const engine::WheelRecord& wheel = s.wheels[w];
      if (wheel.load <= 0 && s.time > 0) {  // in the air; the first instant has no loads yet
        close();
        continue;
      }
      const Vec3 at = wheel.contact + kLift * Vec3::UnitZ();
      if ((at - last).norm() < kSpacing) continue;
      last = at;
      line.points.push_back(to_float(at));
    }
    close();
  }
}

}  // namespace

const Overlay kWheelTraces{"wheel_traces", [](const Frame& f) { return f.stage.overlays.wheel_traces; }, add};

}  // namespace render
