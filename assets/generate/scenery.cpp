#include "assets/generate/scenery.h"

#include <array>

namespace assets {

Surface trip_curb() {
  Surface s;
  s.box({0, 0.15, 0.0}, {10, 0.15, 0.15}, "concrete");
  return s;
}

Surface bank() {
  Surface s;
  // the edges are rounded by a chamfer of half a metre, as soil is
  const std::array<std::array<double, 2>, 14> profile{{{-12, 0},
                                                       {-8, 0},
                                                       {-4, 0},
                                                       {-1, 0},
                                                       {-0.3, 0},
                                                       {0.3, -0.2},
                                                       {1.5, -1},
                                                       {3, -2},
                                                       {4.2, -2.8},
                                                       {4.8, -3},
                                                       {8, -3},
                                                       {14, -3},
                                                       {20, -3},
                                                       {28, -3}}};
  for (int i = -10; i < 10; ++i)
    for (std::size_t k = 0; k + 1 < profile.size(); ++k) {
      const auto at = [&](int a, std::size_t b) { return V3{3.0 * a, profile[b][0], profile[b][1]}; };
      s.quad(at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1), "grass");
    }
  return s;
}

}  // namespace assets
