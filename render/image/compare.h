// Comparison of two pictures of the same size, and the limits within which they count as the same.
#pragma once

#include "render/image/image.h"

namespace render {

/// How far two pictures are apart. A pixel's difference is the largest of its channels, 0..255.
struct Difference {
  double share_above_2 = 0;  // [-] of all pixels
  long above_32 = 0;         // pixels
  int largest = 0;           // 0..255
  double rms = 0;            // over all channels, 0..255
  double psnr_dB = 0;        // infinite for equal pictures
};

/// What the same scene may differ by on another machine: without fused multiply-add up to 0.28 % of pixels change, another Mesa
/// changes some hundred, mostly by 1. A real change (another way of multisampling) has a PSNR of 47 dB. A largest difference alone
/// says nothing.
struct Limits {
  double share_above_2 = 0.005;
  long above_32 = 50;
  double rms = 0.3;
  double psnr_dB = 55;
};

/// Pictures of different size assert.
Difference difference_of(const Image& a, const Image& b);
bool within(const Difference&, const Limits&);

/// Where they differ: `a` dimmed to grey, differing pixels from yellow (by one) to red (by 32 and more).
Image difference_picture(const Image& a, const Image& b);

}  // namespace render
