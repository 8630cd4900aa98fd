// The depth pyramid bounds what it stands for, and the tiles cover the picture once.
#include "render/gl/ground_tiles.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <random>

#include "gl_scene.h"

namespace render::gl {
namespace {

TEST(DepthPyramid, HoldsEveryDepthWithinReach) {
  constexpr int kSize = 256, kReachX = 9, kReachY = 5;
  std::mt19937 random(4);
  std::uniform_real_distribution<float> any(0, 1);
  std::vector<float> depth(kSize * kSize);
  for (float& d : depth) d = any(random);
  DepthPyramid pyramid;
  pyramid.build(depth.data(), kSize, kSize, kReachX, kReachY);
  for (int round = 0; round < 300; ++round) {
    const int x0 = static_cast<int>(any(random) * kSize), x1 = std::min(kSize - 1, x0 + round % 70);
    const int y0 = static_cast<int>(any(random) * kSize), y1 = std::min(kSize - 1, y0 + round % 50);
    const auto range = pyramid.over((x0 + 0.5) / kSize, (y0 + 0.5) / kSize, (x1 + 0.5) / kSize, (y1 + 0.5) / kSize);
    for (int y = y0 - kReachY; y <= y1 + kReachY; ++y)
      for (int x = x0 - kReachX; x <= x1 + kReachX; ++x) {
        const bool inside = x >= 0 && y >= 0 && x < kSize && y < kSize;
        const float d = inside ? depth[static_cast<std::size_t>(y * kSize + x)] : 1.0f;
        ASSERT_LE(range.least, d);
        ASSERT_GE(range.largest, d);
      }
  }
}

TEST(DepthPyramid, BeyondTheMapNothingCasts) {
  DepthPyramid pyramid;
  pyramid.build(std::vector<float>(64 * 64, 0.25f).data(), 64, 64, 8, 8);
  const auto away = pyramid.over(1.2, 0.1, 1.4, 0.2), within = pyramid.over(0.45, 0.45, 0.55, 0.55);
  EXPECT_EQ(away.least, 1);
  EXPECT_EQ(within.least, 0.25f);
  EXPECT_EQ(within.largest, 0.25f);
}

TEST(GroundTiles, CoverEveryPixelOnce) {
  constexpr int kWidth = 500, kHeight = 333;
  for (const bool from_above : {false, true}) {
    DrawList list;
    list.view = from_above ? test::look_down(3, 2, 12, 1.5f) : test::look_along_y({0, -6, 2}, 0.4f, 1.5f);
    const FrameSetup frame = set_up_frame(list, {}, kWidth, kHeight, 64);
    std::vector<int> covered(kWidth * kHeight, 0);
    for (const auto& [look, rectangles] : lay_tiles(frame, list.road, DepthPyramid(), Shade::cast, kWidth, kHeight))
      for (const Rectangle& r : rectangles)
        for (int y = r.y; y < r.y + r.height; ++y)
          for (int x = r.x; x < r.x + r.width; ++x) ++covered[static_cast<std::size_t>(y * kWidth + x)];
    EXPECT_EQ(std::ranges::count(covered, 1), kWidth * kHeight) << (from_above ? "from above" : "along the road");
  }
}

}  // namespace
}  // namespace render::gl
