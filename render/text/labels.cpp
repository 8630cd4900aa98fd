#include "render/text/labels.h"

#include <cairo/cairo.h>
#include <pango/pangocairo.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "render/matrix.h"
#include "render/text/charts.h"
#include "render/text/fonts.h"

namespace render {
namespace {

constexpr double kPadX = 14, kPadY = 9, kLabelGap = 4;  // pixels at 1080 lines
constexpr double kWidest = 0.94, kHighest = 0.88;       // [-] of the picture

struct SurfaceDeleter {
  void operator()(cairo_surface_t* s) const { cairo_surface_destroy(s); }
};
struct CairoDeleter {
  void operator()(cairo_t* c) const { cairo_destroy(c); }
};
using SurfacePtr = std::unique_ptr<cairo_surface_t, SurfaceDeleter>;
using CairoPtr = std::unique_ptr<cairo_t, CairoDeleter>;

class Line {
 public:
  Line(cairo_t* cairo, const std::string& text, double pixels) : layout_(pango_cairo_create_layout(cairo)) {
    PangoFontDescription* font = pango_font_description_from_string("DejaVu Sans");
    pango_font_description_set_absolute_size(font, pixels * PANGO_SCALE);
    pango_layout_set_font_description(layout_, font);
    pango_font_description_free(font);
    pango_layout_set_text(layout_, drawable(text).c_str(), -1);
    pango_layout_get_pixel_size(layout_, &width_, &height_);
  }
  ~Line() { g_object_unref(layout_); }
  Line(const Line&) = delete;
  Line& operator=(const Line&) = delete;
  PangoLayout* layout() const { return layout_; }
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  PangoLayout* layout_;
  int width_ = 0, height_ = 0;
};

PanelBox measure(cairo_t* cairo, const LabelItem& label, double scale) {
  PanelBox box;
  for (std::size_t i = 0; i < label.lines.size(); ++i) {
    const Line line(cairo, label.lines[i], label.sizes[i] * scale);
    box.width = std::max<double>(box.width, line.width());
    box.height += line.height() + (i > 0 ? kLabelGap * scale : 0);
  }
  box.width += 2 * kPadX * scale;
  box.height += 2 * kPadY * scale;
  return box;
}

bool overlap(const PanelBox& a, const PanelBox& b) {
  return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

/// Anchor of a label in pixels; nothing if its world point is behind the camera or outside.
bool anchor_of(const DrawList& list, const LabelItem& label, int width, int height, double& x, double& y) {
  if (!label.at_world_point) {
    x = static_cast<double>(label.anchor[0]) * width;
    y = static_cast<double>(label.anchor[1]) * height;
    return true;
  }
  const Eigen::Vector4d p = from_gl(list.view.eye_to_clip) * from_gl(list.view.world_to_eye) *
                            Eigen::Vector4d(label.world[0], label.world[1], label.world[2], 1);
  if (p.w() <= 0.05) return false;
  x = (p.x() / p.w() * 0.5 + 0.5) * width;
  y = (0.5 - p.y() / p.w() * 0.5) * height;
  return x > -0.1 * width && x < 1.1 * width && y > -0.1 * height && y < 1.1 * height;
}

/// Around each of the limbs before the camera.
std::vector<PanelBox> limbs_of(const DrawList& list, int width, int height) {
  const Mat4 world_to_clip = from_gl(list.view.eye_to_clip) * from_gl(list.view.world_to_eye);
  std::vector<PanelBox> out;
  for (const Float4& ball : list.limbs) {
    const Eigen::Vector4d p = world_to_clip * Eigen::Vector4d(ball[0], ball[1], ball[2], 1);
    if (p.w() <= 0.05) continue;
    const double radius = static_cast<double>(ball[3] * list.view.eye_to_clip[5]) / p.w() * height / 2;
    out.push_back(
        {(p.x() / p.w() * 0.5 + 0.5) * width - radius, (0.5 - p.y() / p.w() * 0.5) * height - radius, 2 * radius, 2 * radius});
  }
  return out;
}

/// Moves a panel step by step up and down until nothing of `taken` lies underneath, and nothing of `spared` if there is such a
/// place nearby. Not shown where there is none.
void find_room(PanelBox& box, const std::vector<PanelBox>& taken, const std::vector<PanelBox>& spared, int width, int height) {
  constexpr int kNearby = 24, kAttempts = 40;
  const auto lies_over = [&box](const std::vector<PanelBox>& others) {
    return std::any_of(others.begin(), others.end(), [&](const PanelBox& b) { return overlap(b, box); });
  };
  const double wanted_y = box.y;
  std::optional<PanelBox> second_best;
  for (int attempt = 0; attempt <= (second_best ? kNearby : kAttempts); ++attempt) {
    const int steps = (attempt + 1) / 2;
    const double step = steps * 0.35 * box.height;
    box.x = std::clamp(box.x, 0.0, width - box.width);
    box.y = std::clamp(wanted_y + (attempt % 2 ? -step : step), 0.0, height - box.height);
    if (lies_over(taken)) continue;
    if (!lies_over(spared)) return;
    if (!second_best) second_best = box;
  }
  box = second_best.value_or(box);
  box.shown = second_best.has_value();
}

CairoPtr scratch() {
  const SurfacePtr surface(cairo_image_surface_create(CAIRO_FORMAT_ARGB32, 1, 1));
  return CairoPtr(cairo_create(surface.get()));
}

void rounded(cairo_t* c, const PanelBox& b, double r) {
  cairo_new_sub_path(c);
  cairo_arc(c, b.x + b.width - r, b.y + r, r, -M_PI / 2, 0);
  cairo_arc(c, b.x + b.width - r, b.y + b.height - r, r, 0, M_PI / 2);
  cairo_arc(c, b.x + r, b.y + b.height - r, r, M_PI / 2, M_PI);
  cairo_arc(c, b.x + r, b.y + r, r, M_PI, 1.5 * M_PI);
  cairo_close_path(c);
}

/// From the edge of the panel to what it speaks of, light with a dark edge.
void draw_leader(cairo_t* c, const PanelBox& box, double x, double y, double scale) {
  const double from_x = std::clamp(x, box.x, box.x + box.width), from_y = std::clamp(y, box.y, box.y + box.height);
  if (std::hypot(x - from_x, y - from_y) < 8 * scale) return;
  for (const bool edge : {true, false}) {
    paint_with(c, edge ? Float4{0, 0, 0, 0.55f} : Float4{1, 1, 1, 0.85f});
    cairo_set_line_width(c, std::max(1.0, (edge ? 3.4 : 1.5) * scale));
    cairo_move_to(c, from_x, from_y);
    cairo_line_to(c, x, y);
    cairo_stroke(c);
  }
}

void draw_one(cairo_t* c, const LabelItem& label, const PanelBox& box, double scale) {
  if (label.plate) {
    rounded(c, box, 7 * scale);
    paint_with(c, {0.08f, 0.09f, 0.10f, 0.72f});
    cairo_fill(c);
  }
  double y = box.y + kPadY * scale;
  for (std::size_t i = 0; i < label.lines.size(); ++i) {
    const Line line(c, label.lines[i], label.sizes[i] * scale);
    const double x = std::round(box.x + kPadX * scale);
    if (!label.plate) {  // a soft dark edge keeps bare text readable on any ground
      paint_with(c, {0, 0, 0, 0.55f});
      cairo_move_to(c, x + 1, std::round(y) + 1);
      pango_cairo_show_layout(c, line.layout());
    }
    const Float4& k = label.colours[i];
    paint_with(c, k);
    cairo_move_to(c, x, std::round(y));
    pango_cairo_show_layout(c, line.layout());
    y += line.height() + kLabelGap * scale;
  }
}

/// A line broken between its items; an item by itself, and a line of none, at words.
std::vector<std::string> broken_at_items(cairo_t* cairo, const std::string& line, double pixels, double width) {
  std::vector<std::string> out;
  const std::string gap = kItemGap;
  for (std::size_t from = 0; from <= line.size();) {
    const std::size_t to = std::min(line.find(gap, from), line.size());
    const std::string item = line.substr(from, to - from);
    if (!out.empty() && Line(cairo, out.back() + gap + item, pixels).width() <= width)
      out.back() += gap + item;
    else
      for (std::string& piece : broken_at_words(item, pixels, width)) out.push_back(std::move(piece));
    from = to + gap.size();
  }
  return out;
}

/// The labels as they are written: lines of a panel that hangs on nothing in the scene are broken where it would leave the picture.
std::vector<LabelItem> written(const DrawList& list, double scale, int width) {
  std::vector<LabelItem> out = list.labels;
  const CairoPtr cairo = scratch();
  for (LabelItem& label : out) {
    if (label.at_world_point || !label.plate || measure(cairo.get(), label, scale).width <= kWidest * width) continue;
    const LabelItem whole = label;
    label.lines.clear(), label.sizes.clear(), label.colours.clear();
    for (std::size_t i = 0; i < whole.lines.size(); ++i)
      for (std::string& piece :
           broken_at_items(cairo.get(), whole.lines[i], whole.sizes[i] * scale, kWidest * width - 2 * kPadX * scale)) {
        label.lines.push_back(std::move(piece));
        label.sizes.push_back(whole.sizes[i]);
        label.colours.push_back(whole.colours[i]);
      }
  }
  return out;
}

std::vector<PanelBox> place(const DrawList& list, const std::vector<LabelItem>& labels, int width, int height) {
  const double scale = height / 1080.0 * static_cast<double>(list.scale);
  const CairoPtr cairo = scratch();
  std::vector<PanelBox> taken;  // charts and reserved places come first
  for (const ChartItem& chart : list.charts) {
    const auto [x, y, w, h] = chart_box(chart, width, height);
    taken.push_back({x, y, w, h});
  }
  for (const auto& [x, y, w, h] : list.reserved)
    taken.push_back({static_cast<double>(x) * width, static_cast<double>(y) * height, static_cast<double>(w) * width,
                     static_cast<double>(h) * height});
  const std::vector<PanelBox> limbs = limbs_of(list, width, height), nothing;
  std::vector<PanelBox> boxes;
  for (const LabelItem& label : labels) {
    PanelBox box = measure(cairo.get(), label, scale);
    // a page of writing is written smaller where it would leave the picture, and so is what must be read
    const double room = std::min(kWidest * width / box.width, kHighest * height / box.height);
    if ((!label.plate || label.always) && !label.leader && room < 1) {
      box = measure(cairo.get(), label, scale * room);
      box.shrink = room;
    }
    double x = 0, y = 0;
    box.shown = anchor_of(list, label, width, height, x, y) && box.width <= width && box.height <= height;
    box.x = x - label.pivot[0] * box.width;
    box.y = y - label.pivot[1] * box.height;
    const PanelBox wanted = box;
    if (box.shown) find_room(box, taken, label.leader ? limbs : nothing, width, height);
    if (!box.shown && label.always) box = wanted;
    if (box.shown) taken.push_back(box);
    boxes.push_back(box);
  }
  return boxes;
}

}  // namespace

std::vector<PanelBox> place_labels(const DrawList& list, int width, int height) {
  return place(list, written(list, height / 1080.0 * static_cast<double>(list.scale), width), width, height);
}

std::vector<std::string> broken_at_words(const std::string& text, double pixels, double width) {
  const CairoPtr cairo = scratch();
  const std::string shown = drawable(text);
  const Line line(cairo.get(), shown, pixels);
  if (line.width() <= width) return {text};
  pango_layout_set_width(line.layout(), static_cast<int>(width * PANGO_SCALE));
  pango_layout_set_wrap(line.layout(), PANGO_WRAP_WORD_CHAR);
  std::vector<std::string> out;
  for (int i = 0; i < pango_layout_get_line_count(line.layout()); ++i) {
    const PangoLayoutLine* piece = pango_layout_get_line_readonly(line.layout(), i);
    std::string words = shown.substr(static_cast<std::size_t>(piece->start_index), static_cast<std::size_t>(piece->length));
    while (words.ends_with(' ')) words.pop_back();
    out.push_back(std::move(words));
  }
  return out;
}

void draw_labels(const DrawList& list, Image& image) {
  if (list.labels.empty() && list.charts.empty()) return;
  require_font();
  const double scale = image.height / 1080.0 * static_cast<double>(list.scale);
  {
    // cairo counts blue first where the picture has red: the hues are handed over swapped (see paint_with); what is opaque stays so
    const SurfacePtr surface(
        cairo_image_surface_create_for_data(image.rgba.data(), CAIRO_FORMAT_ARGB32, image.width, image.height, 4 * image.width));
    const CairoPtr cairo(cairo_create(surface.get()));
    for (const ChartItem& chart : list.charts) draw_chart(cairo.get(), chart, image.width, image.height);
    const std::vector<LabelItem> labels = written(list, scale, image.width);
    const std::vector<PanelBox> boxes = place(list, labels, image.width, image.height);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      double x = 0, y = 0;
      if (boxes[i].shown && labels[i].leader && anchor_of(list, labels[i], image.width, image.height, x, y))
        draw_leader(cairo.get(), boxes[i], x, y, scale);
    }
    for (std::size_t i = 0; i < boxes.size(); ++i)
      if (boxes[i].shown) draw_one(cairo.get(), labels[i], boxes[i], scale * boxes[i].shrink);
    cairo_surface_flush(surface.get());
  }
}

}  // namespace render
