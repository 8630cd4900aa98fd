// The passes of a frame: shadow map, things in their own rectangle, background where they leave it to be seen, skid marks, the
// light of things, lines, labels. Work is done where it can be seen, and every pass depends on the frame's list alone.
#include "render/renderer.h"

#include <algorithm>
#include <vector>

#include "render/gl/background_pass.h"
#include "render/gl/context.h"
#include "render/gl/light_pass.h"
#include "render/gl/mark_pass.h"
#include "render/gl/object_pass.h"
#include "render/gl/overlay_pass.h"
#include "render/gl/pieces.h"
#include "render/gl/shadow_pass.h"
#include "render/text/labels.h"

namespace render {
namespace {

using namespace gl;

constexpr int kBandSamples = 8'500'000;  // that the object pass holds: 1080p at four samples in one band, 70 MB
constexpr int kStrip = 32;               // rows that are lit at a time: their surfaces stay in the cache

}  // namespace

struct Renderer::Impl {
  Impl(int w, int h, const Effort& e) : width(w), height(h), effort(e), context() {}

  shade::Canvas canvas_on(Image&);
  void reduce(Image&) const;

  int width, height;  // of the picture handed out
  Effort effort;
  GlContext context;
  GeometryCache geometry;
  MaterialTable materials;
  ShadowPass shadow;
  BackgroundPass background;
  MarkPass marks;
  ObjectPass objects;
  LightPass light;
  gl::OverlayPass overlays;
  std::vector<std::uint8_t> large;    // the canvas, lowest row first, where it is larger than the picture
  std::vector<std::uint8_t> covered;  // of its pixels, by things
  FrameCost cost{};
};

/// The picture itself, or a larger one.
shade::Canvas Renderer::Impl::canvas_on(Image& out) {
  out.width = width;
  out.height = height;
  const std::size_t row = 4 * static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
  out.rgba.resize(row * rows);
  if (effort.scale == 1) return {out.rgba.data() + row * (rows - 1), width, height, -width};
  const std::size_t scale = static_cast<std::size_t>(effort.scale);
  large.resize(scale * scale * row * rows);
  return {large.data(), width * effort.scale, height * effort.scale, width * effort.scale};
}

/// A square of the canvas, `scale` pixels a side, becomes one pixel: its mean.
void Renderer::Impl::reduce(Image& out) const {
  const std::size_t side = static_cast<std::size_t>(effort.scale), row = 4 * static_cast<std::size_t>(width), pitch = side * row;
  for (std::size_t y = 0, rows = static_cast<std::size_t>(height); y < rows; ++y) {
    std::uint8_t* to = out.rgba.data() + row * (rows - 1 - y);
    const std::uint8_t* from = large.data() + side * pitch * y;
    for (int x = 0; x < width; ++x, to += 4, from += 4 * side) {
      for (std::size_t c = 0; c < 4; ++c) {
        std::size_t sum = side * side / 2;
        for (std::size_t j = 0; j < side; ++j)
          for (std::size_t i = 0; i < side; ++i) sum += from[j * pitch + 4 * i + c];
        to[c] = static_cast<std::uint8_t>(sum / (side * side));
      }
    }
  }
}

Renderer::Renderer(int width, int height, Quality quality) : Renderer(width, height, effort_of(quality, width, height)) {}
Renderer::Renderer(int width, int height, const Effort& effort) : impl_(std::make_unique<Impl>(width, height, effort)) {}
Renderer::~Renderer() {
  impl_->context.make_current();  // its names die in it
}

void Renderer::draw(const DrawList& list, Image& out) {
  Impl& r = *impl_;
  const Effort& effort = r.effort;
  const shade::Canvas canvas = r.canvas_on(out);
  const int width = canvas.width, height = canvas.height;
  r.context.make_current();
  r.cost = {};
  Stopwatch watch(r.cost);
  std::vector<CasterBox> boxes;
  const std::vector<Piece> pieces = collect(list, r.geometry, r.materials, effort.pixel_share, height, boxes);
  const FrameSetup frame = set_up_frame(list, boxes, width, height, effort.shadow_map_size);
  watch.lap(Pass::set_up);
  r.shadow.draw(effort, pieces, frame);
  watch.lap(Pass::shadow);
  const shade::Maps maps = r.shadow.maps(effort, list.road);
  r.background.begin(list, frame, r.shadow.bounds(), maps, canvas, effort.ground_step);
  r.marks.begin(list, frame, width, height);
  const bool terrain = list.road.terrain != nullptr;
  if (!terrain) r.marks.draw();
  r.overlays.begin(list, width, height);
  const auto draw_ground = [&](int y0, int y1, const std::uint8_t* covered) {
    r.background.draw(y0, y1, covered, maps, canvas);
    if (!terrain) r.marks.lay(y0, y1, canvas);
    watch.lap(Pass::background);
  };
  watch.lap(Pass::background);
  r.covered.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) + 7);
  const Rectangle objects = terrain ? Rectangle{0, 0, width, height} : frame.objects;
  const int band_height = std::clamp(kBandSamples / (width * effort.samples * effort.samples), 16, height);
  int done = 0;  // rows of the background
  for (int y = objects.y; y < objects.y + objects.height; y += band_height) {
    const Rectangle band{objects.x, y, objects.width, std::min(band_height, objects.y + objects.height - y)};
    r.objects.draw(list, pieces, frame, width, height, effort.samples, band);
    r.overlays.draw_behind(r.objects, {0, y, width, band.height}, effort.samples);
    if (terrain) r.marks.draw_on(r.objects, band, effort.samples);
    watch.lap(Pass::objects);
    draw_ground(done, y, nullptr);
    for (done = y; done < y + band.height;) {
      const Rectangle strip{band.x, done, band.width, std::min(kStrip, y + band.height - done)};
      r.objects.read(strip, effort.samples);
      r.light.find(r.objects, strip, effort.samples, canvas, r.covered.data());
      watch.lap(Pass::objects);
      done += strip.height;
      draw_ground(strip.y, done, r.covered.data());
      r.light.draw({frame.data, maps, r.materials.rows(), terrain, effort.samples}, r.objects, canvas);
      if (terrain) r.marks.lay(strip.y, done, canvas);
      watch.lap(Pass::light);
    }
  }
  draw_ground(done, height, nullptr);
  const int top = objects.y + objects.height;
  r.overlays.draw_behind({0, 0, width, objects.y});
  r.overlays.draw_behind({0, top, width, height - top});
  r.overlays.finish(canvas);
  watch.lap(Pass::lines);
  if (effort.scale > 1) r.reduce(out);
  watch.lap(Pass::read_back);
  draw_labels(list, out);
  watch.lap(Pass::labels);
}

const FrameCost& Renderer::cost() const {
  return impl_->cost;
}

std::string gl_description() {
  return GlContext().description();
}

}  // namespace render
