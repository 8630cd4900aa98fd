// Small diagrams on the finished picture.
#pragma once

#include <cairo/cairo.h>

#include "render/draw_list.h"

namespace render {

/// For surfaces laid over a picture's memory: cairo counts blue first where the picture has red, so the hue is handed over swapped.
void paint_with(cairo_t*, const Float4& colour);

/// Left, top, width and height [pixels], kept inside the frame.
std::array<double, 4> chart_box(const ChartItem&, int width, int height);

void draw_chart(cairo_t*, const ChartItem&, int width, int height);

}  // namespace render
