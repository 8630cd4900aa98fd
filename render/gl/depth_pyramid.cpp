#include "render/gl/depth_pyramid.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace render::gl {
namespace {

constexpr int kBlock = 4;  // texels a side
constexpr int kFold = 4;   // blocks a side that the next level takes together
constexpr int kFew = 6;    // blocks a side that `over` looks at, at most

using Range = DepthPyramid::Range;

void widen(Range& a, const Range& b) {
  a.least = std::min(a.least, b.least);
  a.largest = std::max(a.largest, b.largest);
}

// in this form the compiler takes several at a time
constexpr auto lesser = [](float a, float b) { return b < a ? b : a; };
constexpr auto larger = [](float a, float b) { return b > a ? b : a; };

/// Each block takes in its neighbours so many blocks away; beyond the rim lies depth 1.
template <class Pick>
void dilate(std::vector<float>& blocks, std::vector<float>& scratch, int side, int reach_x, int reach_y, Pick pick) {
  const auto take_in = [&](float* row, const float* other) {
    for (int i = 0; i < side; ++i) row[i] = pick(row[i], other[i]);
  };
  scratch.assign(static_cast<std::size_t>(side + 2 * reach_x), 1.0f);
  for (float* row = blocks.data(); row < blocks.data() + blocks.size(); row += side) {
    std::copy_n(row, side, scratch.begin() + reach_x);
    for (int k = 0; k <= 2 * reach_x; ++k) take_in(row, scratch.data() + k);
  }
  scratch.assign(static_cast<std::size_t>(side * (side + 2 * reach_y)), 1.0f);
  std::copy(blocks.begin(), blocks.end(), scratch.begin() + side * reach_y);
  for (int line = 0; line < side; ++line)
    for (int k = 0; k <= 2 * reach_y; ++k) take_in(blocks.data() + line * side, scratch.data() + (line + k) * side);
}

}  // namespace

void DepthPyramid::clear() {
  levels_.assign(1, {});
}

/// Blocks without their neighbours.
void DepthPyramid::pick_blocks(const float* depth, int side, std::ptrdiff_t pitch) {
  const std::size_t size = static_cast<std::size_t>(side * kBlock);
  std::vector<float> least(size), largest(size);  // of a row of blocks, by columns
  least_.clear();
  largest_.clear();
  for (const float* row = depth; row < depth + side * kBlock * pitch; row += kBlock * pitch) {
    std::copy_n(row, size, least.begin());
    std::copy_n(row, size, largest.begin());
    for (const float* other = row + pitch; other < row + kBlock * pitch; other += pitch)
      for (std::size_t x = 0; x < size; ++x) {
        least[x] = lesser(least[x], other[x]);
        largest[x] = larger(largest[x], other[x]);
      }
    for (std::size_t x = 0; x < size; x += kBlock) {
      least_.push_back(lesser(lesser(least[x], least[x + 1]), lesser(least[x + 2], least[x + 3])));
      largest_.push_back(larger(larger(largest[x], largest[x + 1]), larger(largest[x + 2], largest[x + 3])));
    }
  }
}

void DepthPyramid::build(const float* depth, int size, std::ptrdiff_t pitch, int reach_x, int reach_y) {
  const int side = size / kBlock;
  pick_blocks(depth, side, pitch);
  const auto in_blocks = [](int reach) { return (reach + kBlock - 1) / kBlock; };
  dilate(least_, scratch_, side, in_blocks(reach_x), in_blocks(reach_y), lesser);
  dilate(largest_, scratch_, side, in_blocks(reach_x), in_blocks(reach_y), larger);
  levels_.assign(1, {side, {}});
  for (std::size_t i = 0; i < least_.size(); ++i) levels_.front().blocks.push_back({least_[i], largest_[i]});
  while (levels_.back().side > kFold) {
    Level next{levels_.back().side / kFold, {}};
    const Level& last = levels_.back();
    for (int r = 0; r < next.side; ++r)
      for (int c = 0; c < next.side; ++c) {
        Range range = last.blocks[static_cast<std::size_t>(r * kFold * last.side + c * kFold)];
        for (int y = 0; y < kFold; ++y)
          for (int x = 0; x < kFold; ++x)
            widen(range, last.blocks[static_cast<std::size_t>((r * kFold + y) * last.side + c * kFold + x)]);
        next.blocks.push_back(range);
      }
    levels_.push_back(std::move(next));
  }
}

DepthPyramid::Range DepthPyramid::over(double u0, double v0, double u1, double v1) const {
  if (u1 < 0 || v1 < 0 || u0 > 1 || v0 > 1) return {};
  const bool beyond = u0 < 0 || v0 < 0 || u1 > 1 || v1 > 1;
  std::size_t level = 0;
  while (level + 1 < levels_.size() && std::max(u1 - u0, v1 - v0) * levels_[level].side > kFew) ++level;
  const Level& l = levels_[level];
  const auto block = [&](double u) { return std::clamp(static_cast<int>(std::floor(u * l.side)), 0, l.side - 1); };
  Range range = l.blocks[static_cast<std::size_t>(block(v0) * l.side + block(u0))];
  if (beyond) widen(range, {});
  for (int r = block(v0); r <= block(v1); ++r)
    for (int c = block(u0); c <= block(u1); ++c) widen(range, l.blocks[static_cast<std::size_t>(r * l.side + c)]);
  return range;
}

}  // namespace render::gl
