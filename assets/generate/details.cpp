#include "assets/generate/details.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace assets {

Outline circle(double x, double z, double r, int n) {
  Outline out;
  for (int i = 0; i < n; ++i) {
    const double a = 2 * std::numbers::pi * i / n;
    out.push_back({x + r * std::cos(a), z + r * std::sin(a)});
  }
  return out;
}

Outline rectangle(double u0, double v0, double u1, double v1) {
  return {{u0, v0}, {u1, v0}, {u1, v1}, {u0, v1}};
}

bool on_side(const V3& p, const V3& n) {
  return n.y > 0.3 && p.y > 0.4;
}

Filter side_above(double z) {
  return [z](const V3& p, const V3& n) { return n.y > 0.35 && p.z > z; };
}

void framed(Surface& s, Seen seen, const Outline& pane, double surround, const Filter& filter, const std::string& material) {
  double cu = 0, cv = 0;
  for (auto& p : pane) cu += p[0] / static_cast<double>(pane.size()), cv += p[1] / static_cast<double>(pane.size());
  Outline rim;
  for (auto& p : pane) {
    const double l = std::hypot(p[0] - cu, p[1] - cv);
    rim.push_back({p[0] + surround * (p[0] - cu) / l, p[1] + surround * (p[1] - cv) / l});
  }
  cut(s, seen, rim, filter, "trim");
  cut(s, seen, pane, filter, material);
}

void seam(Surface& s, double x0, double z0, double x1, double z1, double width) {
  const double l = std::hypot(x1 - x0, z1 - z0), h = 0.5 * width;
  const double nx = -(z1 - z0) / l * h, nz = (x1 - x0) / l * h;
  cut(s, Seen::from_side, {{x0 - nx, z0 - nz}, {x1 - nx, z1 - nz}, {x1 + nx, z1 + nz}, {x0 + nx, z0 + nz}}, on_side, "trim");
}

namespace {

/// Height of the lowest face straight over or under a place; `otherwise` where there is none.
double lowest(const Surface& s, double x, double y, double otherwise) {
  double least = 1e9;
  for (const Face& f : s.faces) {
    const V3 &a = f.v[0].p, ab = f.v[1].p - a, ac = f.v[2].p - a;
    const double area = ab.x * ac.y - ab.y * ac.x;
    if (std::abs(area) < 1e-12) continue;
    const double u = ((x - a.x) * ac.y - (y - a.y) * ac.x) / area, v = (ab.x * (y - a.y) - ab.y * (x - a.x)) / area;
    if (u >= 0 && v >= 0 && u + v <= 1) least = std::min(least, a.z + u * ab.z + v * ac.z);
  }
  return least < 1e9 ? least : otherwise;
}

}  // namespace

void wheel_arch(Surface& s, double x, double hub, double radius, double outer, double inner) {
  constexpr int kPieces = 28;
  constexpr double kDown = 0.11;   // of half a turn that the tunnel goes on below the hub, to the floor
  constexpr double kLap = 0.15;    // [m] faces of the floor are left out whole: how far in the gap is closed ...
  constexpr double kOver = 0.003;  // [m] ... and over the floor
  const auto on_arch = [&](int i) {
    const double a = std::numbers::pi * ((1 + 2 * kDown) * i / kPieces - kDown);
    return V3{x + radius * std::cos(a), 0, hub + radius * std::sin(a)};
  };
  const auto deep = [](V3 p, double y) { return V3{p.x, y, p.z}; };
  std::array<V3, kPieces + 1> floor_inner, floor_lap;
  for (int i = 0; i <= kPieces; ++i) {
    const V3 p = on_arch(i);
    const auto floor_at = [&](double y) { return V3{p.x, y, lowest(s, p.x, y, hub) + kOver}; };
    floor_inner[static_cast<std::size_t>(i)] = floor_at(inner);
    floor_lap[static_cast<std::size_t>(i)] = floor_at(inner - kLap);
  }
  const Filter side = [inner](const V3& p, const V3&) { return p.y > inner - 0.05; };
  cut(s, Seen::from_side, circle(x, hub, radius + 0.022, 40), on_side, "trim");
  cut(s, Seen::from_side, circle(x, hub, radius, 40), side, "");
  for (std::size_t i = 0; i < kPieces; ++i) {
    const V3 pa = on_arch(static_cast<int>(i)), pb = on_arch(static_cast<int>(i) + 1);
    s.quad(deep(pa, outer), deep(pa, inner), deep(pb, inner), deep(pb, outer), "underbody");
    s.quad(deep(pa, inner), floor_inner[i], floor_inner[i + 1], deep(pb, inner), "underbody");
    s.quad(floor_inner[i], floor_lap[i], floor_lap[i + 1], floor_inner[i + 1], "underbody");
  }
}

void darken_below(Surface& s, double z) {
  // along clean lines: up to the height, and where the skin turns down
  paint_where(
      s, [z](const Vertex& v) { return z - v.p.z; }, "underbody");
  paint_where(
      s, [](const Vertex& v) { return -0.6 - v.n.z; }, "underbody");
}

void underside(Surface& s, double axle, double hub, double floor, double half_track) {
  const double z = floor - 0.012;
  s.box({0.15 * axle, 0.10, z - 0.008}, {0.85 * axle, 0.028, 0.024}, "exhaust");
  s.box({-0.2 * axle, 0.10, z - 0.012}, {0.22, 0.075, 0.035}, "exhaust");
  s.box({-axle - 0.02, 0.10, z}, {0.35 * axle, 0.024, 0.024}, "exhaust");
  s.box({-axle - 0.46, 0.14, floor + 0.10}, {0.11, 0.30, 0.05}, "exhaust");  // silencer
  s.box({-axle + 0.62, 0, z}, {0.24, 0.46, 0.02}, "subframe");               // tank
  for (const double y : {0.46, -0.46}) s.box({0, y, z}, {0.78 * axle, 0.035, 0.022}, "subframe");
  s.box({axle, 0, z}, {0.26, 0.40, 0.03}, "subframe");
  for (const double x : {axle, -axle}) s.box({x, 0, 0.5 * (hub + floor)}, {0.035, half_track - 0.08, 0.035}, "subframe");
}

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

void seat(Surface& s, V3 m, double half_width) {
  s.box(m, {0.26, half_width, 0.09}, "interior", -0.10);
  s.box(m + V3{-0.28, 0, 0.29}, {0.07, 0.96 * half_width, 0.30}, "interior", -0.32);
  s.box(m + V3{-0.40, 0, 0.63}, {0.045, 0.5 * half_width, 0.085}, "interior", -0.2);
}

void steering_wheel(Surface& s, V3 m, double radius, double lean) {
  const int n = 20;
  for (int i = 0; i < n; ++i) {
    auto rim = [&](int k, double r) {
      const double a = 2 * std::numbers::pi * k / n;
      return V3{m.x + r * std::sin(a) * std::cos(lean), m.y + r * std::cos(a), m.z + r * std::sin(a) * std::sin(lean)};
    };
    s.quad(rim(i, radius), rim(i + 1, radius), rim(i + 1, 0.82 * radius), rim(i, 0.82 * radius), "interior");
  }
}

}  // namespace assets
