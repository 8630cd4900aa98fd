#include "render/gl/object_pass.h"

#include <algorithm>

#include "render/gl/shaders.h"

namespace render::gl {
namespace {

/// Starting at an even sample: glass keeps the same two by two wherever the band begins.
Rectangle samples_of(const Rectangle& r, int samples) {
  const int x = r.x * samples & ~1, y = r.y * samples & ~1;
  return {x, y, (r.x + r.width) * samples - x, (r.y + r.height) * samples - y};
}

}  // namespace

ObjectPass::ObjectPass()
    : plain_("", glsl::object_vert, glsl::object_frag),
      glass_("#define GLASS\n", glsl::object_vert, glsl::object_frag),
      wires_("#define WIRES\n", glsl::object_vert, glsl::object_frag) {}

void ObjectPass::draw(const DrawList& list, const std::vector<Piece>& pieces, const FrameSetup& frame, int width, int height,
                      int samples, const Rectangle& r) {
  if (r.width == 0 || r.height == 0) return;
  drawn_ = samples_of(r, samples);
  // seen from above, the ground hides what has sunk into it; a terrain does so by its own depth
  const float ground = static_cast<float>(list.road.height);
  const bool above = list.view.eye[2] > ground && !list.road.terrain;
  target_.begin(drawn_, width * samples, height * samples);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  if (above) glEnable(GL_CLIP_DISTANCE0);
  triangles_.draw({frame.world_to_clip, width * samples, height * samples, drawn_, ground, above}, pieces,
                  [this](const Triangles::Batch& batch) {
                    const Program& p = batch.wires ? wires_ : batch.kept != 15 ? glass_ : plain_;
                    p.use();
                    p.set("per_viewport", target_.per_viewport());
                    if (batch.wires) p.set("axes", batch.axes);
                    if (batch.kept != 15) p.set("kept", static_cast<int>(batch.kept));
                  });
  glDisable(GL_CLIP_DISTANCE0);
  glDisable(GL_DEPTH_TEST);
}

void ObjectPass::read(const Rectangle& r, int samples) {
  names_.resize(static_cast<std::size_t>(r.width * samples) * static_cast<std::size_t>(r.height * samples));
  target_.read({r.x * samples, r.y * samples, r.width * samples, r.height * samples}, names_.data());
}

void ObjectPass::bind_depth(const Program& program, int samples, int x, int y) const {
  program.use();
  program.set("band", drawn_.x - x * samples, drawn_.y - y * samples, samples);
  glActiveTexture(GL_TEXTURE1);
  glBindTexture(GL_TEXTURE_2D, *target_.depth());
}

}  // namespace render::gl
