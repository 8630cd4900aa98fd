// Names of vehicles in the site diagram, where they cover neither vehicles nor each other.
#include <algorithm>
#include <cmath>
#include <optional>

#include "render/figures/site.h"

namespace render {
namespace {

bool is_vehicle(const Stage& stage, int body) {
  return std::any_of(stage.wheels.begin(), stage.wheels.end(), [&](const WheelActor& w) { return w.body == body; });
}

/// On the sheet [mm].
struct Box {
  Point2 lower{1e9, 1e9}, upper{-1e9, -1e9};
  void take(const Point2& p) { lower = lower.cwiseMin(p), upper = upper.cwiseMax(p); }
  bool meets(const Box& other) const {
    return (lower.array() < other.upper.array()).all() && (other.lower.array() < upper.array()).all();
  }
};

/// A vehicle where it stands at one of the times shown. Its axes meet the sheet at the middle of its outline's ends and sides.
struct Standing {
  const MeshActor& vehicle;
  Point2 front, rear, left, right, tip, centre;  // [mm]; the tip is that of the chevron
  double half = 0;                               // [mm] of the chevron
  double width = 0;                              // [mm]
  Box box;
};

Standing standing(const Site& site, const MeshActor& vehicle, const engine::Pose& X_WB) {
  Point2 lower(1e9, 1e9), upper(-1e9, -1e9);  // [m] of the outline, body axes
  for (const Point2& p : seen_from_above(*vehicle.mesh, vehicle.X_BM)) lower = lower.cwiseMin(p), upper = upper.cwiseMax(p);
  const auto at = [&](double x, double y) { return site.plan.at(X_WB * Vec3(x, y, 0)); };
  const Point2 middle = 0.5 * (lower + upper);
  Standing out{.vehicle = vehicle,
               .front = at(upper.x(), middle.y()),
               .rear = at(lower.x(), middle.y()),
               .left = at(middle.x(), upper.y()),
               .right = at(middle.x(), lower.y()),
               .tip = at(upper.x() - 0.06 * (upper.x() - lower.x()), middle.y()),
               .centre = at(middle.x(), middle.y()),
               .box = {}};
  out.width = 1000 / site.plan.denominator * (upper.y() - lower.y());
  out.half = 0.16 * out.width;
  for (const Point2& p : seen_from_above(*vehicle.mesh, X_WB * vehicle.X_BM)) out.box.take(site.plan.at({p.x(), p.y(), 0}));
  return out;
}

/// Where the front of an outline is.
void draw_chevron(cairo_t* c, const Standing& it) {
  const Point2 ahead = (it.front - it.rear).normalized(), aside(-ahead.y(), ahead.x());
  grey(c, 0.3);
  cairo_set_line_width(c, 0.25);
  for (const double side : {-1.0, 1.0}) {
    const Point2 end = it.tip - it.half * (2 * ahead - side * aside);
    draw_line(c, end.x(), end.y(), it.tip.x(), it.tip.y());
  }
}

/// A name beside an outline: behind it if there is room, else before it or at a side, where it lies on no vehicle and no other
/// name.
void draw_name_beside(cairo_t* c, const Standing& it, const std::vector<Standing>& all, std::vector<Box>& names) {
  constexpr double kBeside = 3;  // [mm] from the outline
  struct Place {
    Point2 at;
    Align align;
    Box box;
    int covers = 0;
  };
  std::optional<Place> best;
  const double length = text_width(c, it.vehicle.name, kKeyLetters);
  for (const Point2& from : {it.rear, it.front, it.left, it.right}) {
    const Point2 away = (from - it.centre).normalized();
    Place place{from + kBeside * away + Point2(0, 1),
                away.x() > 0.5    ? Align::left
                : away.x() < -0.5 ? Align::right
                                  : Align::centre,
                {}};
    const double share = place.align == Align::left ? 0 : place.align == Align::right ? 1 : 0.5;  // of the name, left of the place
    place.box.take(place.at - Point2(share * length, kKeyLetters));
    place.box.take(place.at + Point2((1 - share) * length, 0.3 * kKeyLetters));
    for (const Standing& other : all) place.covers += other.box.meets(place.box);
    for (const Box& name : names) place.covers += name.meets(place.box);
    if (!best || place.covers < best->covers) best = place;
  }
  if (best->covers == 0) {  // on the lines of the road
    grey(c, 1);
    const Point2 size = best->box.upper - best->box.lower;
    cairo_rectangle(c, best->box.lower.x(), best->box.lower.y(), size.x(), size.y());
    cairo_fill(c);
  }
  grey(c, 0.3);
  draw_text(c, best->at.x(), best->at.y(), it.vehicle.name, kKeyLetters, best->align);
  names.push_back(best->box);
}

/// Which vehicle an outline is.
void draw_name(cairo_t* c, const Standing& it, const std::vector<Standing>& all, std::vector<Box>& names) {
  constexpr double kChevron = 4;  // [mm] beside a name within
  const double length = text_width(c, it.vehicle.name, kKeyLetters);
  if ((it.tip - it.rear).norm() <= length + 2 * kChevron) return draw_name_beside(c, it, all, names);
  const Point2 ahead = it.tip - it.centre;
  cairo_save(c);
  cairo_translate(c, it.centre.x(), it.centre.y());
  const double angle = std::atan2(ahead.y(), ahead.x());
  cairo_rotate(c, std::abs(angle) > M_PI / 2 ? angle + M_PI : angle);
  // beside its middle, where ways lead
  draw_text(c, 0, 1 - 0.22 * it.width, it.vehicle.name, kKeyLetters, Align::centre);
  cairo_restore(c);
}

}  // namespace

void draw_vehicle_names(cairo_t* c, const Site& site, double first) {
  constexpr double kOwnName = 12;  // [mm] apart
  const engine::Snapshot end = site.recording.at(site.recording.end_time()), then = site.recording.at(first);
  std::vector<Standing> all;
  for (const MeshActor& actor : site.stage.meshes) {
    if (actor.body < 0 || !is_vehicle(site.stage, actor.body)) continue;
    all.push_back(standing(site, actor, pose(end, actor.body)));
    const double apart = (site.plan.at(pose(end, actor.body).p) - site.plan.at(pose(then, actor.body).p)).norm();
    if (apart > kOwnName) all.push_back(standing(site, actor, pose(then, actor.body)));
  }
  std::vector<Box> names;
  for (const Standing& it : all) draw_chevron(c, it);
  grey(c, 0.3);
  for (const Standing& it : all) draw_name(c, it, all, names);
}

}  // namespace render
