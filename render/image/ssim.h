// Structural similarity of two pictures.
#pragma once

#include "render/image/image.h"

namespace render {

/// Mean over the picture, 1 for equal ones, on luma. Pictures of different size assert.
/// Source: Wang, Bovik, Sheikh, Simoncelli, Image Quality Assessment: From Error Visibility to Structural Similarity, IEEE Trans.
/// Image Processing 13(4), 2004: Gaussian window of 11 x 11, sigma 1.5, K1 = 0.01, K2 = 0.03; windows inside the picture only
/// (where it is at least that large).
double ssim(const Image& a, const Image& b);

}  // namespace render
