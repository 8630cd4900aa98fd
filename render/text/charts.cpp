#include "render/text/charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace render {
namespace {

constexpr double kLetters = 15;                // pixels at 1080 lines
constexpr double kLeastLetters = 8;            // pixels of the picture, and
constexpr double kSmaller = 0.05;              // of their full size from one trial to the next
constexpr double kIndent = 12, kBetween = 16;  // pixels at 1080 lines, beside and between the names of series

double width_of(cairo_t* c, const std::string& what) {
  cairo_text_extents_t extents;
  cairo_text_extents(c, what.c_str(), &extents);
  return extents.x_advance;
}

void text(cairo_t* c, const std::string& what, double x, double y, double align) {
  cairo_move_to(c, std::round(x - align * width_of(c, what)), std::round(y));
  cairo_show_text(c, what.c_str());
}

std::string name_of(const ChartItem::Series& s) {
  return "\u25a0 " + s.name;
}

/// Whether widths of texts, with gaps between, fit into two rows; where the second begins, the count of them: nowhere.
std::optional<std::size_t> second_row(const std::vector<double>& widths, double between, double room) {
  std::size_t second = widths.size();
  double filled = 0;
  for (std::size_t i = 0; i < widths.size(); ++i) {
    if (filled > 0 && filled + between + widths[i] > room) {
      if (second < widths.size()) return std::nullopt;
      second = i;
      filled = 0;
    }
    filled += (filled > 0 ? between : 0) + widths[i];
    if (filled > room) return std::nullopt;
  }
  return second;
}

}  // namespace

ChartKey key_of(cairo_t* c, const ChartItem& chart, double room, double scale) {
  const double full = kLetters * scale, least = std::min(full, kLeastLetters);
  cairo_set_font_size(c, full);
  const std::size_t all = chart.series.size() + static_cast<std::size_t>(chart.left_out);
  ChartKey key;
  for (std::size_t shown = chart.series.size(); shown > 0; --shown) {
    std::vector<double> widths;
    for (std::size_t i = 0; i < shown; ++i) widths.push_back(width_of(c, name_of(chart.series[i])));
    const std::string more = all > shown ? fmt::format("and {} more", all - shown) : "";
    if (!more.empty()) widths.push_back(width_of(c, more));
    // letters that are smaller by a factor need a room that is larger by it
    for (double letters = full; letters >= least; letters -= kSmaller * full) {
      const auto second = second_row(widths, kBetween * scale, room * full / letters);
      if (second) return {letters, shown, *second, *second < widths.size(), more};
    }
    key = {least, shown, shown, !more.empty(), more};
  }
  return key;
}

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
  cairo_set_font_size(c, kLetters * scale);
  const ChartKey key = key_of(c, chart, w - 2 * kIndent * scale, scale);
  const double left = x0 + 52 * scale, right = x0 + w - 16 * scale, top = y0 + (key.two_rows ? 68 : 60) * scale,
               bottom = y0 + h - 30 * scale;
  auto px = [&](double t) { return left + (right - left) * t / chart.end; };
  auto py = [&](double v) { return bottom - (bottom - top) * v / chart.ceiling; };

  // frame: title, names in their colours, axes with numbers at both ends
  paint_with(c, {1, 1, 1, 0.95f});
  text(c, chart.title, x0 + 12 * scale, y0 + 20 * scale, 0);
  cairo_set_font_size(c, key.letters);
  const double margin = x0 + kIndent * scale;
  double at = margin, row = y0 + (key.two_rows ? 36 : 40) * scale;
  const auto write = [&](std::size_t place, const std::string& what, const Float4& colour) {
    if (key.two_rows && place == key.second_row) at = margin, row += 16 * scale;
    paint_with(c, colour);
    text(c, what, at, row, 0);
    at += width_of(c, what) + kBetween * key.letters / kLetters;
  };
  for (std::size_t i = 0; i < key.shown; ++i) write(i, name_of(chart.series[i]), chart.series[i].colour);
  write(key.shown, key.more, {1, 1, 1, 0.95f});
  cairo_set_font_size(c, kLetters * scale);
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

  for (std::size_t i = 0; i < key.shown; ++i) {
    const ChartItem::Series& s = chart.series[i];
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
