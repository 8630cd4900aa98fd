#include "render/painter.h"

#include <algorithm>

#include "render/card.h"
#include "render/text/charts.h"
#include "render/text/labels.h"

namespace render {
namespace {

constexpr int kBorder = 2;       // [pixels at 1080 lines] half of the line between two panes
constexpr double kInset = 0.34;  // [-] of the frame's sides
constexpr std::uint8_t kPaper[] = {24, 27, 31, 255};

void fill(Image& image, const Pane& pane) {
  for (int y = std::max(pane.y, 0); y < std::min(pane.y + pane.height, image.height); ++y)
    for (int x = std::max(pane.x, 0); x < std::min(pane.x + pane.width, image.width); ++x)
      std::copy(kPaper, kPaper + 4, &image.rgba[static_cast<std::size_t>(4 * (y * image.width + x))]);
}

void lay(const Image& picture, const Pane& pane, Image& onto) {
  for (int y = 0; y < pane.height; ++y)
    std::copy_n(&picture.rgba[static_cast<std::size_t>(4 * y * picture.width)], 4 * pane.width,
                &onto.rgba[static_cast<std::size_t>(4 * ((pane.y + y) * onto.width + pane.x))]);
}

Image blank(int width, int height) {
  Image image;
  image.width = width;
  image.height = height;
  image.rgba.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4);
  fill(image, {0, 0, width, height});
  return image;
}

/// The part of a place in the whole frame (0..1) that lies in a pane, in 0..1 of the pane.
std::array<float, 4> in_pane(const PanelBox& box, const Pane& pane) {
  return {static_cast<float>((box.x - pane.x) / pane.width), static_cast<float>((box.y - pane.y) / pane.height),
          static_cast<float>(box.width / pane.width), static_cast<float>(box.height / pane.height)};
}

LabelItem camera_name(const std::string& name) {
  LabelItem label;
  label.lines = {name};
  label.sizes = {20};
  label.colours = {kPaleText};
  label.anchor = {0.5f, 0.02f};
  label.pivot = {0.5f, 0};
  return label;
}

}  // namespace

std::vector<Pane> panes_of(Layout layout, int width, int height) {
  const Pane whole{0, 0, width, height};
  const int border = std::max(1, kBorder * height / 1080);
  switch (layout) {
    case Layout::single:
      return {whole};
    case Layout::split: {
      const int half = width / 2 - border;
      return {{0, 0, half, height}, {width - half, 0, half, height}};
    }
    case Layout::stacked: {
      const int half = height / 2 - border;
      return {{0, 0, width, half}, {0, height - half, width, half}};
    }
    case Layout::inset: {
      // below the middle of the right edge: caption, legend and charts stand in the corners
      const int w = static_cast<int>(kInset * width), h = static_cast<int>(kInset * height);
      return {whole, {width - w - width / 60, height - h - height / 8, w, h}};
    }
  }
  return {whole};
}

Renderer& Painter::renderer(int width, int height) {
  std::unique_ptr<Renderer>& r = renderers_[{width, height}];
  if (!r) r = std::make_unique<Renderer>(width, height, quality_);
  return *r;
}

void Painter::paint(const Stage& stage, const engine::Recording& recording, const Moment& moment, Image& out) {
  cost_ = {};
  Stopwatch watch(cost_);
  if (moment.card >= 0) {
    out = blank(width_, height_);
    draw_labels(card_page(stage, stage.cards[static_cast<std::size_t>(moment.card)], width_, height_).list, out);
    watch.lap(Pass::labels);
  } else if (moment.layout == Layout::single) {
    const DrawList list = arrange(stage, recording, moment, static_cast<double>(width_) / height_);
    watch.lap(Pass::arrange);
    Renderer& r = renderer(width_, height_);
    r.draw(list, out);
    add(r.cost(), cost_);
  } else {
    paint_panes(stage, recording, moment, out);
  }
}

void Painter::paint_panes(const Stage& stage, const engine::Recording& recording, const Moment& moment, Image& out) {
  const std::vector<Pane> panes = panes_of(moment.layout, width_, height_);
  Stopwatch watch(cost_);
  DrawList sheet = arrange(stage, recording, moment, static_cast<double>(width_) / height_, Layer::sheet);
  if (moment.layout == Layout::inset) {
    const Pane& p = panes[1];
    sheet.reserved.push_back(in_pane(
        {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.width), static_cast<double>(p.height), true},
        panes[0]));
  }
  // what lies on the whole picture keeps its place; the labels of a pane move out of its way
  std::vector<PanelBox> taken = place_labels(sheet, width_, height_);
  for (const ChartItem& chart : sheet.charts) {
    const auto [x, y, w, h] = chart_box(chart, width_, height_);
    taken.push_back({x, y, w, h, true});
  }
  out = blank(width_, height_);
  for (std::size_t i = 0; i < panes.size(); ++i) {
    const Pane& pane = panes[i];
    Moment view = moment;
    if (i == 1) view.camera = moment.second;
    DrawList list = arrange(stage, recording, view, static_cast<double>(pane.width) / pane.height, Layer::scene);
    for (const PanelBox& box : taken)
      if (box.shown) list.reserved.push_back(in_pane(box, pane));
    if (i == 0 && moment.layout == Layout::inset)
      list.reserved.insert(list.reserved.end(), sheet.reserved.begin(), sheet.reserved.end());
    // as large as on the whole picture, but a small inset has no room for that
    list.scale = std::min(static_cast<float>(height_) / static_cast<float>(pane.height), 1.9f);
    list.labels.insert(list.labels.begin(), camera_name(view.camera));
    watch.lap(Pass::arrange);
    Image picture;
    Renderer& r = renderer(pane.width, pane.height);
    r.draw(list, picture);
    add(r.cost(), cost_);
    watch = Stopwatch(cost_);
    const int border = std::max(1, kBorder * height_ / 1080);
    if (i == 1) fill(out, {pane.x - border, pane.y - border, pane.width + 2 * border, pane.height + 2 * border});
    lay(picture, pane, out);
  }
  draw_labels(sheet, out);
  watch.lap(Pass::labels);
}

}  // namespace render
