#include "assets/generate/trailers.h"

#include <cmath>

namespace assets {
namespace {

/// A bar from a to b, w wide and h high, level across.
void bar(Surface& s, V3 a, V3 b, double w, double h, const std::string& material) {
  const V3 along = unit(b - a), side = unit(cross({0, 0, 1}, along)), up = cross(along, side);
  const V3 y = 0.5 * w * side, z = 0.5 * h * up;
  auto at = [](V3 p, V3 q, V3 r) { return p + q + r; };
  const V3 m{0, 0, 0};
  const V3 a0 = at(a, m - y, m - z), a1 = at(a, y, m - z), a2 = at(a, y, z), a3 = at(a, m - y, z);
  const V3 b0 = at(b, m - y, m - z), b1 = at(b, y, m - z), b2 = at(b, y, z), b3 = at(b, m - y, z);
  s.quad(a0, a3, a2, a1, material);
  s.quad(b0, b1, b2, b3, material);
  s.quad(a3, b3, b2, a2, material);
  s.quad(a0, a1, b1, b0, material);
  s.quad(a1, a2, b2, b1, material);
  s.quad(a0, b0, b3, a3, material);
}

/// A mudguard over a wheel of radius r at x, y; half ring.
void mudguard(Surface& s, double x, double y, double z, double r, double width) {
  const int n = 12;
  for (int i = 0; i < n; ++i) {
    auto at = [&](int k, double side) {
      const double a = 3.14159265358979323846 * k / n;
      return V3{x + r * std::cos(a), y + side, z + r * std::sin(a)};
    };
    const double w = 0.5 * width;
    s.quad(at(i, -w), at(i + 1, -w), at(i + 1, w), at(i, w), "trim");
    s.quad(at(i, w), at(i + 1, w), at(i + 1, -w), at(i, -w), "trim");
  }
}

/// An open tray: floor and four boards, x from rear to front.
void tray(Surface& s, double rear, double front, double half, double floor, double height) {
  const double cx = 0.5 * (rear + front), l = 0.5 * (front - rear), t = 0.02;
  s.box({cx, 0, floor}, {l - 2 * t, half - 2 * t, 0.03}, "wood");
  const double middle = floor + 0.5 * height, up = 0.5 * height;
  for (const double side : {-1.0, 1.0}) {
    s.box({cx, side * (half - t), middle}, {l - t, t, up}, "paint");
    s.box({cx + side * (l - t), 0, middle}, {t, half - t, up}, "paint");
    s.box({cx, side * (half - t), floor - 0.01}, {l, 1.3 * t, 0.035}, "steel");
    s.box({cx + side * (l - t), 0, floor - 0.01}, {1.3 * t, half, 0.035}, "steel");
    s.box({cx, side * (half - t), floor + height}, {l, 1.2 * t, 0.012}, "steel");
    s.box({cx + side * (l - t), 0, floor + height}, {1.2 * t, half, 0.012}, "steel");
    for (const double end : {-1.0, 1.0}) s.box({cx + end * (l - t), side * (half - t), middle}, {0.03, 0.03, up + 0.01}, "steel");
    const int posts = static_cast<int>(std::lround(l));
    for (int i = 1; i < 2 * posts; ++i)
      s.box({rear + i * (front - rear) / (2 * posts), side * half, middle}, {0.025, 0.012, up}, "steel");
  }
}

void tail_lamps(Surface& s, double x, double half, double z) {
  for (const double side : {-1.0, 1.0}) s.box({x, side * (half - 0.12), z}, {0.012, 0.09, 0.05}, "lamp_rear");
  s.box({x, 0, z}, {0.008, 0.26, 0.055}, "plate");
}

}  // namespace

Surface car_trailer() {
  Surface s;
  tray(s, -1.25, 1.25, 0.65, 0.56, 0.40);
  for (const double side : {-1.0, 1.0}) {
    bar(s, {1.2, side * 0.5, 0.47}, {2.45, side * 0.04, 0.43}, 0.06, 0.08, "steel");
    bar(s, {-1.25, side * 0.5, 0.48}, {1.25, side * 0.5, 0.48}, 0.06, 0.10, "steel");
    mudguard(s, 0, side * 0.80, 0.29, 0.36, 0.22);
  }
  s.box({0, 0, 0.29}, {0.04, 0.72, 0.04}, "steel");
  s.box({2.52, 0, 0.43}, {0.12, 0.05, 0.05}, "steel");
  s.box({2.1, 0.11, 0.38}, {0.03, 0.03, 0.24}, "steel");  // jockey wheel's post
  tail_lamps(s, -1.275, 0.65, 0.47);
  return s;
}

Surface dolly() {
  Surface s;
  for (const double side : {-1.0, 1.0}) {
    bar(s, {-0.35, side * 0.40, 0.52}, {0.40, side * 0.40, 0.52}, 0.07, 0.10, "steel");
    bar(s, {0.35, side * 0.40, 0.50}, {1.75, side * 0.04, 0.43}, 0.06, 0.08, "steel");
    mudguard(s, 0, side * 0.85, 0.31, 0.38, 0.24);
  }
  s.box({0, 0, 0.31}, {0.045, 0.76, 0.045}, "steel");
  s.box({0, 0, 0.60}, {0.36, 0.42, 0.025}, "steel");
  s.box({1.82, 0, 0.43}, {0.12, 0.05, 0.05}, "steel");
  return s;
}

Surface drawbar_trailer() {
  Surface s;
  tray(s, -1.0, 3.6, 0.95, 0.78, 0.50);
  for (const double side : {-1.0, 1.0}) {
    bar(s, {-1.0, side * 0.55, 0.69}, {3.6, side * 0.55, 0.69}, 0.08, 0.12, "steel");
    bar(s, {-0.35, side * 0.55, 0.60}, {-0.02, side * 0.55, 0.34}, 0.05, 0.06, "steel");
    bar(s, {0.35, side * 0.55, 0.60}, {0.02, side * 0.55, 0.34}, 0.05, 0.06, "steel");
    mudguard(s, 0, side * 0.85, 0.31, 0.38, 0.24);
  }
  s.box({0, 0, 0.31}, {0.045, 0.76, 0.045}, "steel");
  s.box({3.0, 0, 0.66}, {0.30, 0.40, 0.03}, "steel");
  tail_lamps(s, -1.025, 0.95, 0.66);
  return s;
}

std::vector<Paint> trailer_paints() {
  return {{"paint", {0.10, 0.13, 0.17}}, {"wood", {0.30, 0.20, 0.11}},        {"steel", {0.32, 0.33, 0.34}},
          {"trim", {0.02, 0.02, 0.022}}, {"lamp_rear", {0.42, 0.012, 0.012}}, {"plate", {0.75, 0.75, 0.70}}};
}

}  // namespace assets
