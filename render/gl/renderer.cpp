// The passes of a frame: shadow map, background, ground in shade, skid marks, objects in their own rectangle, composition, lines,
// read-back, labels.
//
// Work is done where it can be seen: the background is computed without things and kept while camera and road stay the same; the
// dear ground shader runs only inside the rectangle where shadows and occlusion can fall, the multisampled target is used only
// inside the rectangle of the objects. A kept background and a fresh one come out of the same shader over the same pixels, so a
// frame's bytes do not depend on what was drawn before it.
#include "render/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <compare>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

#include "render/gl/context.h"
#include "render/gl/noise.h"
#include "render/gl/overlay_pass.h"
#include "render/gl/pieces.h"
#include "render/gl/program.h"
#include "render/gl/shaders.h"
#include "render/gl/targets.h"
#include "render/matrix.h"
#include "render/text/labels.h"

namespace render {
namespace {

using namespace gl;

struct Spend {  // what a quality level costs
  int scale;    // pictures are drawn so many times larger a side
  int samples;  // a side to a pixel
  int shadow_map_size;
  int shadow_filter;   // SHADOW in the shaders
  double pixel_share;  // [pixels] of tessellation
};

constexpr int kWidestFine = 4096;  // [pixels] four times that is the largest texture

Spend spend(Quality q, int width, int height) {
  if (q == Quality::draft) return {1, 1, 512, 1, 0.5};
  if (q == Quality::standard) return {1, 2, 1024, 1, 0.2};
  return {std::max(width, height) > kWidestFine ? 1 : 2, 2, 2048, 2, 0.2};
}

/// Shader text with its switches.
struct Variant {
  const char* vertex;
  const char* fragment;
  int kind = 0, shadow = 0;
  std::string options{};  // switches that are on
  auto operator<=>(const Variant&) const = default;
};

}  // namespace

struct Renderer::Impl {
  Impl(int w, int h, Quality q)
      : width(w),
        height(h),
        cost(spend(q, w, h)),
        context(16, 16),
        targets(w * cost.scale, h * cost.scale, w, h, cost.samples, cost.shadow_map_size) {
    const std::vector<std::uint8_t> grain = grain_picture();
    glBindTexture(GL_TEXTURE_2D, *noise);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, kNoiseSize, kNoiseSize, 0, GL_RED, GL_UNSIGNED_BYTE, grain.data());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glBindBuffer(GL_UNIFORM_BUFFER, *block);
    glBufferData(GL_UNIFORM_BUFFER, sizeof(FrameBlock), nullptr, GL_DYNAMIC_DRAW);
  }

  const Program& program(const Variant&);
  void mark(const char* pass);
  void bind_inputs(const FrameSetup&);
  void draw_shadow_map(const std::vector<Piece>&, const FrameSetup&);
  void draw_occlusion();
  void fill(const Rectangle&, const Program&);
  void draw_bare(const FrameSetup&, const Rectangle& hole);
  void draw_shade(const FrameSetup&, const Rectangle&);
  void draw_background(const FrameSetup&);
  void draw_strips(const DrawList&);
  void draw_piece(const Piece&);
  void draw_objects(const DrawList&, const std::vector<Piece>&, const Rectangle&);
  void light_objects(const DrawList&, const Rectangle&, bool depth);
  void read(Image&);

  int width, height;
  Spend cost;
  GlContext context;
  Targets targets;
  GeometryCache geometry;
  MaterialTable materials;
  gl::OverlayPass overlays;
  Texture noise;
  Buffer block, scratch;
  VertexArray nothing, scratch_array;
  std::map<Variant, std::unique_ptr<Program>> programs;
  std::optional<FrameBlock> kept, last;               // whose background lies in targets.bare, and whose was drawn last
  std::vector<std::pair<const char*, double>> spent;  // [ms]
  std::chrono::steady_clock::time_point since;
};

const Program& Renderer::Impl::program(const Variant& v) {
  std::unique_ptr<Program>& p = programs[v];
  if (!p) {
    const std::string defines =
        fmt::format("#define KIND {}\n#define SHADOW {}\n#define SAMPLES {}\n", v.kind, v.shadow, cost.samples);
    std::string switches;
    for (const std::string name : {"SHELL", "CASTERS", "NEAR", "DEPTH"})
      switches += fmt::format("#define {} {}\n", name, v.options.find(name) != std::string::npos ? 1 : 0);
    switches += fmt::format("#define TERRAIN {}\n", v.kind == kTerrainKind ? 1 : 0);
    const bool ground = v.fragment == kGroundFragment || v.fragment == kStripFragment || v.kind == kTerrainKind;
    p = std::make_unique<Program>(defines + switches, std::string(kFrameBlock) + v.vertex,
                                  std::string(kFrameBlock) + kCommon + (ground ? kGroundPattern : "") + v.fragment);
  }
  p->use();
  return *p;
}

