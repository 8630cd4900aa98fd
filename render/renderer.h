// DrawList -> Image, off-screen. The only interface to what stands in render/gl.
#pragma once

#include <memory>
#include <string>

#include "render/cost.h"
#include "render/draw_list.h"
#include "render/image/image.h"

namespace render {

enum class Quality { draft, standard, fine };

/// What a quality level spends.
struct Effort {
  int scale = 1;               // pictures are drawn so many times larger a side
  int samples = 2;             // a side to a pixel, 1 or 2
  int shadow_map_size = 1024;  // [pixels] a side
  int shadow_filter = 1;       // 1 plain, 2 soft
  double shadow_reach = 0.05;  // [m] radius of the widest penumbra
  int occlusion_size = 128;    // texels a side of the occlusion map
  double pixel_share = 0.2;    // [pixels] that tessellation may be off
  int ground_step = 1;         // [pixels] along a row from one look at the ground to the next
};
Effort effort_of(Quality, int width, int height);

/// What is kept from frame to frame.
class Renderer {
 public:
  Renderer(int width, int height, Quality);
  Renderer(int width, int height, const Effort&);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Pure: the same list gives the same bytes, whatever was drawn before.
  void draw(const DrawList&, Image& out);
  /// Of the last frame.
  const FrameCost& cost() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Which OpenGL draws from here on, in this process and in those it starts: "osmesa", as if nothing had been said, or "egl".
void choose_gl(const std::string& name);

/// What draws: "OSMesa, 3.3 (Core Profile) Mesa ..., llvmpipe ..." for `crashreel version`.
std::string gl_description();

}  // namespace render
