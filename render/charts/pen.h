// A cairo context with the few verbs charts need: text by pango, lines, markers and hatching, all in points of 1/72 inch.
#pragma once

#include <cairo/cairo.h>

#include <string>

namespace render::charts {

enum class Align { left, centre, right };

struct Box {
  double x = 0, y = 0, width = 0, height = 0;
  double right() const { return x + width; }
  double bottom() const { return y + height; }
};

struct Extent {
  double width = 0, height = 0;
};

class Pen {
 public:
  explicit Pen(cairo_t* cairo) : c_(cairo) {}
  cairo_t* cairo() const { return c_; }

  Extent measure(const std::string& text, double size, bool bold = false, double wrap = 0) const;
  /// Text with its upper edge at y; wrapped at `wrap` points if that is positive. Returns its extent.
  Extent text(const std::string&, double x, double y, double size, Align = Align::left, bool bold = false, double wrap = 0) const;
  /// Turned to read upwards, centred on (x, y).
  void text_upwards(const std::string&, double x, double y, double size) const;

  void ink(int style) const;  // colour of a style; each is as dark in grey as its neighbour is not
  void black(double alpha = 1) const;
  void line(double x0, double y0, double x1, double y1, double width) const;
  void frame(const Box&, double width) const;
  void dash(int style) const;  // solid, dashed, dotted ...
  void marker(int style, double x, double y, double size) const;
  /// Fills a box with the hatching of a style, framed.
  void hatch(int style, const Box&) const;

 private:
  cairo_t* c_;
};

}  // namespace render::charts