void Renderer::Impl::mark(const char* pass) {
  glFinish();
  const auto now = std::chrono::steady_clock::now();
  spent.emplace_back(pass, std::chrono::duration<double, std::milli>(now - since).count());
  since = now;
}

void Renderer::Impl::bind_inputs(const FrameSetup& frame) {
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, *block);
  glBufferSubData(GL_UNIFORM_BUFFER, 0, sizeof(FrameBlock), &frame.block);
  // in the order of kSamplers
  const GLuint shadow = *targets.shadow_depth;
  const GLuint textures[] = {
      *noise, shadow, shadow, shadow, *targets.occlusion_colour, *targets.seen_colour, *targets.seen_depth, materials.texture()};
  const GLuint samplers[] = {0, *targets.compare, *targets.probe, *targets.plain, 0, 0, 0, 0};
  static_assert(std::size(textures) == std::size(kSamplers) && std::size(samplers) == std::size(kSamplers));
  for (GLuint unit = 0; unit < std::size(textures); ++unit) {
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(GL_TEXTURE_2D, textures[unit]);
    glBindSampler(unit, samplers[unit]);
  }
}

void Renderer::Impl::draw_shadow_map(const std::vector<Piece>& pieces, const FrameSetup& frame) {
  glBindFramebuffer(GL_FRAMEBUFFER, *targets.shadow);
  glViewport(0, 0, targets.shadow_map_size, targets.shadow_map_size);
  glDisable(GL_SCISSOR_TEST);
  glDepthMask(GL_TRUE);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
  glClear(GL_DEPTH_BUFFER_BIT);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1.5f, 4.0f);
  const Program& p = program({kDepthVertex, kDepthFragment});
  for (const Piece& piece : pieces) {
    if (!piece.casts) continue;
    p.set("model_to_clip", to_gl(frame.world_to_shadow_clip * from_gl(piece.model)));
    if (piece.geometry->shell) {
      glEnable(GL_CULL_FACE);
      glCullFace(piece.geometry->closed > 0 ? GL_BACK : GL_FRONT);
    }
    glBindVertexArray(*piece.geometry->array);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(piece.count), GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(piece.first * sizeof(std::uint32_t)));
    glDisable(GL_CULL_FACE);
  }
  glDisable(GL_POLYGON_OFFSET_FILL);
}

