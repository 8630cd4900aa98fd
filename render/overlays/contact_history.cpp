// Where vehicle and persons have touched so far: marks that stay on both, coloured by time or by impulse.
#include <algorithm>
#include <map>
#include <tuple>

#include "render/matrix.h"
#include "render/overlays/registration.h"

namespace render {
namespace {

constexpr double kLeastImpulse = 0.2;  // [N s] below it a touch leaves no mark
constexpr double kCell = 0.025;        // [m] one mark a cell of this size on each body: the strongest
constexpr double kTowards = 0.05;      // [m] marks stand off the surface towards the eye, or they would sink into its curve

struct Mark {
  Vec3 point_B = Vec3::Zero();  // body axes
  double time = 0;
  double impulse = 0;
};

using Cell = std::tuple<int, long, long, long>;

void touch(std::map<Cell, Mark>& marks, const engine::Snapshot& s, int body, const engine::ContactRecord& c, double impulse) {
  const Pose& X = s.bodies[static_cast<std::size_t>(body)].X_WB;
  const Vec3 p = X.q.conjugate() * (c.point - X.p);
  const auto index = [&](int i) { return std::lround(p[i] / kCell); };
  Mark& mark = marks[{body, index(0), index(1), index(2)}];
  if (impulse > mark.impulse) mark = {p, s.time, impulse};
}

void add_contact_history(const Frame& frame, DrawList& list) {
  std::map<Cell, Mark> marks;
  double last = 0, strongest = 0;
  for (const engine::Snapshot& s : frame.recording.snapshots)
    for (const engine::ContactRecord& c : s.contacts) {
      const double impulse = c.impulse.norm();
      if (!c.shapes.on_vehicle() || c.body_b < 0 || impulse < kLeastImpulse) continue;
      last = s.time;  // the scale is that of the whole run: a colour means the same in every frame
      strongest = std::max(strongest, impulse);
      if (s.time > frame.now.time) continue;
      touch(marks, s, c.body_a, c, impulse);
      touch(marks, s, c.body_b, c, impulse);
    }
  const bool by_time = frame.stage.overlays.contact_colour == ContactColour::time;
  const Vec3 eye(list.view.eye[0], list.view.eye[1], list.view.eye[2]);
  for (const auto& [cell, mark] : marks) {
    const Vec3 p = frame.now.bodies[static_cast<std::size_t>(std::get<0>(cell))].X_WB * mark.point_B;
    LineItem dot;  // a line without length is a disc that what stands in front hides
    dot.points.assign(2, to_float(p + kTowards * (eye - p).normalized()));
    dot.colour = colour_of_share(by_time ? mark.time / std::max(last, 1e-9) : mark.impulse / strongest);
    dot.width = 9;
    dot.occluded = Occluded::hidden;
    list.lines.push_back(std::move(dot));
  }
}

}  // namespace

struct ContactHistory {
  static constexpr OverlayKey kKeys[] = {{"contact_history", 0, "Marks on vehicles and persons where they touched so far."}};
  static constexpr Overlay kOverlay{"contact_history", kKeys, add_contact_history};
};
template struct Drawn<ContactHistory>;

}  // namespace render
