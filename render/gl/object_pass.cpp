#include "render/gl/object_pass.h"

#include <algorithm>

#include "render/gl/shaders.h"
#include "render/gl/target.h"

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

/// Not smaller than asked, and not much larger: what is cleared and never seen costs time.
void ObjectPass::fit(int width, int height) {
  if (width <= width_ && height <= height_ && 4 * width > 3 * width_ && 4 * height > 3 * height_) return;
  width_ = (width + 127) / 128 * 128;
  height_ = (height + 127) / 128 * 128;
  glBindFramebuffer(GL_FRAMEBUFFER, *frame_);
  attach(name_, GL_COLOR_ATTACHMENT0, {GL_R32I, GL_RED_INTEGER, GL_INT}, width_, height_);
  attach(depth_, GL_DEPTH_ATTACHMENT, {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT}, width_, height_);
  check_target("visibility buffer", width_, height_);
}

void ObjectPass::draw(const DrawList& list, const std::vector<Piece>& pieces, const FrameSetup& frame, int width, int height,
                      int samples, const Rectangle& r) {
  const std::size_t count = static_cast<std::size_t>(r.width * samples) * static_cast<std::size_t>(r.height * samples);
  if (names_.size() < count) names_.resize(count);
  if (count == 0) return;
  drawn_ = samples_of(r, samples);
  fit(drawn_.width, drawn_.height);
  // seen from above, the ground hides what has sunk into it; a terrain does so by its own depth
  const float ground = static_cast<float>(list.road.height);
  const bool above = list.view.eye[2] > ground && !list.road.terrain;
  triangles_.collect({frame.world_to_clip, width * samples, height * samples, drawn_, ground, above}, pieces);
  triangles_.upload();
  const int side = viewport_side(width * samples, height * samples);
  glBindFramebuffer(GL_FRAMEBUFFER, *frame_);
  glViewport(-drawn_.x, -drawn_.y, side, side);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  const GLint nothing[4] = {};
  const float farthest = 1;
  glClearBufferiv(GL_COLOR, 0, nothing);
  glClearBufferfv(GL_DEPTH, 0, &farthest);
  if (above) glEnable(GL_CLIP_DISTANCE0);
  for (const Triangles::Batch& batch : triangles_.batches()) {
    const Program& p = batch.wires ? wires_ : batch.kept != 15 ? glass_ : plain_;
    p.use();
    p.set("per_viewport", 2 / static_cast<float>(side));
    p.set("first", static_cast<int>(batch.first) + 1);
    if (batch.wires) p.set("axes", batch.axes);
    if (batch.kept != 15) p.set("kept", static_cast<int>(batch.kept));
    triangles_.draw(batch);
  }
  glDisable(GL_CLIP_DISTANCE0);
  glDisable(GL_DEPTH_TEST);
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glReadPixels(r.x * samples - drawn_.x, r.y * samples - drawn_.y, r.width * samples, r.height * samples, GL_RED_INTEGER, GL_INT,
               names_.data());
}

void ObjectPass::bind_depth(const Program& program, int samples) const {
  program.use();
  program.set("band", drawn_.x, drawn_.y, samples);
  glActiveTexture(GL_TEXTURE1);
  glBindTexture(GL_TEXTURE_2D, *depth_);
}

}  // namespace render::gl
