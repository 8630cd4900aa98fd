// Small diagrams on the finished picture.
#pragma once

#include <cairo/cairo.h>

#include <cstddef>
#include <string>

#include "render/draw_list.h"

namespace render {

/// For surfaces laid over a picture's memory: cairo counts blue first where the picture has red, so the hue is handed over swapped.
void paint_with(cairo_t*, const Float4& colour);

/// Left, top, width and height [pixels], kept inside the frame.
std::array<double, 4> chart_box(const ChartItem&, int width, int height);

/// The names above a chart: in one row or two, smaller where they are many or long, and as many as can be read.
struct ChartKey {
  double letters = 0;          // [pixels] at least 8, or the full size in a small picture
  std::size_t shown = 0;       // series, from the first; at least one
  std::size_t second_row = 0;  // the first series of the second row; `shown` where only `more` stands there
  bool two_rows = false;
  std::string more;  // "and 3 more", last of all; empty: all are shown
};
/// `room` [pixels] of a row; `scale` of the picture against 1080 lines.
ChartKey key_of(cairo_t*, const ChartItem&, double room, double scale);

void draw_chart(cairo_t*, const ChartItem&, int width, int height);

}  // namespace render
