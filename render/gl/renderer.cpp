// The passes of a frame: shadow map, things in their own rectangle, background where they leave it to be seen, skid marks, the
// light of things, lines, labels. Only marks are drawn by OpenGL. Work is done where it can be seen, and every pass depends on the
// frame's list alone.
#include "render/renderer.h"

#include <algorithm>
#include <vector>

#include "render/gl/background_pass.h"
#include "render/gl/context.h"
#include "render/gl/light_pass.h"
#include "render/gl/object_pass.h"
#include "render/gl/overlay_pass.h"
#include "render/gl/pieces.h"
#include "render/gl/shaders.h"
#include "render/gl/shadow_pass.h"
#include "render/gl/strip_pass.h"
#include "render/gl/studio.h"
#include "render/text/labels.h"

namespace render {
namespace {

using namespace gl;

constexpr int kBandSamples = 8'500'000;  // that the object pass holds: 1080p at four samples in one band, 70 MB

/// Skid marks, by OpenGL.
class Marks {
 public:
  Marks(int width, int height) : context_(16, 16), studio_(width, height) {}
  ~Marks() { context_.make_current(); }
  Marks(const Marks&) = delete;
  Marks& operator=(const Marks&) = delete;

  /// Onto the canvas; `depth` of its pixels hides them where they lie over things, on a terrain.
  void draw(const DrawList& list, const FrameSetup& frame, std::vector<std::uint8_t>& canvas, const std::vector<float>* depth) {
    context_.make_current();
    studio_.bind_inputs(frame);
    studio_.targets.upload(canvas);
    if (depth) put_depth(*depth);
    strips_.draw(studio_, list, depth ? StripPass::Over::things : StripPass::Over::ground);
    studio_.targets.download(canvas);
  }

 private:
  void put_depth(const std::vector<float>& depth) {
    const Targets& t = studio_.targets;
    glBindTexture(GL_TEXTURE_2D, *t.seen_depth);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, t.width, t.height, GL_RED, GL_FLOAT, depth.data());
    glBindFramebuffer(GL_FRAMEBUFFER, *t.picture);
    glViewport(0, 0, t.width, t.height);
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_ALWAYS);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    studio_.program({kTileVertex, kSeenDepthFragment});
    studio_.fill({{0, 0, t.width, t.height}});
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  }

  GlContext context_;
  Studio studio_;
  StripPass strips_;
};

}  // namespace

struct Renderer::Impl {
  Impl(int w, int h, const Effort& e) : width(w), height(h), effort(e) {}

  void read(Image&) const;

  int width, height;  // of the picture handed out
  Effort effort;
  GeometryCache geometry;
  MaterialTable materials;
  ShadowPass shadow;
  BackgroundPass background;
  std::unique_ptr<Marks> marks;  // made when there are any
  ObjectPass objects;
  LightPass light;
  gl::OverlayPass overlays;
  std::vector<std::uint8_t> canvas;   // RGBA, lowest row first, as large as it is drawn
  std::vector<std::uint8_t> covered;  // of its pixels, by things
  std::vector<float> depth;           // of its pixels, where a line may pass behind things
  FrameCost cost{};
};

void Renderer::Impl::read(Image& out) const {
  out.width = width;
  out.height = height;
  const int scale = effort.scale, pitch = width * scale;
  out.rgba.resize(4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int y = 0; y < height; ++y) {
    std::uint8_t* to = out.rgba.data() + 4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height - 1 - y);
    const std::uint8_t* from = canvas.data() + 4 * static_cast<std::size_t>(pitch) * static_cast<std::size_t>(y * scale);
    if (scale == 1) {
      std::copy_n(from, 4 * width, to);
      for (int x = 0; x < width; ++x) to[4 * x + 3] = 255;
      continue;
    }
    for (int x = 0; x < width; ++x, to += 4, from += 8) {
      const std::uint8_t* above = from + 4 * static_cast<std::size_t>(pitch);
      for (int c = 0; c < 3; ++c) to[c] = static_cast<std::uint8_t>((from[c] + from[c + 4] + above[c] + above[c + 4] + 2) / 4);
      to[3] = 255;
    }
  }
}

