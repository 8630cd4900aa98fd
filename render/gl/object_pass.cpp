#include "render/gl/object_pass.h"

#include "render/gl/shaders.h"

namespace render::gl {
namespace {

void draw_piece(Studio& studio, const Piece& piece) {
  const Geometry& g = *piece.geometry;
  const Program& p = studio.program({kObjectVertex, kObjectFragment, piece.kind, piece.culling == Culling::on ? "SHELL" : ""});
  p.set("model", piece.model);
  p.set("material", static_cast<float>(piece.row));
  p.set("opacity", piece.opacity);
  p.set("closed", static_cast<float>(g.closed));
  p.set("axes", piece.axes);
  draw_run(g, *piece.level, piece.run, piece.culling);
}

}  // namespace

void draw_objects(Studio& studio, const DrawList& list, const std::vector<Piece>& pieces, const Rectangle& r) {
  const int s = studio.targets.samples;
  glBindFramebuffer(GL_FRAMEBUFFER, *studio.targets.seen);
  glViewport(-r.x * s, -r.y * s, studio.targets.width * s, studio.targets.height * s);
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, 0, r.width * s, r.height * s);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  glClear(GL_DEPTH_BUFFER_BIT);  // the rest is looked at only where there is a depth
  // seen from above, the ground hides what has sunk into it; a terrain does so by its own depth
  const bool above = list.view.eye[2] > static_cast<float>(list.road.height) && !list.road.terrain;
  if (above) glEnable(GL_CLIP_DISTANCE0);
  for (const Piece& piece : pieces) draw_piece(studio, piece);
  glDisable(GL_CLIP_DISTANCE0);
  glDisable(GL_SCISSOR_TEST);
}

}  // namespace render::gl
