// Least and largest depth of a shadow map around each place: where they leave no doubt, nothing needs to be looked up.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace render::gl {

class DepthPyramid {
 public:
  struct Range {
    float least = 1, largest = 1;
  };

  /// From a square map of `size` texels (a power of two, at least 16) a side, `pitch` from row to row; beyond it the depth is 1.
  /// Each block of the finest level holds what lies within `reach` texels (x, y) of it.
  void build(const float* depth, int size, std::ptrdiff_t pitch, int reach_x, int reach_y);
  /// No map: depth 1 everywhere.
  void clear();

  /// Of a rectangle in texture coordinates, reach included. Conservative.
  Range over(double u0, double v0, double u1, double v1) const;

  /// The finest level, two numbers a block.
  int side() const { return levels_.front().side; }
  const std::vector<Range>& blocks() const { return levels_.front().blocks; }

 private:
  void pick_blocks(const float* depth, int side, std::ptrdiff_t pitch);

  struct Level {
    int side = 1;
    std::vector<Range> blocks{{}};
  };
  std::vector<Level> levels_{{}};
  std::vector<float> least_, largest_, scratch_;
};

}  // namespace render::gl
