// Dark strips where tyres slid over the road.
#include <cmath>

#include "render/matrix.h"
#include "render/overlays/on_ground.h"
#include "render/overlays/registration.h"

namespace render {
namespace {

constexpr double kHalfWidth = 0.09;  // [m] of the mark
constexpr double kMarkLift = 0.01;   // [m] over a terrain, whose triangles bend between the points
constexpr double kLongest = 0.1;     // [m] between points on a terrain

/// One strip as it grows: each point is laid on the ground, and so are the two edges beside it.
class Mark {
 public:
  explicit Mark(const RoadLook& road) : road_(road) {}

  void go_to(const Vec3& at, double slip) {
    const auto dark = static_cast<float>(std::min(0.62, 0.25 + slip * 0.06));
    if (!open_) return begin(at, dark);
    const double way = (at - last_).head<2>().norm();
    if (way < 0.03) return;
    const int pieces = road_.terrain ? static_cast<int>(std::ceil(way / kLongest)) : 1;
    const Vec3 from = last_, along = (at - last_) / way;
    if (strip_.left.size() == 1) lay(0, from, along);  // the first point has waited to know which way the mark runs
    for (int i = 1; i <= pieces; ++i) {
      strip_.left.emplace_back(), strip_.right.emplace_back(), strip_.darkness.push_back(dark);
      lay(strip_.left.size() - 1, from + (at - from) * i / pieces, along);
    }
    last_ = at;
  }

  void end(DrawList& list) {
    if (strip_.left.size() > 1) list.strips.push_back(std::move(strip_));
    strip_ = {};
    open_ = false;
  }

 private:
  void begin(const Vec3& at, float dark) {
    open_ = true;
    last_ = at;
    strip_.left.emplace_back(), strip_.right.emplace_back(), strip_.darkness.push_back(dark);
  }
  void lay(std::size_t i, const Vec3& at, const Vec3& along) {
    const Vec3 side = kHalfWidth * on_ground(road_, at).normal.cross(along).normalized();
    const auto edge = [&](const Vec3& p) {
      const Spot spot = on_ground(road_, p);
      return to_float(road_.terrain ? Vec3(spot.point + kMarkLift * spot.normal) : p);
    };
    strip_.left[i] = edge(at + side);
    strip_.right[i] = edge(at - side);
  }

  const RoadLook& road_;
  StripItem strip_;
  Vec3 last_ = Vec3::Zero();
  bool open_ = false;
};

void add_skid_marks(const Frame& frame, DrawList& list) {
  for (std::size_t w = 0; w < frame.now.wheels.size(); ++w) {
    Mark mark(frame.stage.road);
    for (const engine::Snapshot& s : frame.recording.snapshots) {
      if (s.time > frame.now.time || w >= s.wheels.size()) break;
      const engine::WheelRecord& wheel = s.wheels[w];
      if (wheel.slip < kMarkingSlip || wheel.load <= 0)
        mark.end(list);
      else
        mark.go_to(wheel.contact, wheel.slip);
    }
    mark.end(list);
  }
}

}  // namespace

struct SkidMarks {
  static constexpr Overlay kOverlay{
      "skid_marks", {}, add_skid_marks, [](const Frame& f) { return !f.now.wheels.empty(); }, Belongs::scene};
};
template struct Drawn<SkidMarks>;

}  // namespace render
