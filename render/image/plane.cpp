#include "render/image/plane.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace render {

Kernel gaussian(double sigma, int radius) {
  Kernel out;
  for (int i = -radius; i <= radius; ++i) out.push_back(static_cast<float>(std::exp(-i * i / (2 * sigma * sigma))));
  return out;
}

Kernel gaussian(double sigma) {
  return gaussian(sigma, static_cast<int>(std::ceil(3 * sigma)));
}

Kernel normalised(Kernel kernel) {
  const float sum = std::accumulate(kernel.begin(), kernel.end(), 0.0f);
  for (float& weight : kernel) weight /= sum;
  return kernel;
}

Plane filtered(const Plane& in, const Kernel& across, const Kernel& down) {
  Plane rows(in.width, in.height);
  const int rx = static_cast<int>(across.size() / 2);
  std::vector<float> padded(static_cast<std::size_t>(in.width + 2 * rx));
  for (int y = 0; y < in.height; ++y) {
    // the row with its ends repeated, so that the inner loop asks nothing
    for (int x = -rx; x < in.width + rx; ++x) padded[static_cast<std::size_t>(x + rx)] = in.at(std::clamp(x, 0, in.width - 1), y);
    for (std::size_t k = 0; k < across.size(); ++k)
      for (int x = 0; x < in.width; ++x) rows.at(x, y) += across[k] * padded[static_cast<std::size_t>(x) + k];
  }
  Plane out(in.width, in.height);
  const int ry = static_cast<int>(down.size() / 2);
  for (int y = 0; y < in.height; ++y)
    for (int k = -ry; k <= ry; ++k) {
      const float weight = down[static_cast<std::size_t>(k + ry)];
      const int from = std::clamp(y + k, 0, in.height - 1);
      for (int x = 0; x < in.width; ++x) out.at(x, y) += weight * rows.at(x, from);
    }
  return out;
}

}  // namespace render
