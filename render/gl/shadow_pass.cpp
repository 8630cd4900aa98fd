#include "render/gl/shadow_pass.h"

#include <algorithm>
#include <cmath>

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

void draw_occlusion(Studio& studio) {
  glBindFramebuffer(GL_FRAMEBUFFER, *studio.targets.occlusion);
  glViewport(0, 0, studio.targets.occlusion_size, studio.targets.occlusion_size);
  glDisable(GL_DEPTH_TEST);
  studio.program({kCopyVertex, kOcclusionFragment});
  glBindVertexArray(*studio.nothing);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

/// [texels] the widest filter, one of its linear weights and one of rounding
int reach(const Studio& studio, float texel) {
  return static_cast<int>(std::ceil(studio.cost.shadow_reach / static_cast<double>(texel))) + 2;
}

}  // namespace

void ShadowPass::draw(Studio& studio, const std::vector<Piece>& pieces, const FrameSetup& frame) {
  draw_map(studio, pieces, frame);
  if (frame.casts)
    bounds_.build(read_depth(studio.targets.shadow_map_size), studio.targets.shadow_map_size, reach(studio, frame.block.shadow[0]),
                  reach(studio, frame.block.shadow[1]));
  else
    bounds_.clear();
  glActiveTexture(GL_TEXTURE0 + kBoundsUnit);
  glBindTexture(GL_TEXTURE_2D, *studio.targets.shadow_bounds);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RG32F, bounds_.side(), bounds_.side(), 0, GL_RG, GL_FLOAT, bounds_.blocks().data());
  if (frame.casts) draw_occlusion(studio);
}

const std::vector<float>& ShadowPass::read_depth(int size) {
  depth_.resize(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
  glReadPixels(0, 0, size, size, GL_DEPTH_COMPONENT, GL_FLOAT, depth_.data());
  return depth_;
}

}  // namespace render::gl
