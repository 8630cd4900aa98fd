#include "render/image/compare.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <limits>

namespace render {
namespace {

constexpr int kChannels = 4;

/// The largest difference of a pixel's channels.
int pixel_difference(const Image& a, const Image& b, std::size_t pixel) {
  int largest = 0;
  for (std::size_t i = pixel * kChannels; i < (pixel + 1) * kChannels; ++i)
    largest = std::max(largest, std::abs(a.rgba[i] - b.rgba[i]));
  return largest;
}

}  // namespace

Difference difference_of(const Image& a, const Image& b) {
  assert(a.width == b.width && a.height == b.height && "only pictures of one size can be compared");
  Difference out;
  const std::size_t pixels = static_cast<std::size_t>(a.width) * static_cast<std::size_t>(a.height);
  long above_2 = 0;
  double squares = 0;
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    const int difference = pixel_difference(a, b, pixel);
    if (difference == 0) continue;
    above_2 += difference > 2;
    out.above_32 += difference > 32;
    out.largest = std::max(out.largest, difference);
    for (std::size_t i = pixel * kChannels; i < (pixel + 1) * kChannels; ++i) squares += std::pow(a.rgba[i] - b.rgba[i], 2);
  }
  out.share_above_2 = static_cast<double>(above_2) / static_cast<double>(pixels);
  out.rms = std::sqrt(squares / static_cast<double>(pixels * kChannels));
  out.psnr_dB = out.rms > 0 ? 20 * std::log10(255 / out.rms) : std::numeric_limits<double>::infinity();
  return out;
}

bool within(const Difference& found, const Limits& limits) {
  return found.share_above_2 <= limits.share_above_2 && found.above_32 <= limits.above_32 && found.rms <= limits.rms &&
         found.psnr_dB >= limits.psnr_dB;
}

Image difference_picture(const Image& a, const Image& b) {
  assert(a.width == b.width && a.height == b.height && "only pictures of one size can be compared");
  Image out{a.width, a.height, {}};
  const std::size_t pixels = static_cast<std::size_t>(a.width) * static_cast<std::size_t>(a.height);
  out.rgba.reserve(pixels * kChannels);
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    const std::uint8_t* rgba = &a.rgba[pixel * kChannels];
    const int difference = pixel_difference(a, b, pixel);
    const int grey = (rgba[0] + rgba[1] + rgba[2]) / 9;  // a third of the mean
    const int green = 230 - 230 * std::min(difference, 32) / 32;
    const auto byte = [](int value) { return static_cast<std::uint8_t>(value); };
    if (difference == 0) {
      out.rgba.insert(out.rgba.end(), {byte(grey), byte(grey), byte(grey), 255});
    } else {
      out.rgba.insert(out.rgba.end(), {255, byte(green), 0, 255});
    }
  }
  return out;
}

}  // namespace render
