// Lines, arrows and markers: OpenGL draws them, anti-aliased analytically at one sample, into a picture of their own that is laid
// over the finished one.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "render/gl/object_pass.h"
#include "render/gl/program.h"
#include "render/gl/target.h"
#include "render/shade/kernels.h"

namespace render::gl {

class OverlayPass {
 public:
  OverlayPass();
  void begin(const DrawList&, int width, int height);
  /// What things may hide, in a part of the picture without things.
  void draw_behind(const Rectangle&);
  /// In a part whose things the object pass holds.
  void draw_behind(const ObjectPass&, const Rectangle&, int samples);
  /// What is in front of everything, and all of it onto the canvas.
  void finish(const shade::Canvas&);

 private:
  struct Pixel {
    float x, y, z;
    float slope_x = 0, slope_y = 0;  // of the depth over the picture, where a line lies on a surface
  };
  enum class Ends { round, square };
  /// Where a vertex lies on its piece [pixels], and what the piece is.
  struct Shape {
    float across, along, half, length;
    bool square;
  };
  void gather(const DrawList&, Occluded);
  float depth_of(const Eigen::Vector4f& clip) const;
  bool project(const Float3& a, const Float3& b, Pixel& pa, Pixel& pb) const;
  void lie_on(const Float3& at, const Float3& normal, Pixel&) const;
  void vertex(const Pixel&, float off_x, float off_y, const Shape&, const Float4& colour);
  void capsule(const Pixel& a, const Pixel& b, float half_a, float half_b, const Float4& colour, Ends = Ends::round);
  void band(const std::vector<Pixel>& run, float half, const Float4& colour);
  void polyline(const LineItem&, float extra, const Float4& colour);
  void arrow(const ArrowItem&, float extra, const Float4& colour);
  void draw(const Program&, const Rectangle&, std::size_t first, std::size_t count);

  Program in_front_, behind_;
  Target target_{"picture of the lines", {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, 0}, false};
  Rectangle reach_;  // what the vertices reach, on the picture
  VertexArray array_;
  Buffer buffer_;
  std::vector<float> vertices_;
  std::size_t hidden_end_ = 0;  // of the vertices: before it what things hide, then
  std::size_t faint_end_ = 0;   // what they make faint
  Eigen::Matrix4f clip_;
  std::array<float, 2> per_depth_{};  // of z and w in clip coordinates, by metre towards the eye
  float towards_eye_ = 0;             // [m]
  int width_ = 0, height_ = 0;
  float scale_ = 1;
  std::vector<std::uint8_t> lines_;  // premultiplied
};

}  // namespace render::gl
