// How much of a difference an eye notices that looks at two pictures in turn.
#pragma once

#include "render/image/image.h"
#include "render/image/plane.h"

namespace render {

/// A screen of 0.7 m and 3840 pixels seen from 0.7 m.
constexpr double kPixelsPerDegree = 67.02;

/// Perceived difference of each pixel, 0 (none) to 1 (largest there is). Pictures of different size assert. Alpha is not looked at.
/// Source: written from the description in Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astroem, Fairchild, FLIP: A Difference
/// Evaluator for Alternating Images, Proc. ACM Comput. Graph. Interact. Tech. (HPG) 3(2), 2020.
Plane perceptual_difference(const Image& a, const Image& b, double pixels_per_degree = kPixelsPerDegree);

}  // namespace render
