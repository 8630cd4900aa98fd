// Lines, arrows and markers over the finished picture, anti-aliased analytically at one sample.
#pragma once

#include <vector>

#include "render/draw_list.h"
#include "render/gl/program.h"

namespace render::gl {

class OverlayPass {
 public:
  OverlayPass();
  ~OverlayPass();
  OverlayPass(const OverlayPass&) = delete;
  OverlayPass& operator=(const OverlayPass&) = delete;

  /// Into the bound framebuffer. Lines that pass behind things are tested against its depth.
  void draw(const DrawList&, int width, int height);

 private:
  struct Pixel {
    float x, y, z;
    bool visible;
    float slope_x = 0, slope_y = 0;  // of the depth over the picture, where a line lies on a surface
  };
  void begin(const DrawList&, int width, int height);
  bool project(const Float3& a, const Float3& b, Pixel& pa, Pixel& pb) const;
  void lie_on(const Float3& at, const Float3& normal, Pixel&) const;
  enum class Ends { round, square };
  void capsule(const Pixel& a, const Pixel& b, float half_a, float half_b, const Float4& colour, Ends = Ends::round);
  void polyline(const LineItem&, float extra, const Float4& colour);
  void arrow(const ArrowItem&, float extra, const Float4& colour);
  void flush(bool depth_tested);

  Program program_;
  unsigned array_ = 0, buffer_ = 0;
  std::vector<float> vertices_;
  float clip_[16] = {};
  float width_ = 0, height_ = 0, scale_ = 1;
};

}  // namespace render::gl
