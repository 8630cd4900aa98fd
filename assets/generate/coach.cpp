#include "assets/generate/coach.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace assets {
namespace {

constexpr double kQuarter = std::numbers::pi / 2;

/// Point at a height, drawn in by `inset`, along the outline: 0 rear middle, 1, 2 ends of the rear corner, 3, 4 of the front
/// corner, 5 front middle.
V3 outline(const Coach& c, double z, double inset, double s) {
  const double xr = through(c.rear, z) + inset, xf = through(c.front, z) - inset, h = through(c.half, z) - inset;
  const double rr = std::max(0.02, c.corner_rear - inset), rf = std::max(0.02, c.corner_front - inset);
  V3 p{0, 0, z};
  if (s < 1) {
    p.x = xr, p.y = s * (h - rr);
  } else if (s < 2) {
    const double a = (s - 1) * kQuarter;
    p.x = xr + rr - rr * std::cos(a), p.y = h - rr + rr * std::sin(a);
  } else if (s < 3) {
    p.x = xr + rr + (s - 2) * (xf - rf - xr - rr), p.y = h;
  } else if (s < 4) {
    const double a = (s - 3) * kQuarter;
    p.x = xf - rf + rf * std::sin(a), p.y = h - rf + rf * std::cos(a);
  } else {
    p.x = xf, p.y = (5 - s) * (h - rf);
  }
  const double ahead = std::clamp((p.x - xr) / (xf - xr), 0.0, 1.0);
  p.x += c.bow * ahead * ahead * (1 - p.y * p.y / (h * h));
  return p;
}

/// Up the wall for v in 0..1, over the roof's edge for v in 1..2.
V3 at(const Coach& c, double v, double s) {
  const double eaves = c.top - c.roof;
  if (v <= 1) return outline(c, c.bottom + v * (eaves - c.bottom), 0, s);
  const double a = (v - 1) * kQuarter;
  return outline(c, eaves + c.roof * std::sin(a), c.roof * (1 - std::cos(a)), s);
}

V3 normal(const Coach& c, double v, double s) {
  const double e = 1e-3;
  const V3 along = at(c, v, std::min(5.0, s + e)) - at(c, v, std::max(0.0, s - e));
  const V3 up = at(c, std::min(2.0, v + e), s) - at(c, std::max(0.0, v - e), s);
  V3 n = cross(up, along);
  if (s == 0 || s == 5) n.y = 0;
  return unit(n);
}

}  // namespace

Surface half_coach(const Coach& c, const std::string& material, const Fineness& f) {
  std::vector<double> vs, ss;
  for (int i = 0; i <= f.levels; ++i) vs.push_back(static_cast<double>(i) / f.levels);
  for (int i = 1; i <= f.arc; ++i) vs.push_back(1 + static_cast<double>(i) / f.arc);
  ss.push_back(0);
  for (const auto& [from, count] : {std::pair{0, f.flat}, {1, f.arc}, {2, f.side}, {3, f.arc}, {4, f.flat}})
    for (int i = 1; i <= count; ++i) ss.push_back(from + static_cast<double>(i) / count);
  Surface out;
  for (std::size_t i = 0; i + 1 < vs.size(); ++i)
    for (std::size_t k = 0; k + 1 < ss.size(); ++k) {
      auto vertex = [&](std::size_t v, std::size_t s) { return Vertex{at(c, vs[v], ss[s]), normal(c, vs[v], ss[s])}; };
      out.add(vertex(i, k), vertex(i + 1, k), vertex(i + 1, k + 1), material);
      out.add(vertex(i, k), vertex(i + 1, k + 1), vertex(i, k + 1), material);
    }
  for (std::size_t k = 0; k + 1 < ss.size(); ++k) {
    const V3 a = at(c, 2, ss[k]), b = at(c, 2, ss[k + 1]), d = at(c, 0, ss[k]), e = at(c, 0, ss[k + 1]);
    out.quad(a, {a.x, 0, a.z}, {b.x, 0, b.z}, b, material);
    out.quad({d.x, 0, d.z}, d, e, {e.x, 0, e.z}, material);
  }
  return out;
}

}  // namespace assets
