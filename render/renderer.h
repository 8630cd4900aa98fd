// DrawList -> Image, off-screen. The only interface to what stands in render/gl.
#pragma once

#include <memory>
#include <string>

#include "render/draw_list.h"
#include "render/image/image.h"

namespace render {

enum class Quality { draft, standard, fine };

/// One GL context (OSMesa) and its resources. Create it in the process that draws, after any fork. Throws RenderError with what
/// failed.
class Renderer {
 public:
  Renderer(int width, int height, Quality);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Pure: the same list gives the same bytes, whatever was drawn before.
  void draw(const DrawList&, Image& out);
  /// Milliseconds by pass of the last frame, for --timings.
  std::string timings() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// "Mesa ... llvmpipe ..." for `crashreel version`.
std::string gl_description();

}  // namespace render
