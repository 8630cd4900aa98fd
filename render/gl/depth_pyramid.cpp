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

// each element takes in its neighbours up to `reach` away along one axis; beyond the rim lies depth 1
void dilate(const std::vector<Range>& in, int side, int reach, std::ptrdiff_t step, std::ptrdiff_t row, std::vector<Range>& out) {
  for (int line = 0; line < side; ++line)
    for (int i = 0; i < side; ++i) {
      const Range* at = in.data() + line * row;
      Range r = i < reach || i + reach >= side ? Range{} : at[i * step];
      for (int k = std::max(i - reach, 0); k <= std::min(i + reach, side - 1); ++k) widen(r, at[k * step]);
      out[static_cast<std::size_t>(line * row + i * step)] = r;
    }
}

}  // namespace

void DepthPyramid::clear() {
  levels_.assign(1, {});
}

void DepthPyramid::build(const float* depth, int size, std::ptrdiff_t pitch, int reach_x, int reach_y) {
  const int side = size / kBlock;
  const std::size_t count = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
  levels_.resize(1);
  Level& finest = levels_.front();
  finest.side = side;
  finest.blocks.resize(count);
  scratch_.resize(count);
  for (int r = 0; r < side; ++r)
    for (int c = 0; c < side; ++c) {
      const float* texel = depth + r * kBlock * pitch + c * kBlock;
      Range range{texel[0], texel[0]};
      for (int y = 0; y < kBlock; ++y, texel += pitch)
        for (int x = 0; x < kBlock; ++x) widen(range, {texel[x], texel[x]});
      finest.blocks[static_cast<std::size_t>(r * side + c)] = range;
    }
  const auto blocks = [](int reach) { return (reach + kBlock - 1) / kBlock; };
  dilate(finest.blocks, side, blocks(reach_x), 1, side, scratch_);
  dilate(scratch_, side, blocks(reach_y), side, 1, finest.blocks);
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
