// Comparison of two pictures of the same size, and the limits within which they count as the same.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "render/image/image.h"

namespace render {

/// How far two pictures are apart. A pixel's difference is the largest of its channels, 0..255.
struct Difference {
  double differing = 0;         // pixels that are not the same to the bit
  double share_above_2 = 0;     // [-] of all pixels
  double above_32 = 0;          // pixels
  double largest = 0;           // 0..255
  double rms = 0;               // over all channels, 0..255
  double psnr_dB = 0;           // infinite for equal pictures
  double ssim = 1;              // structural similarity, 1 for equal pictures
  double perceptual_mean = 0;   // what an eye notices, 0..1, mean over the picture
  double perceptual_worst = 0;  // and at its worst place
};

/// What the same scene may differ by on another machine: our own kernels round alike everywhere, skid marks and text come from
/// libraries and may change some hundred pixels, mostly by 1. A real change (another way of multisampling) has a PSNR of 47 dB. A
/// largest difference alone says nothing, and what is averaged over the picture misses what is small: a missing arrow, another
/// digit, a limb turned by a degree show at the worst place an eye finds. There a pixel off by 1/255 comes to 0.013, a block of
/// sixteen of them to 0.037; the smallest fault of those in the tests, a 0 for an 8 in a clock five pixels tall, to 0.158.
struct Limits {
  double share_above_2 = 0.005;
  double above_32 = 50;
  double rms = 0.3;
  double psnr_dB = 55;
  double ssim = 0.995;
  double perceptual_mean = 0.01;
  double perceptual_worst = 0.08;
};

/// A figure of the comparison, by the name it has in files and scenes. One line each in the table.
struct Measure {
  const char* name;
  double Difference::*value;
  double Limits::*limit = nullptr;  // none: told, not judged
  enum class Same { below, above } same = Same::below;
  const char* says = "";
};
std::span<const Measure> measures();

/// What is not compared, in pixels from the upper left corner. May reach beyond the picture.
struct Mask {
  int left = 0, top = 0, width = 0, height = 0;
};

/// Pictures of different size assert. What a mask covers counts as equal.
Difference difference_of(const Image& a, const Image& b, std::span<const Mask> = {});
/// The measures beyond their limits; none: the same picture.
std::vector<const Measure*> beyond(const Difference&, const Limits&);
bool within(const Difference&, const Limits&);

/// Where they differ: `a` dimmed to grey, differing pixels from yellow (by one) to red (by 32 and more), masked ones blue.
Image difference_picture(const Image& a, const Image& b, std::span<const Mask> = {});
/// The pictures next to each other, upper edges level, on grey.
Image side_by_side(std::span<const Image> pictures);

}  // namespace render
