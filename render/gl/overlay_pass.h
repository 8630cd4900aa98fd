// Lines, arrows and markers over the finished picture, anti-aliased analytically at one sample.
#pragma once

#include <array>

#include "render/draw_list.h"
#include "render/shade/kernels.h"

namespace render::gl {

class OverlayPass {
 public:
  /// Onto the canvas. Lines that pass behind things are held against `depth`, 0..1 of each pixel; without it they are in front.
  void draw(const DrawList&, const shade::Canvas&, const float* depth);

 private:
  struct Pixel {
    float x, y, z;
    float slope_x = 0, slope_y = 0;  // of the depth over the picture, where a line lies on a surface
  };
  void begin(const DrawList&, const shade::Canvas&);
  bool project(const Float3& a, const Float3& b, Pixel& pa, Pixel& pb) const;
  void lie_on(const Float3& at, const Float3& normal, Pixel&) const;
  enum class Ends { round, square };
  void capsule(const Pixel& a, const Pixel& b, float half_a, float half_b, const Float4& colour, Ends = Ends::round) const;
  void polyline(const LineItem&, float extra, const Float4& colour) const;
  void arrow(const ArrowItem&, float extra, const Float4& colour) const;

  shade::Canvas canvas_{};
  const float* depth_ = nullptr;  // what the lines at hand are held against
  std::array<float, 16> clip_{};
  float width_ = 0, height_ = 0, scale_ = 1;
};

}  // namespace render::gl
