// A drawing of the site from above at a round scale: what its sheets share.
#pragma once

#include "engine/recording.h"
#include "render/figures/outline.h"
#include "render/figures/sheet.h"
#include "render/stage.h"

namespace render {

constexpr double kPlanLeft = kMargin, kPlanTop = 28, kPlanRight = kSheetWidth - kMargin,
                 kPlanBottom = kSheetHeight - 22;  // [mm] of the plan

/// World to paper: x right, y up, one scale.
struct Plan {
  double denominator = 100;  // of the scale
  Point2 middle{0, 0};
  double top = kPlanTop;  // [mm] below what is written above it
  double x(double wx) const { return (kPlanLeft + kPlanRight) / 2 + 1000 * (wx - middle.x()) / denominator; }
  double y(double wy) const { return (top + kPlanBottom) / 2 - 1000 * (wy - middle.y()) / denominator; }
  Point2 at(const Vec3& p) const { return {x(p.x()), y(p.y())}; }
  /// The place in the world of a point of the paper [mm].
  Point2 back(const Point2& p) const {
    return middle + denominator / 1000 * Point2(p.x() - (kPlanLeft + kPlanRight) / 2, (top + kPlanBottom) / 2 - p.y());
  }
};

/// The largest usual scale at which the box [m] fits the sheet below `top` [mm].
Plan plan_for(const Point2& lower, const Point2& upper, double top = kPlanTop);

/// How an outline is filled and edged.
struct Tint {
  double lightness = 1;  // of the filling; above 1: none
  int dashes = 0;        // of the edge
};
void draw_road(cairo_t*, const Stage&, const Plan&);
void draw_vehicles(cairo_t*, const Stage&, const Plan&, const engine::Snapshot&, const Tint&);
void draw_person(cairo_t*, const Stage&, const Plan&, const std::string& name, const engine::Snapshot&, const Tint&);
/// Free bodies that are nobody's.
void draw_bodies(cairo_t*, const Stage&, const Plan&, const engine::Snapshot&, const Tint&);
/// Scale bar, and north or the x axis.
void draw_scale(cairo_t*, const Stage&, const Plan&);

}  // namespace render
