// An off-screen OpenGL 3.3 core context. OSMesa today; whoever replaces it changes this pair of files. Pictures are drawn by our
// own kernels (shade/), faster and with the same bytes whatever Mesa is installed; OpenGL is the second method they
// are held against (tests/snapshots/second_renderer_test.cpp) and the yardstick of the benchmark.
#pragma once

#include <string>
#include <vector>

namespace render {

class GlContext {
 public:
  GlContext(int width, int height);  // throws RenderError
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
