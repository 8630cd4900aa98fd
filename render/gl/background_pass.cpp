// The background is computed without things and kept while camera and road stay the same; where shadows and occlusion can fall it
// is computed anew. A kept background and a fresh one come out of the same kernel, pixel by pixel, so a frame's bytes do not depend
// on what was drawn before it.
#include "render/gl/background_pass.h"

#include <algorithm>
#include <vector>

#include "render/gl/ground_tiles.h"
#include "render/gl/shaders.h"

namespace render::gl {
namespace {

void draw_tiles(const TileMap& tiles, const shade::FrameData& data, const shade::Maps& maps, const shade::Canvas& canvas) {
  for (const auto& [look, rectangles] : tiles)
    for (const Rectangle& r : rectangles)
      shade::kernels().background(
          data, maps, {r.x, r.y, r.width, r.height, static_cast<int>(look.zone), static_cast<int>(look.sun), look.near}, canvas);
}

}  // namespace

void BackgroundPass::draw(Studio& studio, const DrawList& list, const FrameSetup& frame, const DepthPyramid& depth,
                          const shade::FrameData& data, const shade::Maps& maps) {
  const Targets& targets = studio.targets;
  const std::size_t bytes = 4 * static_cast<std::size_t>(targets.width) * static_cast<std::size_t>(targets.height);
  canvas_.resize(bytes);
  const shade::Canvas canvas{canvas_.data(), targets.width};
  if (picture_ != list.road.picture) {
    picture_ = list.road.picture;
    kept_ = last_ = std::nullopt;
  }
  // kept from the second equal frame on: a moving camera pays for no copy
  if (last_ && same_background(*last_, frame.block) && !(kept_ && same_background(*kept_, frame.block))) {
    bare_.resize(bytes);
    draw_tiles(lay_tiles(frame, list.road, depth, Shade::none, targets.width, targets.height), data, maps,
               {bare_.data(), targets.width});
    kept_ = frame.block;
  }
  last_ = frame.block;
  TileMap tiles = lay_tiles(frame, list.road, depth, Shade::cast, targets.width, targets.height);
  if (kept_ && same_background(*kept_, frame.block)) {
    std::copy(bare_.begin(), bare_.end(), canvas_.begin());
    std::erase_if(tiles, [](const auto& t) { return t.first.sun == Sun::bare; });
  }
  draw_tiles(tiles, data, maps, canvas);
  glBindTexture(GL_TEXTURE_2D, *targets.picture_colour);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, targets.width, targets.height, GL_RGBA, GL_UNSIGNED_BYTE, canvas_.data());
  glBindFramebuffer(GL_FRAMEBUFFER, *targets.picture);
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
  glViewport(0, 0, studio.targets.width, studio.targets.height);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_DEPTH_TEST);
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
