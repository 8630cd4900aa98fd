#include "render/charts/pen.h"

#include <pango/pangocairo.h>

#include <cmath>
#include <memory>

#include "render/text/fonts.h"

namespace render::charts {
namespace {

struct Unref {
  void operator()(PangoLayout* layout) const { g_object_unref(layout); }
};
using Layout = std::unique_ptr<PangoLayout, Unref>;

Layout layout_of(cairo_t* c, const std::string& text, double size, bool bold, double wrap) {
  require_font();
  Layout layout(pango_cairo_create_layout(c));
  PangoFontDescription* font = pango_font_description_from_string(bold ? "DejaVu Sans Bold" : "DejaVu Sans");
  // a layout counts in device units, which are points here
  pango_font_description_set_absolute_size(font, size * PANGO_SCALE);
  pango_layout_set_font_description(layout.get(), font);
  pango_font_description_free(font);
  // widths as printed, not as hinted for a screen
  cairo_font_options_t* options = cairo_font_options_create();
  cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  pango_cairo_context_set_font_options(pango_layout_get_context(layout.get()), options);
  cairo_font_options_destroy(options);
  if (wrap > 0) {
    pango_layout_set_width(layout.get(), static_cast<int>(wrap * PANGO_SCALE));
    pango_layout_set_wrap(layout.get(), PANGO_WRAP_WORD_CHAR);
  }
  pango_layout_set_text(layout.get(), drawable(text).c_str(), -1);
  return layout;
}

Extent extent_of(PangoLayout* layout) {
  int width = 0, height = 0;
  pango_layout_get_size(layout, &width, &height);
  return {static_cast<double>(width) / PANGO_SCALE, static_cast<double>(height) / PANGO_SCALE};
}

constexpr int kStyles = 12;  // told apart by shape and dash where ink does not
constexpr double kInks[kStyles][3] = {{0.00, 0.00, 0.00}, {0.75, 0.22, 0.10}, {0.10, 0.35, 0.65}, {0.35, 0.35, 0.35},
                                      {0.10, 0.45, 0.25}, {0.50, 0.20, 0.55}, {0.60, 0.45, 0.10}, {0.25, 0.50, 0.55},
                                      {0.55, 0.05, 0.25}, {0.20, 0.25, 0.50}, {0.40, 0.55, 0.15}, {0.15, 0.15, 0.15}};

}  // namespace

Extent Pen::measure(const std::string& text, double size, bool bold, double wrap) const {
  return extent_of(layout_of(c_, text, size, bold, wrap).get());
}

Extent Pen::text(const std::string& text, double x, double y, double size, Align align, bool bold, double wrap) const {
  const Layout layout = layout_of(c_, text, size, bold, wrap);
  const Extent extent = extent_of(layout.get());
  const double shift = align == Align::left ? 0 : (align == Align::centre ? 0.5 : 1.0);
  cairo_move_to(c_, x - shift * extent.width, y);
  pango_cairo_show_layout(c_, layout.get());
  return extent;
}

void Pen::text_upwards(const std::string& text, double x, double y, double size) const {
  const Extent extent = measure(text, size);
  cairo_save(c_);
  cairo_translate(c_, x, y);
  cairo_rotate(c_, -M_PI / 2);
  this->text(text, -extent.width / 2, -extent.height / 2, size);
  cairo_restore(c_);
}

void Pen::ink(int style) const {
  const double* k = kInks[style % kStyles];
  cairo_set_source_rgb(c_, k[0], k[1], k[2]);
}

void Pen::black(double alpha) const {
  cairo_set_source_rgba(c_, 0, 0, 0, alpha);
}

void Pen::line(double x0, double y0, double x1, double y1, double width) const {
  cairo_set_line_width(c_, width);
  cairo_move_to(c_, x0, y0);
  cairo_line_to(c_, x1, y1);
  cairo_stroke(c_);
}

void Pen::frame(const Box& b, double width) const {
  cairo_set_line_width(c_, width);
  cairo_rectangle(c_, b.x, b.y, b.width, b.height);
  cairo_stroke(c_);
}

void Pen::dash(int style) const {
  constexpr double kDashes[kStyles][4] = {
      {0},          {6, 2.5, 6, 2.5}, {1.5, 2, 1.5, 2}, {7, 2, 1.5, 2}, {3, 2, 3, 2}, {10, 3, 10, 3},
      {1, 3, 1, 3}, {5, 1, 1, 1},     {9, 1.5, 9, 1.5}, {4, 4, 1, 4},   {2, 1, 2, 1}, {12, 2, 3, 2}};
  cairo_set_dash(c_, kDashes[style % kStyles], style % kStyles == 0 ? 0 : 4, 0);
}

void Pen::marker(int style, double x, double y, double size) const {
  const double r = size / 2;
  const bool hollow = style % 2 == 1;
  cairo_new_path(c_);
  switch ((style % kStyles) / 2) {
    case 0:
      cairo_arc(c_, x, y, r, 0, 2 * M_PI);
      break;
    case 1:
      cairo_rectangle(c_, x - 0.9 * r, y - 0.9 * r, 1.8 * r, 1.8 * r);
      break;
    case 2:
      cairo_move_to(c_, x, y - 1.2 * r);
      cairo_line_to(c_, x + 1.1 * r, y + 0.8 * r);
      cairo_line_to(c_, x - 1.1 * r, y + 0.8 * r);
      break;
    case 3:
      cairo_move_to(c_, x, y - 1.3 * r);
      cairo_line_to(c_, x + 1.3 * r, y);
      cairo_line_to(c_, x, y + 1.3 * r);
      cairo_line_to(c_, x - 1.3 * r, y);
      break;
    case 4:
      cairo_move_to(c_, x, y + 1.2 * r);
      cairo_line_to(c_, x + 1.1 * r, y - 0.8 * r);
      cairo_line_to(c_, x - 1.1 * r, y - 0.8 * r);
      break;
    default:  // a cross
      for (const auto& [right, down] :
           {std::pair{-1, -3}, {1, -3}, {1, -1}, {3, -1}, {3, 1}, {1, 1}, {1, 3}, {-1, 3}, {-1, 1}, {-3, 1}, {-3, -1}, {-1, -1}})
        cairo_line_to(c_, x + 0.42 * r * right, y + 0.42 * r * down);
  }
  cairo_close_path(c_);
  cairo_save(c_);
  if (hollow) cairo_set_source_rgb(c_, 1, 1, 1);
  cairo_fill_preserve(c_);
  cairo_restore(c_);
  cairo_set_dash(c_, nullptr, 0, 0);
  cairo_set_line_width(c_, 0.9);
  cairo_stroke(c_);
}

void Pen::hatch(int style, const Box& b) const {
  cairo_save(c_);
  cairo_rectangle(c_, b.x, b.y, b.width, b.height);
  cairo_clip(c_);
  black(style == 0 ? 0.75 : 0.08);
  cairo_paint(c_);
  black(0.8);
  if (style > 0) {
    const double gap = style == 1 ? 4 : 3;
    for (double d = -b.height; d < b.width; d += gap) {
      if (style == 1) line(b.x + d, b.bottom(), b.x + d + b.height, b.y, 0.6);
      if (style >= 2) line(b.x + d + b.height, b.y, b.x + d + b.height, b.bottom(), 0.5);
    }
  }
  cairo_restore(c_);
  black();
  frame(b, 0.6);
}

}  // namespace render::charts
