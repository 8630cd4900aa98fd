#include "render/gl/object_pass.h"

#include "render/gl/shaders.h"

namespace render::gl {
namespace {

void draw_piece(Studio& studio, const Piece& piece) {
  const Geometry& g = *piece.geometry;
  const Program& p = studio.program({kObjectVertex, kObjectFragment, piece.kind, 0, piece.culling == Culling::on ? "SHELL" : ""});
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
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  // seen from above, the ground hides what has sunk into it; a terrain does so by its own depth
  const bool above = list.view.eye[2] > static_cast<float>(list.road.height) && !list.road.terrain;
  if (above) glEnable(GL_CLIP_DISTANCE0);
  for (const Piece& piece : pieces) draw_piece(studio, piece);
  glDisable(GL_CLIP_DISTANCE0);
  glDisable(GL_SCISSOR_TEST);
}

void light_objects(Studio& studio, const DrawList& list, const Rectangle& r, bool depth) {
  const auto pass = [&](const char* fragment, int kind, int shadow, const std::string& switches, float at) {
    const Program& p = studio.program({kTileVertex, fragment, kind, shadow, switches});
    p.set("origin", static_cast<float>(r.x), static_cast<float>(r.y));
    p.set("depth", at);
    studio.fill({r});
  };
  glViewport(0, 0, studio.targets.width, studio.targets.height);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_ALWAYS);
  if (depth) {
    glBindFramebuffer(GL_FRAMEBUFFER, *studio.targets.picture);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    pass(kSeenDepthFragment, 0, 0, "", 0);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  }
  // first count the surfaces of each pixel and dim what lies behind them; then light each where there is one: what fails the depth
  // test is not shaded at all, in blocks of four by four pixels
  glBindFramebuffer(GL_FRAMEBUFFER, *studio.targets.surfaces);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ZERO, GL_ONE_MINUS_SRC_ALPHA);
  pass(kCountFragment, 0, 0, "", 0);
  glBlendFunc(GL_ONE, GL_ONE);
  glDepthMask(GL_FALSE);
  glDepthFunc(GL_LESS);
  const int kind = list.road.terrain ? kTerrainKind : 0;
  const std::string ground = list.road.terrain ? ground_switches(list.road) : "";
  pass(kShadeFragment, kind, studio.cost.shadow_filter, ground, 0.25f);
  if (studio.cost.samples > 1) pass(kShadeFragment, kind, studio.cost.shadow_filter, ground + " SECOND", 0.75f);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LEQUAL);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  glBindFramebuffer(GL_FRAMEBUFFER, *studio.targets.picture);
}

}  // namespace render::gl
