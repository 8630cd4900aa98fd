// Draws one chart, one bar picture or one table into a box.
#pragma once

#include "render/charts/page.h"
#include "render/charts/pen.h"

namespace render::charts {

void draw_chart(const Pen&, const Chart&, const Box&);
void draw_bars(const Pen&, const Bars&, const Box&);
void draw_table(const Pen&, const Table&, const Box&);
/// What bars and table below charts take of `room`: what they need, two fifths at most; the charts have the rest.
double height_below_charts(const Page&, double room);

}  // namespace render::charts
