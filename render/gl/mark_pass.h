// Marks on the ground, such as skid marks.
#pragma once

#include <array>
#include <vector>

#include "render/gl/cut.h"
#include "render/gl/frame_block.h"
#include "render/shade/kernels.h"

namespace render::gl {

class MarkPass {
 public:
  /// Where the list's marks lie on a picture of so many pixels.
  void begin(const DrawList&, const FrameSetup&, int width, int height);
  /// Rows y0 up to y1 of them, over what the canvas shows; held against `depth` (shade::Marks) if there is any.
  void draw(int y0, int y1, const float* depth, const shade::Maps&, const shade::Canvas&) const;

 private:
  void add(const std::array<CutPoint<4>, 3>&, double width, double height);

  std::vector<shade::MarkTriangle> triangles_;
};

}  // namespace render::gl
