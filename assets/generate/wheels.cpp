#include "assets/generate/wheels.h"

#include <cmath>
#include <numbers>

namespace assets {

namespace {

using Profile = std::vector<std::array<double, 2>>;  // radius, y; the outside on the left

void ring(Surface& s, const Profile& profile, int n, const std::string& material) {
  for (std::size_t k = 0; k + 1 < profile.size(); ++k)
    for (int i = 0; i < n; ++i) {
      auto at = [&](std::size_t p, int j) {
        const double a = 2 * std::numbers::pi * j / n;
        return V3{profile[p][0] * std::cos(a), profile[p][1], profile[p][0] * std::sin(a)};
      };
      const double dr = profile[k + 1][0] - profile[k][0], dy = profile[k + 1][1] - profile[k][1], l = std::hypot(dr, dy);
      auto vertex = [&](std::size_t p, int j) {
        const double a = 2 * std::numbers::pi * j / n;
        return Vertex{at(p, j), {-dy / l * std::cos(a), dr / l, -dy / l * std::sin(a)}};
      };
      s.add(vertex(k, i), vertex(k + 1, i), vertex(k + 1, i + 1), material);
      s.add(vertex(k, i), vertex(k + 1, i + 1), vertex(k, i + 1), material);
    }
}

}  // namespace

Surface wheel(double R, double half, double rim) {
  Surface s;
  ring(s, {{rim, -0.88 * half}, {R - 0.05, -half}, {R - 0.022, -0.97 * half}, {R - 0.004, -0.80 * half}, {R, -0.5 * half}}, 56,
       "tyre");
  for (const double y : {-0.5, -0.05, 0.40})  // tread with two grooves
    ring(s,
         {{R, y * half},
          {R, (y + 0.38) * half},
          {R - 0.008, (y + 0.385) * half},
          {R - 0.008, (y + 0.445) * half},
          {R, (y + 0.45) * half}},
         56, "tyre");
  ring(s, {{R, 0.85 * half}, {R - 0.004, 0.88 * half}, {R - 0.022, 0.97 * half}, {R - 0.05, half}, {rim, 0.88 * half}}, 56, "tyre");
  ring(s, {{rim, 0.88 * half}, {rim - 0.012, 0.84 * half}, {rim - 0.02, 0.55 * half}, {rim - 0.022, -0.85 * half}}, 56, "rim");
  ring(s, {{rim - 0.07, 0.05 * half}, {0.05, 0.05 * half}}, 40, "brake_disc");
  ring(s, {{0.062, 0.30 * half}, {0.058, 0.68 * half}, {0.001, 0.72 * half}}, 30, "rim");
  for (int k = 0; k < 5; ++k) {  // five double spokes
    for (const double twin : {-0.13, 0.13}) {
      const double a = 2 * std::numbers::pi * k / 5 + twin;
      const V3 out{std::cos(a), 0, std::sin(a)}, across{-std::sin(a), 0, std::cos(a)};
      auto at = [&](double r, double w, double y) { return r * out + w * across + V3{0, y * half, 0}; };
      const double r0 = 0.045, r1 = rim - 0.014, w0 = 0.014, w1 = 0.011;
      s.quad(at(r0, -w0, 0.66), at(r0, w0, 0.66), at(r1, w1, 0.80), at(r1, -w1, 0.80), "rim");
      s.quad(at(r0, w0, 0.66), at(r0, w0, 0.35), at(r1, w1, 0.45), at(r1, w1, 0.80), "rim");
      s.quad(at(r0, -w0, 0.35), at(r0, -w0, 0.66), at(r1, -w1, 0.80), at(r1, -w1, 0.45), "rim");
    }
  }
  ring(s, {{rim - 0.02, -0.80 * half}, {0.001, -0.80 * half}}, 30, "brake_disc");
  return s;
}

Surface heavy_wheel(double R, double half, double rim, Rim kind) {
  Surface s;
  const int n = 64;
  const double width = kind == Rim::twin ? 0.45 * half : half;  // half width of one tyre
  for (const double y : kind == Rim::twin ? std::vector<double>{half - width, width - half} : std::vector<double>{0}) {
    ring(s,
         {{rim, y - 0.86 * width},
          {rim + 0.05, y - width},
          {R - 0.05, y - width},
          {R - 0.012, y - 0.88 * width},
          {R, y - 0.74 * width}},
         n, "tyre");
    for (const double g : {-0.74, -0.34, 0.06, 0.46}) {  // tread with grooves
      const double from = y + g * width, to = y + (g + 0.28) * width, w = 0.12 * width;
      ring(s, {{R, from}, {R, to - 0.0}, {R - 0.014, to + 0.1 * w}, {R - 0.014, to + 0.9 * w}, {R, to + w}}, n, "tyre");
    }
    ring(s,
         {{R, y + 0.86 * width},
          {R - 0.012, y + 0.92 * width},
          {R - 0.05, y + width},
          {rim + 0.05, y + width},
          {rim, y + 0.86 * width}},
         n, "tyre");
  }
  // the front wheel's disc stands out, that of twins lies deep inside
  const double outer = half - 0.14 * width, disc = kind == Rim::twin ? half - 1.9 * width : half - 0.25 * width;
  ring(s, {{rim, outer}, {rim - 0.012, outer}, {rim - 0.02, disc}}, n, "rim");
  ring(s, {{rim - 0.02, disc}, {0.62 * rim, disc + 0.02}, {0.55 * rim, disc + 0.05}}, n, "rim");
  ring(s, {{0.55 * rim, disc + 0.05}, {0.42 * rim, disc + 0.05}}, 32, "rim");
  ring(s, {{0.42 * rim, disc + 0.05}, {0.40 * rim, disc + 0.11}, {0.30 * rim, disc + 0.13}, {0.001, disc + 0.135}}, 32, "hub");
  ring(s, {{rim, -outer}, {0.001, -outer}}, 32, "hub");
  for (int k = 0; k < 10; ++k) {  // nuts, and holes between the rim and them
    const double a = 2 * std::numbers::pi * k / 10;
    s.box({0.485 * rim * std::cos(a), disc + 0.06, 0.485 * rim * std::sin(a)}, {0.012, 0.018, 0.012}, "hub");
    const double b = a + std::numbers::pi / 10, r = 0.80 * rim;
    if (k % 2 == 0) continue;
    const V3 out{std::cos(b), 0, std::sin(b)}, across{-std::sin(b), 0, std::cos(b)};
    const double y = disc + 0.0125;
    s.quad(r * out - 0.035 * across + V3{0, y, 0} - 0.03 * out, r * out + 0.035 * across + V3{0, y, 0} - 0.03 * out,
           r * out + 0.035 * across + V3{0, y, 0} + 0.03 * out, r * out - 0.035 * across + V3{0, y, 0} + 0.03 * out, "hub");
  }
  return s;
}

std::vector<Paint> wheel_paints() {
  return {{"tyre", {0.022, 0.022, 0.024}},
          {"rim", {0.55, 0.56, 0.58}},
          {"brake_disc", {0.16, 0.15, 0.15}},
          {"hub", {0.10, 0.10, 0.105}}};
}

}  // namespace assets
