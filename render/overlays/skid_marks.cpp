// Dark strips where tyres slid over the road.
#include <cmath>

#include "render/matrix.h"
#include "render/overlays/overlay.h"

namespace render {
namespace {

constexpr double kHalfWidth = 0.09;  // [m] of the mark
constexpr double kSlip = 0.3;        // [m/s] below it a tyre leaves nothing

void add(const Frame& frame, DrawList& list) {
  const auto& snapshots = frame.recording.snapshots;
  for (std::size_t w = 0; w < frame.now.wheels.size(); ++w) {
    StripItem strip;
    Vec3 last = Vec3::Zero();
    bool open = false;
    auto close = [&] {
      if (strip.left.size() > 1) list.strips.push_back(strip);
      strip = {};
      open = false;
    };
    for (const auto& s : snapshots) {
      if (s.time > frame.now.time || w >= s.wheels.size()) break;
      const auto& wheel = s.wheels[w];
      if (wheel.slip < kSlip || wheel.load <= 0) {
        close();
        continue;
      }
      const Vec3 at = wheel.contact;
      if (open && (at - last).head<2>().norm() < 0.03) continue;
      // the first point of a mark waits for the second to know which way it runs
      const Vec3 along = open ? Vec3(at - last) : Vec3::UnitX();
      const Vec3 side = kHalfWidth * Vec3(-along.y(), along.x(), 0).normalized();
      if (strip.left.size() == 1) strip.left[0] = to_float(last + side), strip.right[0] = to_float(last - side);
      strip.left.push_back(to_float(at + side));
      strip.right.push_back(to_float(at - side));
      strip.darkness.push_back(static_cast<float>(std::min(0.62, 0.25 + wheel.slip * 0.06)));
      last = at;
      open = true;
    }
    close();
  }
}

}  // namespace

const Overlay kSkidMarks{"skid_marks", [](const Frame& f) { return !f.now.wheels.empty(); }, add};

}  // namespace render
