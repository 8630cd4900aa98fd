#include "render/text/charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace render {
namespace {

constexpr double kText = 15;  // pixels at 1080 lines

double width_of(cairo_t* c, const std::string& what) {
  cairo_text_extents_t extents;
  cairo_text_extents(c, what.c_str(), &extents);
  return extents.x_advance;
}

void text(cairo_t* c, const std::string& what, double x, double y, double align) {
  cairo_move_to(c, std::round(x - align * width_of(c, what)), std::round(y));
  cairo_show_text(c, what.c_str());
}

}  // namespace

void paint_with(cairo_t* c, const Float4& k) {
  cairo_set_source_rgba(c, static_cast<double>(k[2]), static_cast<double>(k[1]), static_cast<double>(k[0]),
                        static_cast<double>(k[3]));
}

std::array<double, 4> chart_box(const ChartItem& chart, int width, int height) {
  const double scale = height / 1080.0;
  const double w = std::min<double>(chart.width * scale, width), h = std::min<double>(chart.height * scale, height);
  const double x = chart.anchor[0] * static_cast<float>(width) - chart.pivot[0] * static_cast<float>(w);
  const double y = chart.anchor[1] * static_cast<float>(height) - chart.pivot[1] * static_cast<float>(h);
  return {std::clamp(x, 0.0, width - w), std::clamp(y, 0.0, height - h), w, h};
}

void draw_chart(cairo_t* c, const ChartItem& chart, int width, int height) {
  const double scale = height / 1080.0;
  const auto [x0, y0, w, h] = chart_box(chart, width, height);
  cairo_save(c);
  cairo_rectangle(c, x0, y0, w, h);
  cairo_clip(c);
  paint_with(c, {0.08f, 0.09f, 0.10f, 0.72f});
  cairo_paint(c);
  cairo_select_font_face(c, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(c, kText * scale);
  const double left = x0 + 52 * scale, right = x0 + w - 16 * scale, top = y0 + 60 * scale, bottom = y0 + h - 30 * scale;
  auto px = [&](double t) { return left + (right - left) * t / chart.end; };
  auto py = [&](double v) { return bottom - (bottom - top) * v / chart.ceiling; };

  // frame: title, names in their colours, axes with numbers at both ends
  paint_with(c, {1, 1, 1, 0.95f});
  text(c, chart.title, x0 + 12 * scale, y0 + 20 * scale, 0);
  const auto name_of = [](const ChartItem::Series& s) { return "\u25a0 " + s.name; };
  const double indent = 12 * scale, between = 16 * scale;
  double names = 0;
  for (const ChartItem::Series& s : chart.series) names += width_of(c, name_of(s)) + between;
  // many or long names are written smaller: none is cut off
  const double shrink = std::min(1.0, (w - 2 * indent) / std::max(names - between, 1.0));
  cairo_set_font_size(c, kText * scale * shrink);
  double at = x0 + indent;
  for (const ChartItem::Series& s : chart.series) {
    paint_with(c, s.colour);
    text(c, name_of(s), at, y0 + 40 * scale, 0);
    at += width_of(c, name_of(s)) + between * shrink;
  }
  cairo_set_font_size(c, kText * scale);
  paint_with(c, {0.8f, 0.85f, 0.9f, 0.9f});
  for (const double share : {0.0, 0.5, 1.0})
    text(c, fmt::format("{:g}", share * chart.ceiling), left - 6 * scale, py(share * chart.ceiling) + 5 * scale, 1);
  text(c, "0", px(0), bottom + 18 * scale, 0.5);
  text(c, fmt::format("{:.2g} s", chart.end), right, bottom + 18 * scale, 1);
  cairo_set_line_width(c, std::max(1.0, 1 * scale));
  paint_with(c, {1, 1, 1, 0.25f});
  for (const double share : {0.0, 0.5, 1.0}) {
    cairo_move_to(c, left, py(share * chart.ceiling));
    cairo_line_to(c, right, py(share * chart.ceiling));
  }
  cairo_stroke(c);

  for (const ChartItem::Series& s : chart.series) {
    paint_with(c, s.colour);
    cairo_set_line_width(c, 2.4 * scale);
    cairo_set_line_join(c, CAIRO_LINE_JOIN_ROUND);
    for (const auto& p : s.points) cairo_line_to(c, px(p[0]), py(p[1]));
    cairo_stroke(c);
    if (s.points.empty()) continue;
    cairo_arc(c, px(s.points.back()[0]), py(s.points.back()[1]), 4 * scale, 0, 2 * M_PI);
    cairo_fill(c);
  }
  cairo_restore(c);
}

}  // namespace render
