#include "render/charts/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "render/charts/axes.h"

namespace render::charts {
namespace {

constexpr double kTitleSize = 9, kTextSize = 7.2;  // [pt] readable on paper
constexpr double kMarkerSize = 5.5;

void span(const Chart& chart, Axis& x, Axis& y) {
  x.log = chart.log_x;
  y.log = chart.log_y;
  for (const Band& band : chart.bands)
    for (const Point& p : band.points) {
      x.take(p.x);
      y.take(p.low);
      y.take(p.high);
    }
  for (const Line& line : chart.lines)
    for (const Point& p : line.points) {
      x.take(p.x);
      y.take(p.y);
      if (p.low != p.high) {
        y.take(p.low);
        y.take(p.high);
      }
    }
  for (const Mark& level : chart.levels) y.take(level.y);
}

/// What stands below the ticks: the label of the axis, or what its numbers stand for.
std::string key_of(const Chart& chart) {
  std::string out = chart.names.empty() ? chart.x_label : "";
  for (std::size_t i = 0; i < chart.names.size(); ++i) out += fmt::format("{}{}: {}", i == 0 ? "" : ", ", i + 1, chart.names[i]);
  return out;
}

std::vector<double> ticks_across(const Chart& chart, const Axis& x) {
  if (chart.names.empty()) return ticks(x.low, x.high, 6, x.log);
  std::vector<double> out(chart.names.size());
  std::iota(out.begin(), out.end(), 1.0);
  return out;
}

void draw_axes(const Pen& pen, const Chart& chart, const Box& plot, const Axis& x, const Axis& y) {
  constexpr double kLeast = 1.7 * kTextSize;  // between ticks one above the other, so that their figures stay apart
  const std::vector<double> across = ticks_across(chart, x);
  const std::vector<double> up = ticks(y.low, y.high, std::clamp(static_cast<int>(plot.height / kLeast), 1, 5), y.log);
  const auto spacing = [](const std::vector<double>& at, bool log) { return log || at.size() < 2 ? 0 : at[1] - at[0]; };
  for (const double t : across) {
    pen.black(0.13);
    pen.line(x.at(t), plot.y, x.at(t), plot.bottom(), 0.4);
    pen.black();
    pen.text(tick_text(t, spacing(across, x.log)), x.at(t), plot.bottom() + 2, kTextSize, Align::centre);
  }
  for (const double t : up) {
    pen.black(0.13);
    pen.line(plot.x, y.at(t), plot.right(), y.at(t), 0.4);
    pen.black();
    const std::string word = tick_text(t, spacing(up, y.log));
    pen.text(word, plot.x - 4, y.at(t) - pen.measure(word, kTextSize).height / 2, kTextSize, Align::right);
  }
  pen.black();
  pen.frame(plot, 0.7);
  pen.text(key_of(chart), plot.x + plot.width / 2, plot.bottom() + 13, kTextSize, Align::centre, false,
           chart.names.empty() ? 0 : plot.width);
}

void draw_top_scale(const Pen& pen, const Chart& chart, const Box& plot, const Axis& x) {
  double right = plot.x;
  pen.black();
  for (const Mark& tick : chart.top) {
    if (!(tick.x >= x.low && tick.x <= x.high)) continue;
    pen.line(x.at(tick.x), plot.y, x.at(tick.x), plot.y - 3, 0.7);
    const double half = pen.measure(tick.text, kTextSize).width / 2;
    if (x.at(tick.x) - half < right) continue;  // no room beside the one before
    pen.text(tick.text, x.at(tick.x), plot.y - 12, kTextSize, Align::centre);
    right = x.at(tick.x) + half + 4;
  }
  pen.text(chart.top_label, plot.right(), plot.y - 22, kTextSize, Align::right);
}

bool shown(const Point& p) {
  return Axis::shows(p.x) && Axis::shows(p.y);
}

bool has_ends(const Point& p) {
  return Axis::shows(p.x) && Axis::shows(p.low) && Axis::shows(p.high);
}

void draw_band(const Pen& pen, const Band& band, const Axis& x, const Axis& y) {
  cairo_t* c = pen.cairo();
  if (band.points.empty()) return;
  cairo_new_path(c);
  for (const Point& p : band.points)
    if (has_ends(p)) cairo_line_to(c, x.at(p.x), y.at(p.high));
  for (auto p = band.points.rbegin(); p != band.points.rend(); ++p)
    if (has_ends(*p)) cairo_line_to(c, x.at(p->x), y.at(p->low));
  cairo_close_path(c);
  pen.black(0.14);
  cairo_fill(c);
}

void draw_line(const Pen& pen, const Line& line, int style, const Axis& x, const Axis& y) {
  cairo_t* c = pen.cairo();
  pen.ink(style);
  if (line.joined) {
    pen.dash(style);
    cairo_set_line_width(c, line.emphasised ? 1.6 : 0.9);
    cairo_new_path(c);
    for (const Point& p : line.points) {
      if (shown(p))
        cairo_line_to(c, x.at(p.x), y.at(p.y));
      else
        cairo_new_sub_path(c);  // a gap: nothing is known there
    }
    cairo_stroke(c);
    cairo_set_dash(c, nullptr, 0, 0);
  }
  for (const Point& p : line.points) {
    if (p.low != p.high && has_ends(p)) {
      pen.line(x.at(p.x), y.at(p.low), x.at(p.x), y.at(p.high), 0.8);
      for (const double end : {p.low, p.high}) pen.line(x.at(p.x) - 2.5, y.at(end), x.at(p.x) + 2.5, y.at(end), 0.8);
    }
    if (line.marker > 0 && shown(p))
      pen.marker(style, x.at(p.x), y.at(p.y), line.marker * (line.emphasised ? 1.2 * kMarkerSize : kMarkerSize));
  }
}

/// Below the plot, in as many rows as it takes. Returns the height it needs; draws only when `y` is not negative.
double legend(const Pen& pen, const Chart& chart, double left, double width, double y) {
  const double row = 10.5;
  double x = left, rows = 1;
  const bool draw = y >= 0;
  const auto entry = [&](const std::string& label, auto&& sample) {
    if (label.empty()) return;
    const double need = 24 + pen.measure(label, kTextSize).width + 10;
    if (x > left && x + need > left + width) {
      x = left;
      ++rows;
    }
    if (draw) {
      const double middle = y + (rows - 1) * row + 4.5;
      sample(x, middle);
      pen.black();
      pen.text(label, x + 22, middle - 4.6, kTextSize);
    }
    x += need;
  };
  for (std::size_t i = 0; i < chart.lines.size(); ++i)
    entry(chart.lines[i].label, [&](double at, double middle) {
      const int style = static_cast<int>(i);
      pen.ink(style);
      pen.dash(style);
      if (chart.lines[i].joined) pen.line(at, middle, at + 18, middle, chart.lines[i].emphasised ? 1.6 : 0.9);
      cairo_set_dash(pen.cairo(), nullptr, 0, 0);
      if (chart.lines[i].marker > 0) pen.marker(style, at + 9, middle, kMarkerSize);
    });
  for (const Band& band : chart.bands)
    entry(band.label, [&](double at, double middle) {
      pen.black(0.14);
      cairo_rectangle(pen.cairo(), at, middle - 4, 18, 8);
      cairo_fill(pen.cairo());
    });
  return rows * row;
}

}  // namespace

void draw_chart(const Pen& pen, const Chart& chart, const Box& box) {
  if (chart.title.empty()) return;
  pen.black();
  const double head = pen.text(chart.title, box.x, box.y, kTitleSize, Align::left, true, box.width).height + 3;
  pen.text(chart.y_label, box.x, box.y + head, kTextSize);
  Axis x, y;
  span(chart, x, y);
  Box plot{box.x + 44, box.y + head + (chart.top.empty() ? 13 : 24), box.width - 52, 0};
  if (x.empty() || y.empty()) {
    plot.height = box.height - head - 20;
    pen.frame(plot, 0.7);
    pen.text(chart.empty, plot.x + plot.width / 2, plot.y + plot.height / 2, kTextSize, Align::centre);
    return;
  }
  const double key = chart.names.empty() ? 0
                                         : pen.measure(key_of(chart), kTextSize, false, plot.width).height -
                                               pen.measure("1", kTextSize).height;  // beyond its first line
  const double below = 26 + key + legend(pen, chart, plot.x, plot.width, -1);
  plot.height = box.bottom() - below - plot.y;
  if (chart.names.empty())
    x.widen();
  else
    x.low = 0.5, x.high = static_cast<double>(chart.names.size()) + 0.5;
  y.widen();
  x.from = plot.x;
  x.to = plot.right();
  y.from = plot.bottom();
  y.to = plot.y;
  draw_axes(pen, chart, plot, x, y);
  if (!chart.top.empty()) draw_top_scale(pen, chart, plot, x);
  cairo_save(pen.cairo());
  cairo_rectangle(pen.cairo(), plot.x, plot.y, plot.width, plot.height);
  cairo_clip(pen.cairo());
  for (const Band& band : chart.bands) draw_band(pen, band, x, y);
  for (const Mark& level : chart.levels) {
    if (!Axis::shows(level.y)) continue;
    pen.black(0.8);
    pen.dash(2);
    pen.line(plot.x, y.at(level.y), plot.right(), y.at(level.y), 0.8);
    cairo_set_dash(pen.cairo(), nullptr, 0, 0);
    pen.text(level.text, plot.x + 4, y.at(level.y) - 10, kTextSize);
  }
  for (std::size_t i = chart.lines.size(); i-- > 0;) draw_line(pen, chart.lines[i], static_cast<int>(i), x, y);
  for (const Mark& mark : chart.marks) {
    if (!Axis::shows(mark.x) || !Axis::shows(mark.y)) continue;
    pen.black();
    cairo_set_line_width(pen.cairo(), 1.2);
    cairo_arc(pen.cairo(), x.at(mark.x), y.at(mark.y), 7, 0, 2 * M_PI);
    cairo_stroke(pen.cairo());
    const bool left = x.at(mark.x) > plot.x + 0.6 * plot.width;
    const Extent word = pen.measure(mark.text, kTextSize, true);
    const double top = std::clamp(y.at(mark.y) - 14, plot.y + 2, plot.bottom() - 2 - word.height);  // the frame cuts the word
    const Box place{left ? x.at(mark.x) - 10 - word.width : x.at(mark.x) + 10, top, word.width, word.height};
    cairo_set_source_rgba(pen.cairo(), 1, 1, 1, 0.8);  // lines may pass below it
    cairo_rectangle(pen.cairo(), place.x - 1, place.y, place.width + 2, place.height);
    cairo_fill(pen.cairo());
    pen.black();
    pen.text(mark.text, place.x, place.y, kTextSize, Align::left, true);
  }
  cairo_restore(pen.cairo());
  legend(pen, chart, plot.x, plot.width, plot.bottom() + 25 + key);
}

void draw_bars(const Pen& pen, const Bars& bars, const Box& box) {
  if (bars.rows.empty()) return;
  constexpr double kSample = 12, kGap = 10;
  pen.black();
  double y = box.y + pen.text(bars.title, box.x, box.y, kTitleSize, Align::left, true, box.width).height + 4;
  double label = 0, longest = 0, columns = 0;
  std::vector<double> width;
  for (const std::string& part : bars.parts) width.push_back(kSample + 4 + pen.measure(part, kTextSize, true).width);
  for (const Bar& bar : bars.rows) {
    label = std::max(label, pen.measure(bar.label, kTextSize).width);
    double sum = 0;
    for (const double part : bar.parts) sum += std::abs(part);
    longest = std::max(longest, sum);
    for (std::size_t i = 0; i < width.size() && i < bar.values.size(); ++i)
      width[i] = std::max(width[i], pen.measure(bar.values[i], kTextSize).width);
  }
  for (const double w : width) columns += w + kGap;
  label = std::min(label, 0.4 * box.width);
  const double room = box.width - label - columns - 6;
  const auto column = [&](std::size_t i) {
    double right = box.right();
    for (std::size_t k = i + 1; k < width.size(); ++k) right -= width[k] + kGap;
    return right;
  };
  // the heads of the columns are the legend
  for (std::size_t i = 0; i < bars.parts.size(); ++i) {
    const double text = pen.measure(bars.parts[i], kTextSize, true).width;
    pen.hatch(static_cast<int>(i), {column(i) - text - 4 - kSample, y + 1.5, kSample, 7});
    pen.black();
    pen.text(bars.parts[i], column(i), y, kTextSize, Align::right, true);
  }
  y += 11.2;
  pen.line(box.x, y - 0.5, box.right(), y - 0.5, 0.7);
  y += 2;
  const double row = std::clamp((box.bottom() - y) / static_cast<double>(bars.rows.size()), 9.0, 15.0);
  for (const Bar& bar : bars.rows) {
    if (y + row > box.bottom() + 1) break;
    pen.black();
    pen.text(bar.label, box.x, y + row / 2 - 4.6, kTextSize);
    double x = box.x + label + 6;
    for (std::size_t i = 0; i < bar.parts.size(); ++i) {
      const double length = longest > 0 ? room * std::abs(bar.parts[i]) / longest : 0;
      if (length > 0.2) pen.hatch(static_cast<int>(i), {x, y + 0.18 * row, length, 0.64 * row});
      x += length;
    }
    pen.black();
    for (std::size_t i = 0; i < bar.values.size() && i < width.size(); ++i)
      pen.text(bar.values[i], column(i), y + row / 2 - 4.6, kTextSize, Align::right);
    y += row;
  }
}

void draw_table(const Pen& pen, const Table& table, const Box& box) {
  if (table.rows.empty()) return;
  pen.black();
  double y = box.y + pen.text(table.title, box.x, box.y, kTitleSize, Align::left, true, box.width).height + 4;
  const std::size_t columns = table.head.size();
  const double row_height = 11.2, least_gap = 4;
  // rows that find no place under the head are left out
  const double room = std::max(0.0, (box.bottom() - y - row_height - 2) / row_height);
  const std::size_t rows = std::min(table.rows.size(), static_cast<std::size_t>(std::ceil(room)) - (room > 0 ? 1 : 0));
  std::vector<double> width(columns, 0);
  const auto grow = [&](const std::vector<std::string>& row, bool bold) {
    for (std::size_t k = 0; k < columns && k < row.size(); ++k)
      width[k] = std::max(width[k], pen.measure(row[k], kTextSize, bold).width);
  };
  grow(table.head, true);
  for (std::size_t r = 0; r < rows; ++r) grow(table.rows[r], static_cast<int>(r) == table.emphasised);
  double sum = 0;
  for (const double w : width) sum += w;
  // a table wider than its place is written smaller: no column leaves the page
  const double gaps = least_gap * static_cast<double>(columns - 1), shrink = std::min(1.0, (box.width - gaps) / sum);
  for (double& w : width) w *= shrink;
  const double size = kTextSize * shrink;
  const double gap = columns > 1 ? std::clamp((box.width - shrink * sum) / static_cast<double>(columns - 1), least_gap, 26.0) : 0;
  const auto draw_row = [&](const std::vector<std::string>& row, bool bold) {
    double x = box.x;
    for (std::size_t k = 0; k < columns && k < row.size(); ++k) {
      // the first column is words, the others are numbers
      if (k == 0)
        pen.text(row[k], x, y, size, Align::left, bold);
      else
        pen.text(row[k], x + width[k], y, size, Align::right, bold);
      x += width[k] + gap;
    }
    y += row_height;
  };
  draw_row(table.head, true);
  pen.line(box.x, y - 0.5, box.right(), y - 0.5, 0.7);
  y += 2;
  for (std::size_t r = 0; r < rows; ++r) draw_row(table.rows[r], static_cast<int>(r) == table.emphasised);
  if (!table.note.empty()) pen.text(table.note, box.x, y + 3, kTextSize, Align::left, false, box.width);
}

}  // namespace render::charts
