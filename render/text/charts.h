// Small diagrams on the finished picture.
#pragma once

#include <cairo/cairo.h>

#include "render/draw_list.h"

namespace render {

/// Left, top, width and height [pixels], kept inside the frame.
std::array<double, 4> chart_box(const ChartItem&, int width, int height);

void draw_chart(cairo_t*, const ChartItem&, int width, int height);

}  // namespace render
