#include "assets/generate/car_shape.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace assets {
namespace {

/// Half width at the widest height: blunt, rounded ends in plan.
double half_width(const CarShape& c, double x) {
  const double s = x > 0 ? x / c.front : x / c.rear;
  const double p = x > 0 ? c.nose : c.tail;
  const double round = std::pow(std::max(0.0, 1 - std::pow(s, p)), 0.42);
  return c.half_width * round * (1 - 0.035 * s * s);
}

/// Point of the half section at x, t from 0 (bottom, middle) to 1 (top, middle). `rising`: it never turns down on its way up.
V3 section(const CarShape& shape, double x, double t, bool rising = false) {
  const double w = half_width(shape, x), zu = through(shape.underside, x), zt = through(shape.top, x);
  const double zs = std::min(through(shape.shoulder, x), zt - 0.015);
  const double cabin = std::clamp((zt - zs - 0.05) / 0.42, 0.0, 1.0);
  const double rail = w * 0.93 + cabin * (shape.roof_half - 0.93 * shape.half_width);
  const double zr = zt - 0.012 - 0.05 * cabin;
  const double mid = std::min(shape.waist, 0.5 * (zu + zs) + 0.1);
  std::array<std::array<double, 2>, 11> c{{{0, zu},
                                           {0.55 * w, zu},
                                           {0.90 * w, zu + 0.005},
                                           {0.955 * w, zu + 0.09},
                                           {1.0 * w, mid - 0.10},
                                           {1.012 * w, mid + 0.06},
                                           {0.992 * w, zs - 0.035},
                                           {0.945 * w, zs + 0.012},
                                           {rail, zr - 0.02},
                                           {0.80 * rail, zt - 0.004},
                                           {0, zt + 0.012 * (1 - cabin)}}};
  if (rising)
    for (std::size_t k = c.size() - 1; k-- > 0;) c[k][1] = std::min(c[k][1], c[k + 1][1] - (k > 2 ? 0.004 : 0));
  // uniform cubic B-spline, reflected at both ends so that it meets the middle plane squarely
  const int last = static_cast<int>(c.size()) - 1;
  auto control = [&](int i) -> std::array<double, 2> {
    if (i < 0) return {-c[static_cast<std::size_t>(-i)][0], c[static_cast<std::size_t>(-i)][1]};
    if (i > last) return {-c[static_cast<std::size_t>(2 * last - i)][0], c[static_cast<std::size_t>(2 * last - i)][1]};
    return c[static_cast<std::size_t>(i)];
  };
  const double u = t * last;
  const int i = std::min(static_cast<int>(u), last - 1);
  const double s = u - i;
  const double b[4] = {(1 - s) * (1 - s) * (1 - s) / 6, (3 * s * s * s - 6 * s * s + 4) / 6,
                       (-3 * s * s * s + 3 * s * s + 3 * s + 1) / 6, s * s * s / 6};
  double y = 0, z = 0;
  for (int k = 0; k < 4; ++k) {
    y += b[k] * control(i - 1 + k)[0];
    z += b[k] * control(i - 1 + k)[1];
  }
  return {x, std::max(0.0, y), z};
}

/// Station places, close together at the ends where the plan is round.
double station(const CarShape& c, double s) {
  const double x = 0.5 * (c.front + c.rear) + 0.5 * (c.front - c.rear) * (0.35 * s + 0.65 * std::sin(0.5 * std::numbers::pi * s));
  return std::clamp(x, c.rear, c.front);
}

}  // namespace

Surface half_skin(const CarShape& shape, int stations, int around, Folds folds) {
  auto at = [&](int i, int k) {
    return section(shape, station(shape, 2.0 * i / stations - 1), static_cast<double>(k) / around, folds == Folds::none);
  };
  auto normal = [&](int i, int k) {
    const double s = std::clamp(2.0 * i / stations - 1, -0.9995, 0.9995), t = static_cast<double>(k) / around;
    const double e = 2e-4;
    const V3 along = section(shape, station(shape, s + e), t) - section(shape, station(shape, s - e), t);
    V3 up = section(shape, station(shape, s), std::min(1.0, t + e)) - section(shape, station(shape, s), std::max(0.0, t - e));
    V3 n = cross(up, along);
    if (k == 0 || k == around) n.y = 0;
    if (dot(n, n) < 1e-22) n = {s, 0, 0};
    return unit(n);
  };
  Surface out;
  auto add = [&](const Vertex& a, const Vertex& b, const Vertex& c) {
    const bool in_middle_plane = a.p.y == 0 && b.p.y == 0 && c.p.y == 0;  // of no area, and its mirror image on top of it
    if (folds == Folds::hidden || !in_middle_plane) out.add(a, b, c, "paint");
  };
  for (int i = 0; i < stations; ++i)
    for (int k = 0; k < around; ++k) {
      const Vertex a{at(i, k), normal(i, k)}, b{at(i + 1, k), normal(i + 1, k)}, c{at(i + 1, k + 1), normal(i + 1, k + 1)},
          d{at(i, k + 1), normal(i, k + 1)};
      add(a, c, b);
      add(a, d, c);
    }
  return out;
}

}  // namespace assets
