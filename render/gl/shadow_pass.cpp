#include "render/gl/shadow_pass.h"

#include <algorithm>
#include <cmath>

#include "render/gl/noise.h"
#include "render/gl/shaders.h"
#include "render/matrix.h"

namespace render::gl {
namespace {

void draw_map(Studio& studio, const std::vector<Piece>& pieces, const FrameSetup& frame) {
  const Targets& targets = studio.targets;
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
  const Program& p = studio.program({kDepthVertex, kDepthFragment});
  const double tolerance = static_cast<double>(std::max(frame.block.shadow[0], frame.block.shadow[1]));  // a texel
  for (const Piece& piece : pieces) {
    if (!piece.casts) continue;
    p.set("model_to_clip", to_gl(frame.world_to_shadow_clip * from_gl(piece.model)));
    draw_run(*piece.geometry, level_within(*piece.geometry, tolerance), piece.run,
             piece.geometry->shell ? Culling::on : Culling::off);
  }
  glDisable(GL_POLYGON_OFFSET_FILL);
}

/// Each texel of the grain with its neighbours to the right, above, and both.
std::vector<std::int32_t> fourfold(const std::vector<std::uint8_t>& grain) {
  std::vector<std::int32_t> out;
  const auto at = [&grain](int x, int y) -> std::uint32_t {
    return grain[static_cast<std::size_t>((y % kNoiseSize) * kNoiseSize + x % kNoiseSize)];
  };
  for (int y = 0; y < kNoiseSize; ++y)
    for (int x = 0; x < kNoiseSize; ++x)
      out.push_back(static_cast<std::int32_t>(at(x, y) | at(x + 1, y) << 8 | at(x, y + 1) << 16 | at(x + 1, y + 1) << 24));
  return out;
}

shade::Photograph photograph_of(const RoadLook& road) {
  shade::Photograph out;
  if (!road.picture) return out;
  for (const GroundPicture::Level& level : road.picture->levels) {
    if (out.levels == shade::Photograph::kMostLevels) break;
    out.texels[out.levels] = level.texels.data();
    out.width[out.levels] = level.width;
    out.height[out.levels++] = level.height;
  }
  out.x = static_cast<float>(road.picture_x);
  out.y = static_cast<float>(road.picture_y);
  out.cosine = static_cast<float>(std::cos(road.picture_turn));
  out.sine = static_cast<float>(std::sin(road.picture_turn));
  out.texel = static_cast<float>(road.picture_width / out.width[0]);
  return out;
}

/// [texels] the widest filter, one of its linear weights and one of rounding
int reach(const Studio& studio, float texel) {
  return static_cast<int>(std::ceil(studio.cost.shadow_reach / static_cast<double>(texel))) + 2;
}

}  // namespace

ShadowPass::ShadowPass() : grain_(fourfold(grain_picture())) {}

void ShadowPass::draw(Studio& studio, const std::vector<Piece>& pieces, const FrameSetup& frame) {
  bounds_.clear();
  if (!frame.casts) return;
  draw_map(studio, pieces, frame);
  const int size = studio.targets.shadow_map_size;
  read_depth(size);
  bounds_.build(depth_.data() + size + 3, size, size + 2, reach(studio, frame.block.shadow[0]),
                reach(studio, frame.block.shadow[1]));
  const int side = studio.cost.occlusion_size;
  occlusion_.resize(static_cast<std::size_t>(side + 2) * static_cast<std::size_t>(side + 2));
  const FrameBlock& b = frame.block;
  shade::kernels().occlusion(frame_data(b),
                             {b.counts[0], b.counts[1], b.round_rows[0].data(), b.box_rows[0].data(), b.box_half[0].data()}, side,
                             occlusion_.data());
}

void ShadowPass::read_depth(int size) {
  const std::size_t pitch = static_cast<std::size_t>(size) + 2;
  if (depth_.size() != pitch * pitch) depth_.assign(pitch * pitch, 1.0f);
  glPixelStorei(GL_PACK_ROW_LENGTH, size + 2);
  glReadPixels(0, 0, size, size, GL_DEPTH_COMPONENT, GL_FLOAT, depth_.data() + pitch + 1);
  glPixelStorei(GL_PACK_ROW_LENGTH, 0);
}

shade::Maps ShadowPass::maps(const Effort& cost, const RoadLook& road) const {
  return {grain_.data(),      depth_.data(),      cost.shadow_map_size, &bounds_.blocks()[0].least,
          bounds_.side(),     occlusion_.data(),  cost.occlusion_size,  static_cast<float>(cost.shadow_reach),
          cost.shadow_filter, photograph_of(road)};
}

}  // namespace render::gl
