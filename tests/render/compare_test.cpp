// Figures of a comparison against answers in closed form.
#include "render/image/compare.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "render/image/perceptual.h"
#include "render/image/ssim.h"

namespace render {
namespace {

Image plain(int width, int height, std::uint8_t r, std::uint8_t g, std::uint8_t b) {
  Image image{width, height, {}};
  for (int i = 0; i < width * height; ++i) image.rgba.insert(image.rgba.end(), {r, g, b, 255});
  return image;
}

double worst(const Plane& plane) {
  return static_cast<double>(*std::max_element(plane.values.begin(), plane.values.end()));
}

TEST(Ssim, OfTwoPlainGreysComparesTheirMeansAlone) {
  const double a = 100, b = 120, c1 = 2.55 * 2.55;
  // variances are zero; single precision in the filters leaves some 1e-3 of (1e4) * 1e-7 in them
  EXPECT_NEAR(ssim(plain(32, 24, 100, 100, 100), plain(32, 24, 120, 120, 120)), (2 * a * b + c1) / (a * a + b * b + c1), 1e-3);
}

TEST(Ssim, OfAPictureAndItsNegativeIsNegative) {
  Image a = plain(32, 32, 0, 0, 0), b = a;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) {
    if (i % 4 == 3) continue;
    const bool white = (i / 4 + i / 128) % 2 == 0;
    a.rgba[i] = white ? 255 : 0;
    b.rgba[i] = white ? 0 : 255;
  }
  // a chequerboard: means equal, covariance the negative of the variance
  EXPECT_LT(ssim(a, b), -0.9);
  EXPECT_NEAR(ssim(a, a), 1, 1e-6);
}

TEST(Ssim, OfAPictureSmallerThanItsWindowIsStillANumber) {
  EXPECT_NEAR(ssim(plain(3, 3, 9, 9, 9), plain(3, 3, 9, 9, 9)), 1, 1e-6);
}

TEST(Perceptual, GreenAndBlueAreAsFarApartAsThereIs) {
  // the scale is made so that these two plain pictures come to 1; without edges nothing else is in it
  EXPECT_NEAR(worst(perceptual_difference(plain(20, 20, 0, 255, 0), plain(20, 20, 0, 0, 255))), 1, 1e-4);
}

TEST(Perceptual, BlackAndWhiteFollowFromLightnessAlone) {
  // HyAB is 100; green to blue, damped by their lightness 87.73 and 32.30 (L*a*b* of the sRGB primaries: -86.18, 83.18 and 79.19,
  // -107.86), is 55.43 + hypot(-75.61 - 25.58, 72.97 + 34.84) = 203.29. Both to 0.7; beyond the knee at 0.4 the rest goes to 1
  const double ratio = std::pow(100 / 203.29, 0.7);
  const double expected = 0.95 + (ratio - 0.4) / 0.6 * 0.05;
  EXPECT_NEAR(worst(perceptual_difference(plain(20, 20, 0, 0, 0), plain(20, 20, 255, 255, 255))), expected, 1e-4);
}

TEST(Perceptual, IsTheSameBothWaysAndZeroForEqualPictures) {
  Image a = plain(40, 30, 90, 120, 60), b = a;
  for (std::size_t i = 0; i < 40; ++i) b.rgba[4 * (40 * i / 2 + i) + 1] = static_cast<std::uint8_t>(6 * i);
  EXPECT_EQ(perceptual_difference(a, b).values, perceptual_difference(b, a).values);
  EXPECT_EQ(worst(perceptual_difference(a, a)), 0);
}

TEST(Perceptual, ADotIsSeenWhereItIs) {
  Image a = plain(60, 60, 128, 128, 128), b = a;
  b.rgba[4 * (60 * 30 + 20)] = b.rgba[4 * (60 * 30 + 20) + 1] = 255;
  const Plane seen = perceptual_difference(a, b);
  EXPECT_EQ(static_cast<double>(seen.at(20, 30)), worst(seen));
  EXPECT_LT(seen.at(50, 10), 1e-4f);
}

TEST(Difference, CountsExactly) {
  const Image a = plain(10, 10, 50, 50, 50);
  Image b = a;
  b.rgba[0] = 51, b.rgba[5] = 90, b.rgba[8] = 53;
  const Difference d = difference_of(a, b);
  EXPECT_EQ(d.differing, 3);
  EXPECT_EQ(d.above_32, 1);
  EXPECT_EQ(d.largest, 40);
  EXPECT_DOUBLE_EQ(d.share_above_2, 0.02);
  EXPECT_DOUBLE_EQ(d.rms, std::sqrt((1 + 1600 + 9) / 400.0));
  const Mask mask{1, -5, 50, 6};
  EXPECT_EQ(difference_of(a, b, {&mask, 1}).differing, 1) << "all but the first of the upper row is masked";
}

TEST(Difference, NamesTheLimitsItBreaks) {
  Difference d;
  d.psnr_dB = INFINITY;
  EXPECT_TRUE(within(d, {}));
  d.ssim = 0.9;
  d.rms = 1;
  ASSERT_EQ(beyond(d, {}).size(), 2u);
  EXPECT_STREQ(beyond(d, {})[0]->name, "rms");
  EXPECT_STREQ(beyond(d, {})[1]->name, "ssim");
  d.ssim = std::nan("");
  EXPECT_FALSE(within(d, {})) << "what is no number is not within a limit";
}

TEST(SideBySide, PutsPicturesNextToEachOtherWithAGap) {
  const Image pictures[] = {plain(2, 1, 1, 1, 1), plain(1, 2, 2, 2, 2)};
  const Image out = side_by_side(pictures);
  EXPECT_EQ(out.width, 7);
  EXPECT_EQ(out.height, 2);
  EXPECT_EQ(out.rgba[0], 1);
  EXPECT_EQ(out.rgba[4 * 2], 128);
  EXPECT_EQ(out.rgba[4 * 6], 2);
  EXPECT_EQ(out.rgba[4 * (7 + 6)], 2);
  EXPECT_EQ(out.rgba[4 * 7], 128) << "below a lower picture is grey";
}

}  // namespace
}  // namespace render
