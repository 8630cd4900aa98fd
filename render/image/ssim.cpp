// With Gaussian means mu, variances s2 and covariance s_ab in a window (eq. 13 there):
//   SSIM = (2 mu_a mu_b + C1)(2 s_ab + C2) / ((mu_a^2 + mu_b^2 + C1)(s2_a + s2_b + C2))
#include "render/image/ssim.h"

#include <cassert>

#include "render/image/plane.h"

namespace render {
namespace {

constexpr int kRadius = 5;
constexpr double kSigma = 1.5;                       // [pixels]
constexpr double kC1 = (0.01 * 255) * (0.01 * 255);  // keeps dark windows from dividing by nothing
constexpr double kC2 = (0.03 * 255) * (0.03 * 255);  // the same for flat ones

Plane luma(const Image& image) {
  Plane out(image.width, image.height);
  for (std::size_t i = 0; i < out.values.size(); ++i) {
    const std::uint8_t* p = &image.rgba[4 * i];
    out.values[i] = 0.299f * p[0] + 0.587f * p[1] + 0.114f * p[2];  // ITU-R BT.601
  }
  return out;
}

Plane product(const Plane& a, const Plane& b) {
  Plane out(a.width, a.height);
  for (std::size_t i = 0; i < out.values.size(); ++i) out.values[i] = a.values[i] * b.values[i];
  return out;
}

}  // namespace

double ssim(const Image& image_a, const Image& image_b) {
  assert(image_a.width == image_b.width && image_a.height == image_b.height && "only pictures of one size can be compared");
  const Kernel window = normalised(gaussian(kSigma, kRadius));
  const auto mean = [&window](const Plane& p) { return filtered(p, window, window); };
  const Plane a = luma(image_a), b = luma(image_b);
  const Plane mu_a = mean(a), mu_b = mean(b), aa = mean(product(a, a)), bb = mean(product(b, b)), ab = mean(product(a, b));
  const int border = a.width > 2 * kRadius && a.height > 2 * kRadius ? kRadius : 0;
  double sum = 0;
  long windows = 0;
  for (int y = border; y < a.height - border; ++y)
    for (int x = border; x < a.width - border; ++x, ++windows) {
      const double ma = static_cast<double>(mu_a.at(x, y)), mb = static_cast<double>(mu_b.at(x, y));
      const double var_a = static_cast<double>(aa.at(x, y)) - ma * ma, var_b = static_cast<double>(bb.at(x, y)) - mb * mb;
      const double covariance = static_cast<double>(ab.at(x, y)) - ma * mb;
      sum += (2 * ma * mb + kC1) * (2 * covariance + kC2) / ((ma * ma + mb * mb + kC1) * (var_a + var_b + kC2));
    }
  return windows > 0 ? sum / static_cast<double>(windows) : 1;
}

}  // namespace render
