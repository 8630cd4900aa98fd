#include "render/image/compare.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <limits>

#include "render/image/perceptual.h"
#include "render/image/ssim.h"

namespace render {
namespace {

constexpr int kChannels = 4;
constexpr std::uint8_t kMaskBlue = 120;  // at least so blue where the difference picture shows a mask

constexpr Measure kMeasures[] = {
    {"pixels_differing", &Difference::differing, nullptr, Measure::Same::below, "pixels not the same to the bit"},
    {"share_above_2", &Difference::share_above_2, &Limits::share_above_2, Measure::Same::below,
     "share of pixels off by more than 2 of 255"},
    {"pixels_above_32", &Difference::above_32, &Limits::above_32, Measure::Same::below, "pixels off by more than 32 of 255"},
    {"largest", &Difference::largest, nullptr, Measure::Same::below, "largest difference of a channel, of 255"},
    {"rms", &Difference::rms, &Limits::rms, Measure::Same::below, "root mean square of all channels, of 255"},
    {"psnr_dB", &Difference::psnr_dB, &Limits::psnr_dB, Measure::Same::above, "peak signal-to-noise ratio"},
    {"ssim", &Difference::ssim, &Limits::ssim, Measure::Same::above, "structural similarity"},
    {"perceptual_mean", &Difference::perceptual_mean, &Limits::perceptual_mean, Measure::Same::below,
     "what an eye notices, 0..1, mean"},
    {"perceptual_worst", &Difference::perceptual_worst, &Limits::perceptual_worst, Measure::Same::below,
     "what an eye notices, 0..1, at its worst place"},
};

/// The largest difference of a pixel's channels.
int pixel_difference(const Image& a, const Image& b, std::size_t pixel) {
  int largest = 0;
  for (std::size_t i = pixel * kChannels; i < (pixel + 1) * kChannels; ++i)
    largest = std::max(largest, std::abs(a.rgba[i] - b.rgba[i]));
  return largest;
}

/// Calls `visit(first byte of the pixel)` for every pixel under a mask.
template <typename Visit>
void under_masks(const Image& image, std::span<const Mask> masks, Visit visit) {
  for (const Mask& mask : masks)
    for (int y = std::max(mask.top, 0); y < std::min(mask.top + mask.height, image.height); ++y)
      for (int x = std::max(mask.left, 0); x < std::min(mask.left + mask.width, image.width); ++x)
        visit(kChannels * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x)));
}

/// b with a's pixels where a mask lies: no filter then sees an edge that is not in both.
Image equal_under_masks(const Image& a, const Image& b, std::span<const Mask> masks) {
  Image out = b;
  under_masks(a, masks, [&](std::size_t at) { std::copy_n(&a.rgba[at], kChannels, &out.rgba[at]); });
  return out;
}

Difference difference_of_whole(const Image& a, const Image& b) {
  Difference out;
  const std::size_t pixels = static_cast<std::size_t>(a.width) * static_cast<std::size_t>(a.height);
  double above_2 = 0, squares = 0;
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    const int difference = pixel_difference(a, b, pixel);
    if (difference == 0) continue;
    ++out.differing;
    above_2 += difference > 2;
    out.above_32 += difference > 32;
    out.largest = std::max<double>(out.largest, difference);
    for (std::size_t i = pixel * kChannels; i < (pixel + 1) * kChannels; ++i) squares += std::pow(a.rgba[i] - b.rgba[i], 2);
  }
  out.share_above_2 = pixels > 0 ? above_2 / static_cast<double>(pixels) : 0;
  out.rms = pixels > 0 ? std::sqrt(squares / static_cast<double>(pixels * kChannels)) : 0;
  out.psnr_dB = out.rms > 0 ? 20 * std::log10(255 / out.rms) : std::numeric_limits<double>::infinity();
  if (out.differing == 0) return out;  // what the filters would say is known

  out.ssim = ssim(a, b);
  double sum = 0;
  for (const float value : perceptual_difference(a, b).values) {
    sum += static_cast<double>(value);
    out.perceptual_worst = std::max(out.perceptual_worst, static_cast<double>(value));
  }
  out.perceptual_mean = sum / static_cast<double>(pixels);
  return out;
}

}  // namespace

std::span<const Measure> measures() {
  return kMeasures;
}

Difference difference_of(const Image& a, const Image& b, std::span<const Mask> masks) {
  assert(a.width == b.width && a.height == b.height && "only pictures of one size can be compared");
  return masks.empty() ? difference_of_whole(a, b) : difference_of_whole(a, equal_under_masks(a, b, masks));
}

std::vector<const Measure*> beyond(const Difference& found, const Limits& limits) {
  std::vector<const Measure*> out;
  for (const Measure& measure : kMeasures) {
    if (measure.limit == nullptr) continue;
    const double value = found.*measure.value, limit = limits.*measure.limit;
    if (measure.same == Measure::Same::below ? !(value <= limit) : !(value >= limit)) out.push_back(&measure);
  }
  return out;
}

bool within(const Difference& found, const Limits& limits) {
  return beyond(found, limits).empty();
}

Image difference_picture(const Image& a, const Image& whole_b, std::span<const Mask> masks) {
  assert(a.width == whole_b.width && a.height == whole_b.height && "only pictures of one size can be compared");
  const Image b = equal_under_masks(a, whole_b, masks);
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
  under_masks(out, masks, [&out](std::size_t at) { out.rgba[at + 2] = std::max(out.rgba[at + 2], kMaskBlue); });
  return out;
}

Image side_by_side(std::span<const Image> pictures) {
  constexpr int kGap = 4;  // [pixels]
  constexpr std::uint8_t kGrey = 128;
  Image out;
  for (const Image& picture : pictures) {
    out.width += picture.width + (out.width > 0 ? kGap : 0);
    out.height = std::max(out.height, picture.height);
  }
  out.rgba.assign(static_cast<std::size_t>(kChannels) * static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height),
                  kGrey);
  for (std::size_t i = 3; i < out.rgba.size(); i += kChannels) out.rgba[i] = 255;
  int left = 0;
  for (const Image& picture : pictures) {
    for (int y = 0; y < picture.height; ++y) {
      const std::size_t from = static_cast<std::size_t>(kChannels * y) * static_cast<std::size_t>(picture.width);
      const std::size_t to =
          kChannels * (static_cast<std::size_t>(y) * static_cast<std::size_t>(out.width) + static_cast<std::size_t>(left));
      std::copy_n(&picture.rgba[from], static_cast<std::size_t>(kChannels * picture.width), &out.rgba[to]);
    }
    left += picture.width + kGap;
  }
  return out;
}

}  // namespace render