void Renderer::Impl::draw_occlusion() {
  glBindFramebuffer(GL_FRAMEBUFFER, *targets.occlusion);
  glViewport(0, 0, kOcclusionSize, kOcclusionSize);
  glDisable(GL_DEPTH_TEST);
  program({kCopyVertex, kOcclusionFragment});
  glBindVertexArray(*nothing);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void Renderer::Impl::fill(const Rectangle& r, const Program& p) {
  if (r.width <= 0 || r.height <= 0) return;
  p.use();
  glScissor(r.x, r.y, r.width, r.height);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

/// Sky and ground without things, but for a hole, into the bound framebuffer.
void Renderer::Impl::draw_bare(const FrameSetup& frame, const Rectangle& hole) {
  const int right = hole.x + hole.width, top = hole.y + hole.height, w = targets.width, h = targets.height;
  const auto rows = [&](int from, int to, const Program& p) {
    // below, above, left and right of the hole
    const int low = std::clamp(hole.y, from, to), high = std::clamp(top, from, to);
    fill({0, from, w, low - from}, p);
    fill({0, high, w, to - high}, p);
    fill({0, low, hole.x, high - low}, p);
    fill({right, low, w - right, high - low}, p);
  };
  rows(0, frame.near_to, program({kScreenVertex, kGroundFragment, 0, 0, "NEAR"}));
  rows(frame.near_to, frame.sky_from, program({kScreenVertex, kGroundFragment}));
  rows(frame.sky_from, h, program({kScreenVertex, kSkyFragment}));
}

/// Ground where shadows and occlusion may fall.
void Renderer::Impl::draw_shade(const FrameSetup& frame, const Rectangle& r) {
  const auto rows = [&](int from, int to, const Program& p) {
    const int low = std::max(r.y, from), high = std::min(r.y + r.height, to);
    fill({r.x, low, r.width, high - low}, p);
  };
  rows(0, frame.near_to, program({kScreenVertex, kGroundFragment, 0, cost.shadow_filter, "NEAR CASTERS"}));
  rows(frame.near_to, frame.sky_from, program({kScreenVertex, kGroundFragment, 0, cost.shadow_filter, "CASTERS"}));
}

void Renderer::Impl::draw_background(const FrameSetup& frame) {
  glViewport(0, 0, targets.width, targets.height);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  glEnable(GL_SCISSOR_TEST);
  glBindVertexArray(*nothing);
  Rectangle shade = frame.shade;
  shade.height = std::max(0, std::min(shade.height, frame.sky_from - shade.y));
  // kept from the second equal frame on: a moving camera pays for no copy
  if (last && same_background(*last, frame.block) && !(kept && same_background(*kept, frame.block))) {
    glBindFramebuffer(GL_FRAMEBUFFER, *targets.bare);
    draw_bare(frame, {});
    kept = frame.block;
  }
  last = frame.block;
  glBindFramebuffer(GL_FRAMEBUFFER, *targets.picture);
  if (kept && same_background(*kept, frame.block)) {
    glDisable(GL_SCISSOR_TEST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, *targets.bare);
    glBlitFramebuffer(0, 0, targets.width, targets.height, 0, 0, targets.width, targets.height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glEnable(GL_SCISSOR_TEST);
  } else {
    draw_bare(frame, shade);
  }
  draw_shade(frame, shade);
  glDisable(GL_SCISSOR_TEST);
}

void Renderer::Impl::draw_strips(const DrawList& list) {
  std::vector<float> data;
  for (const StripItem& strip : list.strips) {
    const std::size_t n = std::min(strip.left.size(), strip.right.size());
    const auto put = [&](std::size_t i, bool left) {
      const Float3& p = left ? strip.left[i] : strip.right[i];
      data.insert(data.end(), {p[0], p[1], p[2], left ? -1.0f : 1.0f, i < strip.darkness.size() ? strip.darkness[i] : 0.7f, 0.0f});
    };
    for (std::size_t i = 0; i + 1 < n; ++i) {
      put(i, true), put(i, false), put(i + 1, false);
      put(i, true), put(i + 1, false), put(i + 1, true);
    }
  }
  if (data.empty()) return;
  program({kStripVertex, kStripFragment});
  glBindVertexArray(*scratch_array);
  glBindBuffer(GL_ARRAY_BUFFER, *scratch);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(data.size() * sizeof(float)), data.data(), GL_STREAM_DRAW);
  for (GLuint i = 0; i < 2; ++i) {
    glEnableVertexAttribArray(i);
    glVertexAttribPointer(i, 3, GL_FLOAT, GL_FALSE, 6 * sizeof(float),
                          reinterpret_cast<const void*>(std::size_t{i} * 3 * sizeof(float)));
  }
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(data.size() / 6));
  glDisable(GL_BLEND);
}

void Renderer::Impl::draw_piece(const Piece& piece) {
  const Geometry& g = *piece.geometry;
  const Program& p = program({kObjectVertex, kObjectFragment, piece.kind, 0, g.shell && piece.kind != kWireKind ? "SHELL" : ""});
  p.set("model", piece.model);
  p.set("material", static_cast<float>(piece.row));
  p.set("opacity", piece.opacity);
  p.set("closed", static_cast<float>(g.closed));
  p.set("axes", piece.axes);
  if (g.shell) {
    glEnable(GL_CULL_FACE);
    glCullFace(g.closed > 0 ? GL_BACK : GL_FRONT);
  }
  glBindVertexArray(*g.array);
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(piece.count), GL_UNSIGNED_INT,
                 reinterpret_cast<const void*>(piece.first * sizeof(std::uint32_t)));
  glDisable(GL_CULL_FACE);
}

/// What each sample in the band r of the picture sees.
void Renderer::Impl::draw_objects(const DrawList& list, const std::vector<Piece>& pieces, const Rectangle& r) {
  const int s = targets.samples;
  glBindFramebuffer(GL_FRAMEBUFFER, *targets.seen);
  glViewport(-r.x * s, -r.y * s, targets.width * s, targets.height * s);
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, 0, r.width * s, r.height * s);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  // seen from above, the ground hides what has sunk into it; a terrain does so by its own depth
  const bool above = list.view.eye[2] > static_cast<float>(list.road.height) && !list.road.terrain;
  if (above) glEnable(GL_CLIP_DISTANCE0);
  for (const Piece& piece : pieces) draw_piece(piece);
  glDisable(GL_CLIP_DISTANCE0);
  glDisable(GL_SCISSOR_TEST);
}

