#include "render/figures/plan.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace render {
namespace {

const engine::Pose& pose(const engine::Snapshot& s, int body) {
  return s.bodies[static_cast<std::size_t>(body)].X_WB;
}

void path(cairo_t* c, const std::vector<Point2>& polygon, const Plan& plan) {
  for (const Point2& p : polygon) cairo_line_to(c, plan.x(p.x()), plan.y(p.y()));
  cairo_close_path(c);
}

void fill(cairo_t* c, const Tint& tint) {
  if (tint.lightness > 1) return;
  grey(c, tint.lightness);
  cairo_fill_preserve(c);
}

}  // namespace

Plan plan_for(const Point2& lower, const Point2& upper, double top) {
  constexpr std::array kScales{20, 25, 50, 75, 100, 125, 150, 200, 250, 300, 400, 500, 750, 1000, 1500, 2000, 5000};
  Plan plan;
  plan.middle = 0.5 * (lower + upper);
  plan.top = top;
  for (const int scale : kScales) {
    plan.denominator = scale;
    if (1000 * (upper.x() - lower.x()) / scale <= kPlanRight - kPlanLeft &&
        1000 * (upper.y() - lower.y()) / scale <= kPlanBottom - top)
      break;
  }
  return plan;
}

void draw_road(cairo_t* c, const Stage& stage, const Plan& plan) {
  const RoadLook& road = stage.road;
  if (!road.road) return;
  const double lower = road.centre_y - road.width / 2;
  for (int lane = 0; lane <= road.lanes; ++lane) {
    const bool edge = lane == 0 || lane == road.lanes;
    const double y = plan.y(lower + lane * road.width / road.lanes);
    if (y < plan.top || y > kPlanBottom) continue;
    grey(c, 0.55);
    cairo_set_line_width(c, edge ? 0.5 : 0.35);
    const double dash[] = {1000 * 3 / plan.denominator, 1000 * 6 / plan.denominator};
    cairo_set_dash(c, dash, edge ? 0 : 2, 0);
    draw_line(c, kPlanLeft, y, kPlanRight, y);
  }
  cairo_set_dash(c, nullptr, 0, 0);
}

void draw_vehicles(cairo_t* c, const Stage& stage, const Plan& plan, const engine::Snapshot& s, const Tint& tint) {
  for (const MeshActor& actor : stage.meshes) {
    if (actor.body < 0) continue;
    path(c, seen_from_above(*actor.mesh, pose(s, actor.body) * actor.X_BM), plan);
    fill(c, tint);
    grey(c, 0.25);
    cairo_set_line_width(c, 0.3);
    set_dashes(c, tint.dashes);
    cairo_stroke(c);
    set_dashes(c, 0);
  }
}

void draw_person(cairo_t* c, const Stage& stage, const Plan& plan, const std::string& name, const engine::Snapshot& s,
                 const Tint& tint) {
  for (const PersonActor& person : stage.persons) {
    if (person.name != name) continue;
    for (const PersonActor::Segment& segment : person.segments) {
      path(c, seen_from_above(segment.shape, pose(s, segment.body)), plan);
      fill(c, tint);
      grey(c, 0);
      cairo_set_line_width(c, 0.15);
      set_dashes(c, tint.dashes);
      cairo_stroke(c);
      set_dashes(c, 0);
    }
  }
}

void draw_bodies(cairo_t* c, const Stage& stage, const Plan& plan, const engine::Snapshot& s, const Tint& tint) {
  for (const EllipsoidActor& actor : stage.ellipsoids) {
    path(c, seen_from_above(actor.shape, pose(s, actor.body)), plan);
    fill(c, tint);
    grey(c, 0.25);
    cairo_set_line_width(c, 0.3);
    set_dashes(c, tint.dashes);
    cairo_stroke(c);
    set_dashes(c, 0);
  }
}

void draw_scale(cairo_t* c, const Stage& stage, const Plan& plan) {
  const double metre = 1000 / plan.denominator;
  const double length = metre >= 15 ? 2 : metre >= 6 ? 5 : metre >= 3 ? 10 : 50;  // [m]
  const double x = kMargin, y = kSheetHeight - 15;
  for (int i = 0; i < 4; ++i) {  // black and white by turns
    cairo_rectangle(c, x + i * length * metre / 4, y, length * metre / 4, 1.6);
    grey(c, i % 2 == 0 ? 0 : 1);
    cairo_fill_preserve(c);
    grey(c, 0);
    cairo_set_line_width(c, 0.2);
    cairo_stroke(c);
  }
  draw_text(c, x + length * metre + 2, y + 1.8, fmt::format("{:g} m    scale 1:{:g} on A4", length, plan.denominator), 3.2);
  // north, or the x axis where nobody has said where north is
  const double angle = stage.north.value_or(0);
  const Point2 at(kSheetWidth - kMargin - 9, kSheetHeight - 19), along(std::cos(angle), -std::sin(angle));
  const Point2 tail = at - 5 * along, tip = at + 5 * along, side(-along.y(), along.x());
  cairo_set_line_width(c, 0.4);
  draw_line(c, tail.x(), tail.y(), tip.x(), tip.y());
  cairo_move_to(c, tip.x(), tip.y());
  for (const double s : {1.0, -1.0}) {
    const Point2 wing = tip - 2.6 * along + s * 1.1 * side;
    cairo_line_to(c, wing.x(), wing.y());
  }
  cairo_fill(c);
  const Point2 name = tip + 2.4 * along;
  draw_text(c, name.x(), name.y() + 1.1, stage.north ? "N" : "x", 3.2, Align::centre);
}

}  // namespace render
