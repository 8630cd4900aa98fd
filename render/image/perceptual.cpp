// Two pipelines that meet in the last line (section numbers of the paper):
//   colour (4.1): sRGB -> YCxCz, each channel blurred by the eye's contrast sensitivity -> L*a*b*, chroma damped in the dark (Hunt)
//   ->
//                 HyAB distance, compressed and mapped to 0..1:                                          dE_c
//   features (4.2): derivatives of a Gaussian on luminance find edges and points; how much each changed:  dE_f
//   together (4.3):                                                                          dE = dE_c ^ (1 - dE_f)
#include "render/image/perceptual.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

namespace render {
namespace {

using Triple = std::array<double, 3>;
using Planes = std::array<Plane, 3>;

/// Reference white of the standard light D65, sRGB's own: what (1, 1, 1) becomes.
constexpr Triple kWhite{0.950428545, 1.0, 1.088900371};

Triple xyz_of(const Triple& rgb) {
  return {0.4123907993 * rgb[0] + 0.3575843394 * rgb[1] + 0.1804807884 * rgb[2],
          0.2126390059 * rgb[0] + 0.7151686788 * rgb[1] + 0.0721923154 * rgb[2],
          0.0193308187 * rgb[0] + 0.1191947798 * rgb[1] + 0.9505321522 * rgb[2]};
}

Triple rgb_of(const Triple& xyz) {
  return {3.2409699419 * xyz[0] - 1.5373831776 * xyz[1] - 0.4986107603 * xyz[2],
          -0.9692436363 * xyz[0] + 1.8759675015 * xyz[1] + 0.0415550574 * xyz[2],
          0.0556300797 * xyz[0] - 0.2039769589 * xyz[1] + 1.0569715142 * xyz[2]};
}

/// Opponent axes linear in light: luminance, red-green, blue-yellow.
Planes opponent_planes(const Image& image) {
  std::array<double, 256> linear{};
  for (std::size_t i = 0; i < 256; ++i) {
    const double c = static_cast<double>(i) / 255;
    linear[i] = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  }
  Planes out{Plane(image.width, image.height), Plane(image.width, image.height), Plane(image.width, image.height)};
  for (std::size_t i = 0; i < out[0].values.size(); ++i) {
    const std::uint8_t* p = &image.rgba[4 * i];
    const Triple xyz = xyz_of({linear[p[0]], linear[p[1]], linear[p[2]]});
    const double x = xyz[0] / kWhite[0], y = xyz[1] / kWhite[1], z = xyz[2] / kWhite[2];
    out[0].values[i] = static_cast<float>(116 * y - 16);
    out[1].values[i] = static_cast<float>(500 * (x - y));
    out[2].values[i] = static_cast<float>(200 * (y - z));
  }
  return out;
}

/// L*, and a*, b* damped by L*: colours look paler in the dark (Hunt).
Triple hunt_lab(const Triple& linear_rgb) {
  const auto f = [](double t) {
    constexpr double kDelta = 6.0 / 29;
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0 / 29;
  };
  const Triple xyz = xyz_of(linear_rgb);
  const double fx = f(xyz[0] / kWhite[0]), fy = f(xyz[1] / kWhite[1]), fz = f(xyz[2] / kWhite[2]);
  const double lightness = 116 * fy - 16;
  return {lightness, 0.01 * lightness * 500 * (fx - fy), 0.01 * lightness * 200 * (fy - fz)};
}

double hyab(const Triple& a, const Triple& b) {
  return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

/// A channel's contrast sensitivity: a1 sqrt(pi/b1) exp(-pi^2 r^2/b1) + a2 sqrt(pi/b2) exp(-pi^2 r^2/b2), r in degrees (table 1).
struct Sensitivity {
  double a1, b1, a2, b2;
};
constexpr std::array<Sensitivity, 3> kSensitivity{{{1, 0.0047, 0, 1e-5}, {1, 0.0053, 0, 1e-5}, {34.1, 0.04, 13.5, 0.025}}};

void blur_as_seen(Planes& planes, double pixels_per_degree) {
  for (std::size_t c = 0; c < 3; ++c) {
    const Sensitivity& s = kSensitivity[c];
    // each Gaussian of the sum is separable; their shares of the whole weight remain
    struct Part {
      Kernel kernel;
      double weight;
    };
    std::vector<Part> parts;
    double total = 0;
    for (const auto& [a, b] : {std::pair{s.a1, s.b1}, std::pair{s.a2, s.b2}}) {
      if (a == 0) continue;
      const double sigma = std::sqrt(b / (2 * std::numbers::pi * std::numbers::pi)) * pixels_per_degree;
      // the volume of the Gaussian over the plane is 2 pi sigma^2
      parts.push_back({normalised(gaussian(sigma)), a * std::sqrt(std::numbers::pi / b) * sigma * sigma});
      total += parts.back().weight;
    }
    Plane sum(planes[c].width, planes[c].height);
    for (const Part& part : parts) {
      const Plane blurred = filtered(planes[c], part.kernel, part.kernel);
      for (std::size_t i = 0; i < sum.values.size(); ++i)
        sum.values[i] += static_cast<float>(part.weight / total) * blurred.values[i];
    }
    planes[c] = std::move(sum);
  }
}

Triple seen_colour(const Planes& planes, std::size_t i) {
  const double y = (static_cast<double>(planes[0].values[i]) + 16) / 116;
  const double x = static_cast<double>(planes[1].values[i]) / 500 + y;
  const double z = y - static_cast<double>(planes[2].values[i]) / 200;
  Triple rgb = rgb_of({x * kWhite[0], y * kWhite[1], z * kWhite[2]});
  for (double& c : rgb) c = std::clamp(c, 0.0, 1.0);
  return hunt_lab(rgb);
}

/// Compressed by a power, then the lower 40 % of the range stretched over 95 % of the answer: large distances all look large.
double mapped_colour_difference(double distance) {
  constexpr double kPower = 0.7, kKnee = 0.4, kKneeValue = 0.95;
  // green against blue are the farthest apart
  static const double largest = std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), kPower);
  const double d = std::pow(distance, kPower), knee = kKnee * largest;
  if (d < knee) return kKneeValue / knee * d;
  return std::min(1.0, kKneeValue + (d - knee) / (largest - knee) * (1 - kKneeValue));
}

/// Positive weights sum to one, negative ones to minus one.
Kernel balanced(Kernel kernel) {
  float positive = 0, negative = 0;
  for (const float w : kernel) (w > 0 ? positive : negative) += w;
  for (float& w : kernel) w /= w > 0 ? positive : -negative;
  return kernel;
}

/// Strength of edges and of points and lines at each pixel of a luminance of 0..1.
std::array<Plane, 2> features(const Plane& luminance, double pixels_per_degree) {
  constexpr double kWidth = 0.082;  // [deg] at which the eye is keenest for edges
  const double sigma = 0.5 * kWidth * pixels_per_degree;
  const Kernel smooth = normalised(gaussian(sigma));
  Kernel slope = smooth, bend = smooth;
  const int radius = static_cast<int>(smooth.size() / 2);
  for (int i = -radius; i <= radius; ++i) {
    const std::size_t k = static_cast<std::size_t>(i + radius);
    slope[k] *= static_cast<float>(-i);
    bend[k] *= static_cast<float>(i * i / (sigma * sigma) - 1);
  }
  std::array<Plane, 2> out{Plane(luminance.width, luminance.height), Plane(luminance.width, luminance.height)};
  for (std::size_t f = 0; f < 2; ++f) {
    const Kernel kernel = balanced(f == 0 ? slope : bend);
    const Plane dx = filtered(luminance, kernel, smooth), dy = filtered(luminance, smooth, kernel);
    for (std::size_t i = 0; i < out[f].values.size(); ++i) out[f].values[i] = std::hypot(dx.values[i], dy.values[i]);
  }
  return out;
}

Plane luminance_of(const Planes& planes) {
  Plane out = planes[0];
  for (float& y : out.values) y = (y + 16) / 116;
  return out;
}

}  // namespace

Plane perceptual_difference(const Image& a, const Image& b, double pixels_per_degree) {
  assert(a.width == b.width && a.height == b.height && "only pictures of one size can be compared");
  Planes planes_a = opponent_planes(a), planes_b = opponent_planes(b);
  const auto features_a = features(luminance_of(planes_a), pixels_per_degree);
  const auto features_b = features(luminance_of(planes_b), pixels_per_degree);
  blur_as_seen(planes_a, pixels_per_degree);
  blur_as_seen(planes_b, pixels_per_degree);
  Plane out(a.width, a.height);
  for (std::size_t i = 0; i < out.values.size(); ++i) {
    const double colour = mapped_colour_difference(hyab(seen_colour(planes_a, i), seen_colour(planes_b, i)));
    const float edges = std::abs(features_a[0].values[i] - features_b[0].values[i]);
    const float points = std::abs(features_a[1].values[i] - features_b[1].values[i]);
    const double feature = std::clamp(std::sqrt(static_cast<double>(std::max(edges, points)) / std::numbers::sqrt2), 0.0, 1.0);
    out.values[i] = static_cast<float>(std::pow(colour, 1 - feature));
  }
  return out;
}

}  // namespace render
