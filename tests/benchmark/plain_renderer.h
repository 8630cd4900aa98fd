// The yardstick: a forward renderer as one would write it first. Sky and ground in every pixel, everything at four samples, one
// shadow map with 3 x 3 looks, nothing kept from frame to frame, nothing left out; one process, llvmpipe's own threads.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "render/gl/context.h"
#include "render/gl/overlay_pass.h"
#include "render/gl/pieces.h"
#include "render/gl/program.h"
#include "render/image/image.h"

namespace render {

class PlainRenderer {
 public:
  PlainRenderer(int width, int height);
  void draw(const render::DrawList&, render::Image& out);

 private:
  void draw_shadows(const std::vector<render::gl::Piece>&, const render::gl::FrameSetup&);
  void draw_run(const render::gl::Piece&, const render::gl::Geometry::Level&);
  void draw_scene(const std::vector<render::gl::Piece>&, const render::gl::FrameSetup&);

  int width_, height_;
  render::GlContext context_;
  render::gl::GeometryCache geometry_;
  render::gl::MaterialTable materials_;
  render::gl::Framebuffer many_, one_, shadow_;
  render::gl::Renderbuffer many_colour_, many_depth_, one_colour_, one_depth_;
  render::gl::Texture shadow_depth_;
  render::gl::Buffer block_;
  render::gl::VertexArray nothing_;
  struct Uploaded {
    render::gl::VertexArray array;
    render::gl::Buffer vertices, indices;
  };
  std::map<const render::gl::Geometry*, std::unique_ptr<Uploaded>> uploaded_;
  std::unique_ptr<render::gl::Program> depth_, ground_, thing_;
  render::gl::OverlayPass overlays_;
};

}  // namespace render
