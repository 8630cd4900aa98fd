// Lengths with their numbers: between two points, or how far a body has come since a time. Horizontal tapes on the ground, with an
// end mark each.
#include <fmt/format.h>

#include "render/matrix.h"
#include "render/overlays/movers.h"
#include "render/overlays/registration.h"

namespace render {
namespace {

constexpr double kLeastLength = 0.02;  // [m] a shorter one is not drawn
constexpr double kMark = 0.12;         // [m] half of an end mark
constexpr double kAbove = 0.02;        // [m] over the ground
const Float4 kDimensionColour{1, 1, 1, 1};

/// The place of a body; of a person, whom the hips stand for, that of the centre of mass, as the throw is measured.
Vec3 place_of(const Stage& stage, int body, const engine::Snapshot& s) {
  for (const Mover& mover : stage.speeds)
    if (mover.body == body) return centre_of(mover, s);
  return s.bodies[static_cast<std::size_t>(body)].X_WB.p;
}

void add_one(const Frame& frame, const Dimension& d, DrawList& list) {
  Vec3 a = d.from, b = d.to;
  if (d.body >= 0) {
    if (frame.now.time <= d.since) return;
    a = place_of(frame.stage, d.body, frame.recording.at(d.since));
    b = place_of(frame.stage, d.body, frame.now);
    a.z() = b.z() = frame.stage.road.height + kAbove;
  }
  const double length = (b - a).norm();
  if (length < kLeastLength) return;
  const Vec3 along = (b - a) / length;
  // an upright dimension gets level end marks, a level one marks on the ground
  const Vec3 side = std::abs(along.z()) > 0.9 ? Vec3(Vec3::UnitX()) : Vec3(Vec3::UnitZ().cross(along).normalized());
  auto line = [&](const Vec3& p, const Vec3& q) {
    LineItem item;
    item.points = {to_float(p), to_float(q)};
    item.colour = kDimensionColour;
    item.width = 2.4f;
    // where something stands before it, it is seen through, pale
    item.occluded = Occluded::hidden;
    list.lines.push_back(item);
    item.occluded = Occluded::shown;
    item.outline = false;
    item.colour[3] = 0.35f;
    list.lines.push_back(std::move(item));
  };
  line(a, b);
  for (const Vec3& end : {a, b}) line(end - kMark * side, end + kMark * side);
  LabelItem label;
  label.lines = {(d.label.empty() ? "" : d.label + " ") + fmt::format("{:.2f} m", length)};
  label.sizes = {20};
  label.colours = {kDimensionColour};
  label.at_world_point = true;
  label.world = to_float(0.5 * (a + b));
  label.pivot = {0.5f, 1.3f};
  list.labels.push_back(label);
}

void add_dimensions(const Frame& frame, DrawList& list) {
  for (const Dimension& d : frame.stage.overlays.dimensions) add_one(frame, d, list);
}

}  // namespace

struct Dimensions {
  static constexpr Overlay kOverlay{
      "dimensions", {}, add_dimensions, [](const Frame& f) { return !f.stage.overlays.dimensions.empty(); }};
};
template struct Drawn<Dimensions>;

}  // namespace render
