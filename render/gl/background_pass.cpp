// The background is computed without things and kept while camera and road stay the same; the dear ground shader runs only inside
// the rectangle where shadows and occlusion can fall. A kept background and a fresh one come out of the same shader over the same
// pixels, so a frame's bytes do not depend on what was drawn before it.
#include "render/gl/background_pass.h"

#include <algorithm>
#include <vector>

#include "render/gl/ground_tiles.h"
#include "render/gl/shaders.h"

namespace render::gl {
namespace {

const char* switches_of(Zone zone) {
  switch (zone) {
    case Zone::roadway:
      return " ROADWAY";
    case Zone::asphalt:
      return " ROADWAY PLAIN";
    case Zone::pavement:
      return " PAVED";
    case Zone::grass:
      return " GRASS";
    default:
      return "";
  }
}

void draw_tiles(Studio& studio, const TileMap& tiles, const std::string& ground) {
  for (const auto& [look, rectangles] : tiles) {
    Variant v{kTileVertex, kSkyFragment};
    if (look.zone != Zone::sky) {
      v.fragment = kGroundFragment;
      v.options = ground + switches_of(look.zone) + (look.near ? " NEAR" : "") + (look.sun != Sun::bare ? " CASTERS" : "");
      v.shadow = look.sun == Sun::open ? studio.cost.shadow_filter : 0;
    }
    studio.program(v).set("sure_light", look.sun == Sun::dark ? 0.0f : 1.0f);
    studio.fill(rectangles);
  }
}

}  // namespace

void BackgroundPass::draw(Studio& studio, const DrawList& list, const FrameSetup& frame, const DepthPyramid& depth) {
  const Targets& targets = studio.targets;
  const std::string ground = ground_switches(list.road);
  glViewport(0, 0, targets.width, targets.height);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  // kept from the second equal frame on: a moving camera pays for no copy
  if (last_ && same_background(*last_, frame.block) && !(kept_ && same_background(*kept_, frame.block))) {
    glBindFramebuffer(GL_FRAMEBUFFER, *targets.bare);
    draw_tiles(studio, lay_tiles(frame, list.road, depth, Shade::none, targets.width, targets.height), ground);
    kept_ = frame.block;
  }
  last_ = frame.block;
  TileMap tiles = lay_tiles(frame, list.road, depth, Shade::cast, targets.width, targets.height);
  if (kept_ && same_background(*kept_, frame.block)) {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, *targets.bare);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, *targets.picture);
    glBlitFramebuffer(0, 0, targets.width, targets.height, 0, 0, targets.width, targets.height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    std::erase_if(tiles, [](const auto& t) { return t.first.sun == Sun::bare; });
  }
  glBindFramebuffer(GL_FRAMEBUFFER, *targets.picture);
  draw_tiles(studio, tiles, ground);
  draw_strips(studio, list);
}

void BackgroundPass::draw_strips(Studio& studio, const DrawList& list) {
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
  studio.program({kStripVertex, kStripFragment});
  glBindVertexArray(*strip_array_);
  glBindBuffer(GL_ARRAY_BUFFER, *strip_vertices_);
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

}  // namespace render::gl
