// Skid marks on the picture: where they lie, that their pieces join without a seam, that things and the eye's own plane cut them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "gl_scene.h"
#include "render/renderer.h"

namespace render {
namespace {

using namespace test;

constexpr int kWidth = 480, kHeight = 320;
constexpr float kAspect = 1.5f;

/// From one place to another along x or y, 0.2 m wide, in so many pieces.
StripItem mark(const Float3& from, const Float3& to, int pieces) {
  const bool along_x = from[0] != to[0];
  StripItem strip;
  for (int i = 0; i <= pieces; ++i) {
    const float s = static_cast<float>(i) / static_cast<float>(pieces);
    const Float3 p{from[0] + s * (to[0] - from[0]), from[1] + s * (to[1] - from[1]), 0};
    strip.left.push_back(along_x ? Float3{p[0], p[1] + 0.1f, 0} : Float3{p[0] - 0.1f, p[1], 0});
    strip.right.push_back(along_x ? Float3{p[0], p[1] - 0.1f, 0} : Float3{p[0] + 0.1f, p[1], 0});
    strip.darkness.push_back(0.6f);
  }
  return strip;
}

Image drawn(const View& view, const std::vector<StripItem>& strips, const std::vector<EllipsoidItem>& balls = {}) {
  DrawList list = plain(view);
  list.strips = strips;
  list.ellipsoids = balls;
  Renderer renderer(kWidth, kHeight, Quality::standard);
  Image out;
  renderer.draw(list, out);
  return out;
}

int brightness(const Image& image, int x, int y) {
  const std::size_t at = 4 * static_cast<std::size_t>(y * image.width + x);
  return image.rgba[at] + image.rgba[at + 1] + image.rgba[at + 2];
}

TEST(MarkPicture, IsAsWideAndLongAsTheMark) {
  const View view = look_down(0, 0, 8, kAspect);  // 40 pixels a metre
  const Image bare = drawn(view, {}), marked = drawn(view, {mark({-2, 0, 0}, {2, 0, 0}, 5)});
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const double along = std::abs(x + 0.5 - kWidth / 2.0) / 40, across = std::abs(y + 0.5 - kHeight / 2.0) / 40;
      const int change = brightness(marked, x, y) - brightness(bare, x, y);
      if (along > 2.02 || across > 0.12) {
        ASSERT_EQ(change, 0) << x << ", " << y;
      }
      if (along < 1.98 && across < 0.06) {
        ASSERT_LT(change, -40) << x << ", " << y;
      }
    }
}

TEST(MarkPicture, IsTheSameInFewPiecesAndInMany) {
  const View view = look_along_y({0, -6, 2}, 0.25f, kAspect);
  const Image few = drawn(view, {mark({-2, 2, 0}, {2, 2, 0}, 1)}), many = drawn(view, {mark({-2, 2, 0}, {2, 2, 0}, 37)});
  // corners snap to 1/64 of a pixel: a piece's own edges move by as much, and what is blended over them by a few of 255. Blended
  // twice or not at all a pixel would be off by 20 and more
  for (std::size_t i = 0; i < few.rgba.size(); ++i) ASSERT_NEAR(few.rgba[i], many.rgba[i], 5) << "at byte " << i;
}

TEST(MarkPicture, RunsOnBelowAndBehindTheEye) {
  const View view = look_along_y({0, -6, 2}, 0.9f, kAspect);
  const Image bare = drawn(view, {}), marked = drawn(view, {mark({0, -30, 0}, {0, 30, 0}, 3)});
  for (int y = kHeight * 2 / 3; y < kHeight; ++y)
    EXPECT_LT(brightness(marked, kWidth / 2, y), brightness(bare, kWidth / 2, y) - 20);
}

TEST(MarkPicture, LiesUnderThings) {
  const View view = look_down(0, 0, 8, kAspect);
  const std::vector<EllipsoidItem> balls{ball({0, 0, 0.5f}, 0.5)};
  const Image alone = drawn(view, {}, balls), marked = drawn(view, {mark({-2, 0, 0}, {2, 0, 0}, 5)}, balls);
  for (int x = kWidth / 2 - 15; x < kWidth / 2 + 15; ++x)
    EXPECT_EQ(brightness(marked, x, kHeight / 2), brightness(alone, x, kHeight / 2));
  EXPECT_LT(brightness(marked, kWidth / 2 + 60, kHeight / 2), brightness(alone, kWidth / 2 + 60, kHeight / 2) - 20);
}

}  // namespace
}  // namespace render
