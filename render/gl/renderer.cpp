// The passes of a frame: shadow map, background, ground in shade, skid marks, objects in their own rectangle, composition, lines,
// read-back, labels. Work is done where it can be seen, and every pass depends on the frame's list alone.
#include "render/renderer.h"

#include <algorithm>
#include <vector>

#include "render/gl/background_pass.h"
#include "render/gl/context.h"
#include "render/gl/light_pass.h"
#include "render/gl/object_pass.h"
#include "render/gl/overlay_pass.h"
#include "render/gl/pieces.h"
#include "render/gl/shadow_pass.h"
#include "render/gl/strip_pass.h"
#include "render/gl/studio.h"
#include "render/text/labels.h"

namespace render {
namespace {

using namespace gl;

/// A lap once GL has done the pass.
void lap(Stopwatch& watch, Pass pass) {
  glFinish();
  watch.lap(pass);
}

}  // namespace

struct Renderer::Impl {
  Impl(int w, int h, const Effort& effort) : width(w), height(h), context(16, 16), studio(w, h, effort) {}

  void read(Image&);

  int width, height;
  GlContext context;
  Studio studio;
  GeometryCache geometry;
  MaterialTable materials;
  ShadowPass shadow;
  BackgroundPass background;
  StripPass strips;
  LightPass light;
  gl::OverlayPass overlays;
  FrameCost cost{};
};

void Renderer::Impl::read(Image& out) {
  out.width = width;
  out.height = height;
  const std::size_t row = 4 * static_cast<std::size_t>(width);
  out.rgba.resize(row * static_cast<std::size_t>(height));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, *studio.targets.picture);
  if (studio.cost.scale > 1) {
    // half the size with linear filter: the mean of two by two
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, *studio.targets.out);
    glBlitFramebuffer(0, 0, studio.targets.width, studio.targets.height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_LINEAR);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, *studio.targets.out);
  }
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, out.rgba.data());
  for (int y = 0; y < height / 2; ++y) {
    std::uint8_t* a = out.rgba.data() + row * static_cast<std::size_t>(y);
    std::swap_ranges(a, a + row, out.rgba.data() + row * static_cast<std::size_t>(height - 1 - y));
  }
  for (std::size_t i = 3; i < out.rgba.size(); i += 4) out.rgba[i] = 255;
}

Renderer::Renderer(int width, int height, Quality quality) : Renderer(width, height, effort_of(quality, width, height)) {}
Renderer::Renderer(int width, int height, const Effort& effort) : impl_(std::make_unique<Impl>(width, height, effort)) {}
Renderer::~Renderer() {
  impl_->context.make_current();
}

void Renderer::draw(const DrawList& list, Image& out) {
  Impl& r = *impl_;
  const Targets& targets = r.studio.targets;
  r.context.make_current();
  r.cost = {};
  Stopwatch watch(r.cost);
  std::vector<CasterBox> boxes;
  const std::vector<Piece> pieces = collect(list, r.geometry, r.materials, r.studio.cost.pixel_share, targets.height, boxes);
  const FrameSetup frame = set_up_frame(list, boxes, targets.width, targets.height, r.studio.cost.shadow_map_size);
  r.studio.bind_inputs(frame);
  lap(watch, Pass::set_up);
  r.shadow.draw(r.studio, pieces, frame);
  lap(watch, Pass::shadow);
  const shade::FrameData data = frame_data(frame.block);
  const shade::Maps maps = r.shadow.maps(r.studio.cost, list.road);
  r.background.draw(r.studio, list, frame, r.shadow.bounds(), data, maps);
  if (!list.road.terrain) r.strips.draw(r.studio, list, StripPass::Over::ground);
  lap(watch, Pass::background);
  const bool on_terrain = list.road.terrain && !list.strips.empty();
  const bool depth =
      on_terrain || std::any_of(list.lines.begin(), list.lines.end(), [](const LineItem& l) { return l.hidden_behind; });
  if (depth) {
    glBindFramebuffer(GL_FRAMEBUFFER, *targets.picture);
    glDepthMask(GL_TRUE);
    glClear(GL_DEPTH_BUFFER_BIT);
  }
  const Rectangle whole{0, 0, targets.width, targets.height};
  const Rectangle objects = list.road.terrain ? whole : frame.objects;
  for (int y = objects.y; y < objects.y + objects.height; y += targets.band_height) {
    const Rectangle band{objects.x, y, objects.width, std::min(targets.band_height, objects.y + objects.height - y)};
    draw_objects(r.studio, list, pieces, band);
    lap(watch, Pass::objects);
    r.light.draw(r.studio, {data, maps, r.materials.rows(), list.road.terrain != nullptr}, band, depth);
    lap(watch, Pass::light);
  }
  if (on_terrain) r.strips.draw(r.studio, list, StripPass::Over::things);
  r.overlays.draw(list, targets.width, targets.height);
  lap(watch, Pass::lines);
  r.read(out);
  lap(watch, Pass::read_back);
  draw_labels(list, out);
  lap(watch, Pass::labels);
}

const FrameCost& Renderer::cost() const {
  return impl_->cost;
}

std::string gl_description() {
  return GlContext(16, 16).description();
}

}  // namespace render