Renderer::Renderer(int width, int height, Quality quality) : Renderer(width, height, effort_of(quality, width, height)) {}
Renderer::Renderer(int width, int height, const Effort& effort) : impl_(std::make_unique<Impl>(width, height, effort)) {}
Renderer::~Renderer() = default;

void Renderer::draw(const DrawList& list, Image& out) {
  Impl& r = *impl_;
  const Effort& effort = r.effort;
  const int width = r.width * effort.scale, height = r.height * effort.scale;
  r.cost = {};
  Stopwatch watch(r.cost);
  std::vector<CasterBox> boxes;
  const std::vector<Piece> pieces = collect(list, r.geometry, r.materials, effort.pixel_share, height, boxes);
  const FrameSetup frame = set_up_frame(list, boxes, width, height, effort.shadow_map_size);
  r.canvas.resize(4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const shade::Canvas canvas{r.canvas.data(), width};
  watch.lap(Pass::set_up);
  r.shadow.draw(effort, pieces, frame);
  watch.lap(Pass::shadow);
  const shade::FrameData data = frame_data(frame.block);
  const shade::Maps maps = r.shadow.maps(effort, list.road);
  r.background.begin(list, frame, r.shadow.bounds(), maps, canvas, height, effort.ground_step);
  const bool terrain = list.road.terrain != nullptr, on_terrain = terrain && !list.strips.empty();
  const bool under_things = !terrain && !list.strips.empty();  // marks: they want the ground whole
  if (!list.strips.empty() && !r.marks) r.marks = std::make_unique<Marks>(width, height);
  if (under_things) {
    r.background.draw(0, height, nullptr, maps, canvas);
    r.marks->draw(list, frame, r.canvas, nullptr);
  }
  watch.lap(Pass::background);
  const bool depth =
      on_terrain || std::any_of(list.lines.begin(), list.lines.end(), [](const LineItem& l) { return l.hidden_behind; });
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  if (depth) r.depth.assign(pixels, 1.0f);
  r.covered.resize(pixels + 7);
  const Rectangle objects = terrain ? Rectangle{0, 0, width, height} : frame.objects;
  const int band_height = std::clamp(kBandSamples / (width * effort.samples * effort.samples), 16, height);
  int done = 0;  // rows of the background
  for (int y = objects.y; y < objects.y + objects.height; y += band_height) {
    const Rectangle band{objects.x, y, objects.width, std::min(band_height, objects.y + objects.height - y)};
    r.objects.draw(list, pieces, frame, width, height, effort.samples, band);
    if (depth) nearest_depths(r.objects, band, effort.samples, width, r.depth);
    watch.lap(Pass::objects);
    if (!under_things) {
      r.background.draw(done, y, nullptr, maps, canvas);
      done = y + band.height;
      r.objects.cover(band, effort.samples, width, r.covered);
      r.background.draw(y, done, r.covered.data(), maps, canvas);
      watch.lap(Pass::background);
    }
    r.light.draw({data, maps, r.materials.rows(), terrain, effort.samples}, r.objects, band, canvas);
    watch.lap(Pass::light);
  }
  if (!under_things) r.background.draw(done, height, nullptr, maps, canvas);
  watch.lap(Pass::background);
  if (on_terrain) r.marks->draw(list, frame, r.canvas, &r.depth);
  r.overlays.draw(list, canvas, height, depth ? r.depth.data() : nullptr);
  watch.lap(Pass::lines);
  r.read(out);
  watch.lap(Pass::read_back);
  draw_labels(list, out);
  watch.lap(Pass::labels);
}

const FrameCost& Renderer::cost() const {
  return impl_->cost;
}

std::string gl_description() {
  return GlContext(16, 16).description();
}

}  // namespace render
