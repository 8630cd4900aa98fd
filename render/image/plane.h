// One channel of a picture as numbers, and the separable filters that both measures of likeness are made of.
#pragma once

#include <cstddef>
#include <vector>

namespace render {

/// Rows top-down, no padding.
struct Plane {
  int width = 0;
  int height = 0;
  std::vector<float> values;

  Plane(int w, int h) : width(w), height(h), values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
  float& at(int x, int y) {
    return values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
  float at(int x, int y) const {
    return values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
};

/// Weights at -radius .. radius: an odd number of them.
using Kernel = std::vector<float>;

/// exp(-x^2 / (2 sigma^2)) at whole pixels up to three sigma, not normalised. `sigma` in pixels.
Kernel gaussian(double sigma);
Kernel gaussian(double sigma, int radius);
/// The same with weights that sum to one.
Kernel normalised(Kernel);

/// `across` along x, then `down` along y. Beyond its edge the picture goes on with its edge's value.
Plane filtered(const Plane&, const Kernel& across, const Kernel& down);

}  // namespace render
