#include "assets/generate/car.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace assets {
namespace {

constexpr double kFront = 2.27, kRear = -2.37;  // [m] ends of the car
constexpr double kHalfWidth = 0.905;
constexpr double kAxle = 1.35;   // front axle at +, rear at -
constexpr double kArch = 0.375;  // radius of the wheel openings
constexpr double kHub = 0.31;    // height of the wheel centres

/// Smooth curve through points (x ascending): Fritsch-Carlson monotone cubic, so that it never overshoots.
double through(const std::vector<std::array<double, 2>>& k, double x) {
  if (x <= k.front()[0]) return k.front()[1];
  if (x >= k.back()[0]) return k.back()[1];
  const std::size_t n = k.size();
  std::vector<double> slope(n, 0), chord(n - 1, 0);
  for (std::size_t i = 0; i + 1 < n; ++i) chord[i] = (k[i + 1][1] - k[i][1]) / (k[i + 1][0] - k[i][0]);
  slope[0] = chord[0];
  slope[n - 1] = chord[n - 2];
  for (std::size_t i = 1; i + 1 < n; ++i)
    slope[i] = chord[i - 1] * chord[i] <= 0 ? 0 : 2 * chord[i - 1] * chord[i] / (chord[i - 1] + chord[i]);
  std::size_t i = 0;
  while (x > k[i + 1][0]) ++i;
  const double h = k[i + 1][0] - k[i][0], s = (x - k[i][0]) / h;
  return (2 * s * s * s - 3 * s * s + 1) * k[i][1] + (s * s * s - 2 * s * s + s) * h * slope[i] +
         (-2 * s * s * s + 3 * s * s) * k[i + 1][1] + (s * s * s - s * s) * h * slope[i + 1];
}

// the side view: outline over the middle, shoulder line, underside
double top(double x) {
  return through({{kRear, 0.80},
                  {-2.31, 0.97},
                  {-2.22, 1.035},
                  {-1.78, 1.075},
                  {-1.62, 1.10},
                  {-0.98, 1.345},
                  {-0.62, 1.415},
                  {-0.20, 1.445},
                  {0.10, 1.425},
                  {0.34, 1.365},
                  {1.02, 0.985},
                  {1.16, 0.945},
                  {1.60, 0.875},
                  {2.02, 0.775},
                  {2.17, 0.70},
                  {kFront, 0.56}},
                 x);
}
double shoulder(double x) {
  const double line = through(
      {{kRear, 0.76}, {-2.20, 0.93}, {-1.5, 0.96}, {0.0, 0.915}, {1.0, 0.865}, {1.7, 0.775}, {2.1, 0.67}, {kFront, 0.53}}, x);
  return std::min(line, top(x) - 0.015);
}
double underside(double x) {
  return through({{kRear, 0.36}, {-2.15, 0.25}, {-1.2, 0.185}, {1.4, 0.185}, {2.1, 0.20}, {kFront, 0.28}}, x);
}

/// Half width at the widest height: blunt, rounded ends in plan.
double half_width(double x) {
  const double s = x > 0 ? x / kFront : x / kRear;
  const double p = x > 0 ? 5.0 : 6.0;
  const double round = std::pow(std::max(0.0, 1 - std::pow(s, p)), 0.42);
  return kHalfWidth * round * (1 - 0.035 * s * s);
}

/// Point of the half section at x, t from 0 (bottom, middle) to 1 (top, middle).
V3 section(double x, double t) {
  const double w = half_width(x), zu = underside(x), zs = shoulder(x), zt = top(x);
  const double cabin = std::clamp((zt - zs - 0.05) / 0.42, 0.0, 1.0);
  const double rail = w * 0.93 + cabin * (0.615 - 0.93 * kHalfWidth);
  const double zr = zt - 0.012 - 0.05 * cabin;
  const double mid = std::min(0.60, 0.5 * (zu + zs) + 0.1);
  const std::array<std::array<double, 2>, 11> c{{{0, zu},
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
double station(double s) {
  const double x = 0.5 * (kFront + kRear) + 0.5 * (kFront - kRear) * (0.35 * s + 0.65 * std::sin(0.5 * std::numbers::pi * s));
  return std::clamp(x, kRear, kFront);
}

/// Half of the outer skin, y >= 0.
Surface half_skin(int stations, int around) {
  auto at = [&](int i, int k) { return section(station(2.0 * i / stations - 1), static_cast<double>(k) / around); };
  auto normal = [&](int i, int k) {
    const double s = std::clamp(2.0 * i / stations - 1, -0.9995, 0.9995), t = static_cast<double>(k) / around;
    const double e = 2e-4;
    const V3 along = section(station(s + e), t) - section(station(s - e), t);
    V3 up = section(station(s), std::min(1.0, t + e)) - section(station(s), std::max(0.0, t - e));
    V3 n = cross(up, along);
    if (k == 0 || k == around) n.y = 0;
    if (dot(n, n) < 1e-22) n = {s, 0, 0};
    return unit(n);
  };
  Surface out;
  for (int i = 0; i < stations; ++i)
    for (int k = 0; k < around; ++k) {
      const Vertex a{at(i, k), normal(i, k)}, b{at(i + 1, k), normal(i + 1, k)}, c{at(i + 1, k + 1), normal(i + 1, k + 1)},
          d{at(i, k + 1), normal(i, k + 1)};
      out.add(a, c, b, "paint");
      out.add(a, d, c, "paint");
    }
  return out;
}

std::vector<std::array<double, 2>> circle(double x, double z, double r, int n) {
  std::vector<std::array<double, 2>> out;
  for (int i = 0; i < n; ++i) {
    const double a = 2 * std::numbers::pi * i / n;
    out.push_back({x + r * std::cos(a), z + r * std::sin(a)});
  }
  return out;
}

bool on_side(const V3& p, const V3& n) {
  return n.y > 0.3 && p.y > 0.4;
}

void cut_windows(Surface& s) {
  const Filter side = [](const V3& p, const V3& n) { return n.y > 0.35 && p.z > 0.85; };
  const std::vector<std::array<double, 2>> front_door{{-0.215, 0.955}, {0.80, 0.93}, {0.36, 1.285}, {0.10, 1.355}, {-0.215, 1.372}};
  const std::vector<std::array<double, 2>> rear_door{
      {-1.14, 0.99}, {-0.285, 0.957}, {-0.285, 1.372}, {-0.62, 1.348}, {-0.86, 1.293}};
  const std::vector<std::array<double, 2>> quarter{{-1.45, 1.015}, {-1.185, 0.994}, {-0.905, 1.280}, {-0.985, 1.255}};
  // a black surround first, then the pane in it
  auto framed = [&](const std::vector<std::array<double, 2>>& pane) {
    double cx = 0, cz = 0;
    for (auto& p : pane) cx += p[0] / static_cast<double>(pane.size()), cz += p[1] / static_cast<double>(pane.size());
    std::vector<std::array<double, 2>> rim;
    for (auto& p : pane) {
      const double l = std::hypot(p[0] - cx, p[1] - cz);
      rim.push_back({p[0] + 0.026 * (p[0] - cx) / l, p[1] + 0.026 * (p[1] - cz) / l});
    }
    cut(s, Seen::from_side, rim, side, "trim");
    cut(s, Seen::from_side, pane, side, "glass");
  };
  framed(front_door);
  framed(rear_door);
  framed(quarter);
  // windscreen and rear window, seen from above; the upper surface only
  const Filter above = [](const V3& p, const V3& n) { return n.z > 0.25 && p.z > 0.90; };
  cut(s, Seen::from_above, {{0.30, -1}, {1.05, -1}, {1.05, 0.70}, {0.985, 0.745}, {0.30, 0.575}}, above, "trim");
  cut(s, Seen::from_above, {{0.335, -1}, {1.005, -1}, {0.985, 0.66}, {0.945, 0.70}, {0.335, 0.545}}, above, "glass");
  cut(s, Seen::from_above, {{-1.63, -1}, {-0.90, -1}, {-0.90, 0.545}, {-1.63, 0.665}}, above, "trim");
  cut(s, Seen::from_above, {{-1.595, -1}, {-0.935, -1}, {-0.935, 0.52}, {-1.595, 0.63}}, above, "glass");
}

void cut_seams(Surface& s) {
  auto seam = [&](double x0, double z0, double x1, double z1) {
    const double l = std::hypot(x1 - x0, z1 - z0), h = 0.0035;
    const double nx = -(z1 - z0) / l * h, nz = (x1 - x0) / l * h;
    cut(s, Seen::from_side, {{x0 - nx, z0 - nz}, {x1 - nx, z1 - nz}, {x1 + nx, z1 + nz}, {x0 + nx, z0 + nz}}, on_side, "trim");
  };
  seam(0.94, 0.33, 0.90, 0.87);     // front door's leading edge
  seam(-0.25, 0.28, -0.25, 0.95);   // between the doors
  seam(-0.88, 0.62, -1.20, 0.965);  // rear door over the arch
  seam(0.94, 0.30, -0.86, 0.30);    // along the sill
  seam(1.92, 0.42, 1.60, 0.76);     // front bumper and wing
  seam(-1.86, 0.40, -2.12, 0.80);   // rear bumper
  const Filter above = [](const V3& p, const V3& n) { return n.z > 0.5 && p.z > 0.6; };
  for (const double x : {1.075, -1.74})
    cut(s, Seen::from_above, {{x, -1}, {x + 0.007, -1}, {x + 0.007, 0.74}, {x, 0.74}}, above, "trim");
  cut(s, Seen::from_above, {{1.075, 0.735}, {2.08, 0.640}, {2.08, 0.646}, {1.075, 0.742}}, above, "trim");  // bonnet's side
  cut(s, Seen::from_above, {{-2.23, 0.66}, {-1.74, 0.72}, {-1.74, 0.727}, {-2.23, 0.667}}, above, "trim");  // boot lid's side
  for (const double x : {0.10, -0.93})                                                                      // door handles
    cut(s, Seen::from_side, {{x - 0.09, 0.828}, {x + 0.09, 0.822}, {x + 0.09, 0.846}, {x - 0.09, 0.852}}, on_side, "chrome");
}

void cut_ends(Surface& s) {
  const Filter front = [](const V3& p, const V3& n) { return p.x > 1.70 && n.z < 0.93 && n.x > -0.1; };
  cut(s, Seen::from_front, {{0.50, 0.60}, {0.66, 0.585}, {0.86, 0.655}, {0.86, 0.735}, {0.70, 0.715}, {0.50, 0.665}}, front,
      "lamp_front");
  const Filter nose = [](const V3& p, const V3& n) { return p.x > 2.0 && n.x > 0.2; };
  cut(s, Seen::from_front, {{-1, 0.50}, {0.46, 0.50}, {0.42, 0.64}, {-1, 0.66}}, nose, "trim");
  for (const double z : {0.535, 0.575, 0.615})
    cut(s, Seen::from_front, {{-1, z}, {0.43, z}, {0.43, z + 0.009}, {-1, z + 0.009}}, nose, "chrome");
  cut(s, Seen::from_front, {{-1, 0.30}, {0.52, 0.30}, {0.46, 0.405}, {-1, 0.405}}, nose, "trim");
  cut(s, Seen::from_front, {{0.58, 0.325}, {0.78, 0.34}, {0.76, 0.405}, {0.60, 0.395}}, front, "trim");
  cut(s, Seen::from_front, {{0.63, 0.345}, {0.72, 0.35}, {0.71, 0.39}, {0.64, 0.385}}, front, "lamp_front");
  cut(s, Seen::from_front, {{-1, 0.42}, {0.26, 0.42}, {0.26, 0.49}, {-1, 0.49}}, nose, "plate");
  const Filter tail = [](const V3& p, const V3& n) { return p.x < -1.85 && n.z < 0.9 && n.x < 0.15; };
  cut(s, Seen::from_front, {{0.50, 0.74}, {0.90, 0.74}, {0.90, 0.90}, {0.54, 0.885}}, tail, "lamp_rear");
  cut(s, Seen::from_front, {{-1, 0.60}, {0.26, 0.60}, {0.26, 0.69}, {-1, 0.69}}, tail, "plate");
  cut(s, Seen::from_front, {{-1, 0.30}, {0.62, 0.30}, {0.58, 0.40}, {-1, 0.40}}, tail, "trim");
}

void cut_arches(Surface& s) {
  const Filter side = [](const V3& p, const V3&) { return p.y > 0.45; };
  for (const double x : {kAxle, -kAxle}) {
    cut(s, Seen::from_side, circle(x, kHub, kArch + 0.022, 40), on_side, "trim");
    cut(s, Seen::from_side, circle(x, kHub, kArch, 40), side, "");
    // the well: a dark tunnel behind the opening
    const int n = 28;
    for (int i = 0; i < n; ++i) {
      const double a = std::numbers::pi * (1.15 * i / n - 0.075), b = std::numbers::pi * (1.15 * (i + 1) / n - 0.075);
      const V3 pa{x + kArch * std::cos(a), 0, kHub + kArch * std::sin(a)},
          pb{x + kArch * std::cos(b), 0, kHub + kArch * std::sin(b)};
      auto deep = [](V3 p, double y) { return V3{p.x, y, p.z}; };
      s.quad(deep(pa, 0.86), deep(pa, 0.5), deep(pb, 0.5), deep(pb, 0.86), "underbody");
      s.quad(deep(pa, 0.5), {x, 0.5, kHub}, {x, 0.5, kHub}, deep(pb, 0.5), "underbody");
      s.add({{x, 0.5, kHub}, {0, 1, 0}}, {deep(pb, 0.5), {0, 1, 0}}, {deep(pa, 0.5), {0, 1, 0}}, "underbody");
    }
  }
  const Filter below = [](const V3& p, const V3& n) { return n.z < -0.6 || p.z < 0.215; };
  cut(s, Seen::from_above, {{-3, -1}, {3, -1}, {3, 2}, {-3, 2}}, below, "underbody");
}

/// A ball squashed to an egg, for mirrors.
Surface egg(V3 m, V3 r, const std::string& material) {
  Surface out;
  const int n = 14;
  auto at = [&](int i, int j) {
    const double a = std::numbers::pi * i / n, b = 2 * std::numbers::pi * j / n;
    const V3 d{std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)};
    return Vertex{m + V3{r.x * d.x, r.y * d.y, r.z * d.z}, unit({d.x / r.x, d.y / r.y, d.z / r.z})};
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      out.add(at(i, j), at(i + 1, j), at(i + 1, j + 1), material);
      out.add(at(i, j), at(i + 1, j + 1), at(i, j + 1), material);
    }
  return out;
}

Surface interior() {
  Surface s;
  s.box({0.78, 0, 0.84}, {0.22, 0.68, 0.10}, "interior", -0.15);  // dashboard
  for (const double y : {0.36, -0.36}) {
    s.box({0.02, y, 0.55}, {0.26, 0.24, 0.09}, "interior", -0.10);
    s.box({-0.26, y, 0.84}, {0.07, 0.23, 0.30}, "interior", -0.32);
    s.box({-0.38, y, 1.18}, {0.045, 0.12, 0.085}, "interior", -0.2);  // head rest
  }
  s.box({-0.90, 0, 0.55}, {0.26, 0.60, 0.09}, "interior", -0.1);
  s.box({-1.20, 0, 0.83}, {0.07, 0.60, 0.27}, "interior", -0.40);
  s.box({-1.48, 0, 1.03}, {0.22, 0.60, 0.02}, "interior");
  const int n = 20;  // steering wheel
  for (int i = 0; i < n; ++i) {
    auto rim = [&](int k, double r) {
      const double a = 2 * std::numbers::pi * k / n;
      return V3{0.42 + 0.42 * r * std::sin(a), 0.36 + r * std::cos(a), 0.93 + 0.90 * r * std::sin(a)};
    };
    s.quad(rim(i, 0.19), rim(i + 1, 0.19), rim(i + 1, 0.155), rim(i, 0.155), "interior");
  }
  return s;
}

}  // namespace

Surface bodywork() {
  Surface s = half_skin(110, 60);
  cut_arches(s);
  cut_windows(s);
  cut_ends(s);
  cut_seams(s);
  s.append(egg({0.74, 0.985, 1.0}, {0.065, 0.115, 0.075}, "paint"));
  s.box({0.76, 0.86, 0.955}, {0.035, 0.06, 0.018}, "trim");
  s.box({0.98, 0.30, 1.012}, {0.012, 0.28, 0.008}, "trim", 0.5);  // wiper
  s.mirror_y();
  s.append(interior());
  return s;
}

Surface shell() {
  Surface s = half_skin(40, 22);
  s.mirror_y();
  return s;
}

Surface wheel() {
  Surface s;
  const double R = 0.31, half = 0.10, rim = 0.215;
  auto ring = [&](const std::vector<std::array<double, 2>>& profile, int n,
                  const std::string& material) {  // (r, y), outside on the left
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
  };
  ring({{rim, -0.88 * half}, {0.26, -half}, {R - 0.022, -0.97 * half}, {R - 0.004, -0.80 * half}, {R, -0.5 * half}}, 56, "tyre");
  for (const double y : {-0.5, -0.05, 0.40})  // tread with two grooves
    ring({{R, y * half},
          {R, (y + 0.38) * half},
          {R - 0.008, (y + 0.385) * half},
          {R - 0.008, (y + 0.445) * half},
          {R, (y + 0.45) * half}},
         56, "tyre");
  ring({{R, 0.85 * half}, {R - 0.004, 0.88 * half}, {R - 0.022, 0.97 * half}, {0.26, half}, {rim, 0.88 * half}}, 56, "tyre");
  ring({{rim, 0.88 * half}, {rim - 0.012, 0.84 * half}, {rim - 0.02, 0.55 * half}, {rim - 0.022, -0.85 * half}}, 56, "rim");
  ring({{0.145, 0.05 * half}, {0.05, 0.05 * half}}, 40, "brake_disc");
  ring({{0.062, 0.30 * half}, {0.058, 0.68 * half}, {0.001, 0.72 * half}}, 30, "rim");
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
  ring({{rim - 0.02, -0.80 * half}, {0.001, -0.80 * half}}, 30, "brake_disc");
  return s;
}

Surface trip_curb() {
  Surface s;
  s.box({0, 0.15, 0.0}, {10, 0.15, 0.15}, "concrete");
  return s;
}

std::vector<Paint> car_paints() {
  return {{"paint", {0.45, 0.02, 0.025}},      {"glass", {0.015, 0.02, 0.022}, 0.80}, {"lamp_front", {0.80, 0.82, 0.85}},
          {"lamp_rear", {0.42, 0.012, 0.012}}, {"trim", {0.018, 0.018, 0.02}},        {"plate", {0.75, 0.75, 0.70}},
          {"chrome", {0.62, 0.62, 0.62}},      {"interior", {0.05, 0.05, 0.055}},     {"underbody", {0.012, 0.012, 0.012}}};
}

std::vector<Paint> wheel_paints() {
  return {{"tyre", {0.022, 0.022, 0.024}}, {"rim", {0.55, 0.56, 0.58}}, {"brake_disc", {0.16, 0.15, 0.15}}};
}

}  // namespace assets
