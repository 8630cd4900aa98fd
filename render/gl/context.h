// An off-screen OpenGL 3.3 core context, current in the process that made it. Made after a fork, never carried over one.
#pragma once

#include <string>
#include <vector>

namespace render {

class GlContext {
 public:
  enum class Threads { none, own };                           // of the rasteriser, beside the caller's
  GlContext(int width, int height, Threads = Threads::none);  // throws RenderError
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;
  void make_current() const;  // throws RenderError
  std::string description() const;

 private:
  void* context_ = nullptr;
  int width_, height_;
  mutable std::vector<unsigned char> buffer_;  // OSMesa wants one to be current; pictures are read from our own framebuffer
};

}  // namespace render
