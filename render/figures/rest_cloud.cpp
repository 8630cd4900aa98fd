#include "render/figures/rest_cloud.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/figures/plan.h"

namespace render {
namespace {

constexpr double kAround = 1.2;    // [m] kept free around what is drawn
constexpr double kFewest = 0.005;  // of a cloud: what lies farther out on each side does not set the scale
constexpr double kMarkSize = 0.5;  // [mm] of a run's mark
constexpr double kKeyRow = 4.4;    // [mm] between the lines of the key

void take(const Point2& p, Point2& lower, Point2& upper) {
  lower = lower.cwiseMin(p);
  upper = upper.cwiseMax(p);
}

/// The middle 99 of 100 of a coordinate: one run that flew elsewhere must not shrink all others to a dot.
std::pair<double, double> middle_of(const std::vector<Point2>& places, int axis) {
  std::vector<double> x;
  for (const Point2& p : places) x.push_back(p[axis]);
  std::sort(x.begin(), x.end());
  const auto at = [&](double share) { return x[static_cast<std::size_t>(std::lround(share * static_cast<double>(x.size() - 1)))]; };
  return {at(kFewest), at(1 - kFewest)};
}

Plan plan_of(const Stage& stage, const engine::Snapshot& end, const RestFigure& figure) {
  Point2 lower(1e9, 1e9), upper(-1e9, -1e9);
  for (const RestCloud& cloud : figure.clouds) {
    const auto [left, right] = middle_of(cloud.places, 0);
    const auto [down, up] = middle_of(cloud.places, 1);
    take({left, down}, lower, upper);
    take({right, up}, lower, upper);
  }
  for (const MeshActor& actor : stage.meshes)
    if (actor.body >= 0)
      for (const Point2& p : seen_from_above(*actor.mesh, end.bodies[static_cast<std::size_t>(actor.body)].X_WB * actor.X_BM))
        take(p, lower, upper);
  const Point2 around(kAround, kAround);
  return plan_for(lower - around, upper + around);
}

void draw_cloud(cairo_t* c, const Plan& plan, const RestCloud& cloud, int shape) {
  grey(c, 0.45);
  cairo_set_line_width(c, 0.15);
  for (const Point2& p : cloud.places) draw_mark(c, shape, plan.x(p.x()), plan.y(p.y()), kMarkSize);
  for (const RestRegion& region : cloud.regions) {
    grey(c, 0);
    cairo_set_line_width(c, region.share > 0.9 ? 0.2 : 0.6);
    for (const auto& [from, to] : region.edge) draw_line(c, plan.x(from.x()), plan.y(from.y()), plan.x(to.x()), plan.y(to.y()));
  }
}

void draw_key(cairo_t* c, const RestFigure& figure) {
  double y = kMargin + 3;
  const auto line = [&](const std::string& text) {
    draw_text(c, kSheetWidth - kMargin, y, text, 2.9, Align::right);
    y += kKeyRow;
  };
  grey(c, 0);
  for (const RestCloud& cloud : figure.clouds) {
    line(fmt::format("{}: {} runs{}", cloud.name, cloud.places.size(),
                     cloud.regions.empty() ? "" : ", thick line round the densest 50 %, thin round 95 %"));
    if (cloud.moving > 0) line(fmt::format("{} runs in which {} still moves at the end are left out", cloud.moving, cloud.name));
  }
  line("filled: " + figure.middle);
  for (const RestGhost& g : figure.ghosts) line("outlined: " + g.label);
}

void draw_body(cairo_t* c, const Plan& plan, const EllipsoidActor& actor, const engine::Snapshot& s, double lightness) {
  for (const Point2& p : seen_from_above(actor.shape, s.bodies[static_cast<std::size_t>(actor.body)].X_WB))
    cairo_line_to(c, plan.x(p.x()), plan.y(p.y()));
  cairo_close_path(c);
  grey(c, lightness);
  cairo_fill_preserve(c);
  grey(c, 0);
  cairo_set_line_width(c, 0.2);
  cairo_stroke(c);
}

void draw_figures(cairo_t* c, const Stage& stage, const Plan& plan, const engine::Snapshot& end, const RestFigure& figure) {
  for (const RestGhost& g : figure.ghosts) draw_vehicles(c, stage, plan, g.end, {2, 2});
  draw_vehicles(c, stage, plan, end, {0.93, 0});
  for (const EllipsoidActor& actor : stage.ellipsoids) {
    for (const RestGhost& g : figure.ghosts) draw_body(c, plan, actor, g.end, 0.97);
    draw_body(c, plan, actor, end, 0.6);
  }
  for (const PersonActor& person : stage.persons) {
    for (const RestGhost& g : figure.ghosts) draw_person(c, stage, plan, person.name, g.end, {0.97, 0});
    draw_person(c, stage, plan, person.name, end, {0.6, 0});
  }
}

}  // namespace

std::vector<std::string> rest_cloud(const Stage& stage, const engine::Recording& middle, const FigureJob& job,
                                    const RestFigure& figure) {
  if (figure.clouds.empty()) return {};
  const engine::Snapshot& end = middle.snapshots.back();
  const Plan plan = plan_of(stage, end, figure);
  return write_sheets(job.folder, "rest_cloud", "Rest places of many runs: " + stage.title, [&](cairo_t* c) {
    draw_frame_of_sheet(c, stage, "Rest places of many runs");
    cairo_save(c);
    cairo_rectangle(c, kPlanLeft, kPlanTop, kPlanRight - kPlanLeft, kPlanBottom - kPlanTop);
    cairo_clip(c);
    draw_road(c, stage, plan);
    draw_figures(c, stage, plan, end, figure);
    for (std::size_t i = 0; i < figure.clouds.size(); ++i) draw_cloud(c, plan, figure.clouds[i], static_cast<int>(i % 6));
    cairo_restore(c);
    draw_key(c, figure);
    draw_scale(c, stage, plan);
  });
}

}  // namespace render