/// Their light, onto the picture; with their depth if a line may pass behind them.
void Renderer::Impl::light_objects(const DrawList& list, const Rectangle& r, bool depth) {
  glBindFramebuffer(GL_FRAMEBUFFER, *targets.picture);
  glViewport(0, 0, targets.width, targets.height);
  glEnable(GL_SCISSOR_TEST);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  if (depth) {
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_ALWAYS);
    glDepthMask(GL_TRUE);
  } else {
    glDisable(GL_DEPTH_TEST);
  }
  const Program& p =
      program({kScreenVertex, kShadeFragment, list.road.terrain ? kTerrainKind : 0, cost.shadow_filter, depth ? "DEPTH" : ""});
  p.set("origin", static_cast<float>(r.x), static_cast<float>(r.y));
  glBindVertexArray(*nothing);
  fill(r, p);
  glDepthFunc(GL_LEQUAL);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  glDisable(GL_SCISSOR_TEST);
}

void Renderer::Impl::read(Image& out) {
  out.width = width;
  out.height = height;
  const std::size_t row = 4 * static_cast<std::size_t>(width);
  out.rgba.resize(row * static_cast<std::size_t>(height));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, *targets.picture);
  if (cost.scale > 1) {
    // half the size with linear filter: the mean of two by two
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, *targets.out);
    glBlitFramebuffer(0, 0, targets.width, targets.height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_LINEAR);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, *targets.out);
  }
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, out.rgba.data());
  for (int y = 0; y < height / 2; ++y) {
    std::uint8_t* a = out.rgba.data() + row * static_cast<std::size_t>(y);
    std::swap_ranges(a, a + row, out.rgba.data() + row * static_cast<std::size_t>(height - 1 - y));
  }
  for (std::size_t i = 3; i < out.rgba.size(); i += 4) out.rgba[i] = 255;
}

Renderer::Renderer(int width, int height, Quality quality) : impl_(std::make_unique<Impl>(width, height, quality)) {}
Renderer::~Renderer() {
  impl_->context.make_current();
}

void Renderer::draw(const DrawList& list, Image& out) {
  Impl& r = *impl_;
  r.context.make_current();
  r.spent.clear();
  r.since = std::chrono::steady_clock::now();
  std::vector<CasterBox> boxes;
  const std::vector<Piece> pieces = collect(list, r.geometry, r.materials, r.cost.pixel_share, r.targets.height, boxes);
  r.materials.upload();
  const FrameSetup frame = set_up_frame(list, boxes, r.targets.width, r.targets.height, r.cost.shadow_map_size);
  r.bind_inputs(frame);
  r.mark("set-up");
  r.draw_shadow_map(pieces, frame);
  if (frame.casts) r.draw_occlusion();
  r.mark("shadow");
  r.draw_background(frame);
  r.draw_strips(list);
  r.mark("background");
  const bool depth = std::any_of(list.lines.begin(), list.lines.end(), [](const LineItem& l) { return l.hidden_behind; });
  if (depth) {
    glDepthMask(GL_TRUE);
    glClear(GL_DEPTH_BUFFER_BIT);
  }
  const Rectangle whole{0, 0, r.targets.width, r.targets.height};
  const Rectangle objects = list.road.terrain ? whole : frame.objects;
  for (int y = objects.y; y < objects.y + objects.height; y += r.targets.band_height) {
    const Rectangle band{objects.x, y, objects.width, std::min(r.targets.band_height, objects.y + objects.height - y)};
    r.draw_objects(list, pieces, band);
    r.mark("objects");
    r.light_objects(list, band, depth);
    r.mark("light");
  }
  r.overlays.draw(list, r.targets.width, r.targets.height);
  r.mark("lines");
  r.read(out);
  r.mark("read-back");
  draw_labels(list, out);
  r.mark("labels");
}

std::string Renderer::timings() const {
  std::string out;
  double sum = 0;
  for (const auto& [pass, ms] : impl_->spent) {
    out += fmt::format("{} {:.1f} ms, ", pass, ms);
    sum += ms;
  }
  return out + fmt::format("together {:.1f} ms", sum);
}

std::string gl_description() {
  return GlContext(16, 16).description();
}

}  // namespace render
