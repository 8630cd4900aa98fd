#include "render/gl/shadow_pass.h"

#include <algorithm>
#include <cmath>

#include "render/gl/noise.h"
#include "render/gl/shaders.h"

namespace render::gl {
namespace {

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
int reach(const Effort& cost, float texel) {
  return static_cast<int>(std::ceil(cost.shadow_reach / static_cast<double>(texel))) + 2;
}

}  // namespace

ShadowPass::ShadowPass() : program_("", glsl::shadow_vert, glsl::shadow_frag), grain_(fourfold(grain_picture())) {}

void ShadowPass::draw(const Effort& cost, const std::vector<Piece>& pieces, const FrameSetup& frame) {
  bounds_.clear();
  if (!frame.casts) return;
  const int size = cost.shadow_map_size;
  draw_map(size, pieces, frame);
  const shade::FrameData& f = frame.data;
  const OccluderRows& o = frame.occluders;
  bounds_.build(depth_.data() + size + 3, size, size + 2, reach(cost, f.shadow[0]), reach(cost, f.shadow[1]));
  const int side = cost.occlusion_size;
  occlusion_.resize(static_cast<std::size_t>(side + 2) * static_cast<std::size_t>(side + 2));
  shade::kernels().occlusion(
      f, {static_cast<int>(o.rounds), static_cast<int>(o.boxes), o.round_rows.data(), o.box_rows.data(), o.box_half.data()}, side,
      occlusion_.data());
}

void ShadowPass::draw_map(int size, const std::vector<Piece>& pieces, const FrameSetup& frame) {
  const Rectangle whole{0, 0, size, size};
  depth_.resize(static_cast<std::size_t>(size + 2) * static_cast<std::size_t>(size + 2), 1.0f);
  const double texel = static_cast<double>(std::max(frame.data.shadow[0], frame.data.shadow[1]));
  target_.begin(whole, size, size);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1.5f, 4.0f);
  program_.use();
  program_.set("per_viewport", target_.per_viewport());
  triangles_.draw_casters({frame.world_to_shadow_clip, size, size, whole}, pieces, texel);
  glDisable(GL_POLYGON_OFFSET_FILL);
  glDisable(GL_DEPTH_TEST);
  target_.read(whole, depth_.data() + size + 3, size + 2);
}

shade::Maps ShadowPass::maps(const Effort& cost, const RoadLook& road) const {
  return {grain_.data(),      depth_.data(),      cost.shadow_map_size, &bounds_.blocks()[0].least,
          bounds_.side(),     occlusion_.data(),  cost.occlusion_size,  static_cast<float>(cost.shadow_reach),
          cost.shadow_filter, photograph_of(road)};
}

}  // namespace render::gl
