#include <cmath>

#include "assets/generate/car.h"
#include "assets/generate/coach.h"
#include "assets/generate/coaches.h"
#include "assets/generate/details.h"

namespace assets {
namespace {

constexpr double kAxle = 2.95, kHub = 0.48, kArch = 0.57;  // [m]
constexpr double kRear = -6.36, kHalf = 1.275;

Coach shape() {
  Coach c;
  c.front = {{0.30, 5.55}, {0.50, 5.62}, {0.95, 5.63}, {2.10, 5.55}, {2.75, 5.42}, {3.05, 5.35}};
  c.rear = {{0.30, kRear + 0.10}, {0.55, kRear}, {1.60, kRear + 0.02}, {3.05, kRear + 0.16}};
  c.half = {{0.30, kHalf - 0.02}, {0.45, kHalf}, {1.30, kHalf}, {3.05, kHalf - 0.06}};
  c.bottom = 0.30;
  c.top = 3.06;
  c.corner_front = 0.26;
  c.corner_rear = 0.16;
  c.roof = 0.20;
  c.bow = 0.10;
  return c;
}

enum class Side { left, right };  // the doors stand on the right, so both are made apart

/// A row of windows, about 1.4 m each.
void cut_row(Surface& s, double from, double to) {
  const int count = static_cast<int>(std::lround((to - from) / 1.42));
  const double pitch = (to - from) / count;
  for (int i = 0; i < count; ++i) {
    const double a = from + i * pitch + 0.03, b = a + pitch - 0.06;
    cut(s, Seen::from_side, rectangle(a, 1.27, b, 2.57), side_above(0.9), "glass");
    cut(s, Seen::from_side, rectangle(a, 2.17, b, 2.195), side_above(0.9), "trim");  // the tilting part
  }
}

void cut_windows(Surface& s, Side which) {
  cut(s, Seen::from_side, rectangle(-5.95, 1.22, 5.36, 2.62), side_above(0.9), "trim");
  if (which == Side::left) return cut_row(s, -5.93, 5.35);
  cut_row(s, -5.93, -0.74);
  cut_row(s, 0.64, 4.06);
}

void cut_doors(Surface& s) {
  const Filter side = [](const V3& p, const V3& n) { return n.y > 0.35 && p.z > 0.3; };
  for (const auto& [from, to] : {std::pair{4.10, 5.34}, {-0.70, 0.60}}) {
    cut(s, Seen::from_side, rectangle(from - 0.05, 0.36, to + 0.05, 2.62), side, "trim");
    const double mid = 0.5 * (from + to);
    for (const auto& [a, b] : {std::pair{from + 0.02, mid - 0.02}, {mid + 0.02, to - 0.02}})
      cut(s, Seen::from_side, rectangle(a + 0.04, 0.52, b - 0.04, 2.54), side, "glass");
  }
}

void cut_front(Surface& s) {
  const Filter front = [](const V3& p, const V3& n) { return p.x > 5.0 && n.x > 0.15; };
  cut(s, Seen::from_front, {{-1, 1.02}, {1.22, 1.08}, {1.20, 2.95}, {-1, 2.95}}, front, "trim");
  cut(s, Seen::from_front, {{-1, 1.08}, {1.14, 1.14}, {1.13, 2.42}, {-1, 2.42}}, front, "glass");
  cut(s, Seen::from_front, rectangle(-1, 2.54, 0.95, 2.80), front, "display");
  framed(s, Seen::from_front, {{0.66, 0.62}, {1.16, 0.62}, {1.18, 0.86}, {0.72, 0.86}}, 0.03, front, "lamp_front");
  cut(s, Seen::from_front, rectangle(-1, 0.34, 1.3, 0.42), front, "trim");
  cut(s, Seen::from_front, rectangle(-1, 0.48, 0.26, 0.58), front, "plate");
  cut(s, Seen::from_front, rectangle(-1, 0.895, 1.22, 0.91), front, "trim");
}

void cut_back(Surface& s) {
  const Filter back = [](const V3& p, const V3& n) { return p.x < -5.9 && n.x < -0.15; };
  framed(s, Seen::from_front, {{-1, 1.72}, {1.02, 1.72}, {0.98, 2.52}, {-1, 2.52}}, 0.05, back);
  cut(s, Seen::from_front, rectangle(-1, 0.66, 0.90, 1.42), back, "trim");  // engine's grille
  for (int i = 0; i < 6; ++i) cut(s, Seen::from_front, rectangle(-1, 0.73 + 0.11 * i, 0.86, 0.77 + 0.11 * i), back, "grille");
  for (const double z : {0.62, 0.86, 1.10}) framed(s, Seen::from_front, circle(1.08, z + 0.1, 0.09, 18), 0.02, back, "lamp_rear");
  for (const double z : {2.72}) cut(s, Seen::from_front, rectangle(0.85, z, 1.05, z + 0.08), back, "lamp_rear");
  cut(s, Seen::from_front, rectangle(-1, 0.34, 1.3, 0.50), back, "trim");
  cut(s, Seen::from_front, rectangle(-1, 0.52, 0.26, 0.62), back, "plate");
}

Surface half(Side which) {
  Surface s = half_coach(shape(), "paint", {48, 8, 24, 16});
  for (const double x : {kAxle, -kAxle}) wheel_arch(s, x, kHub, kArch, kHalf - 0.03, 0.60);
  cut(
      s, Seen::from_side, rectangle(-20, 0, 20, 0.345), [](const V3&, const V3&) { return true; }, "underbody");
  darken_below(s, 0.31);
  cut_windows(s, which);
  if (which == Side::right) cut_doors(s);
  cut_front(s);
  cut_back(s);
  seam(s, -5.95, 1.10, 5.30, 1.10, 0.02);
  for (const double x : {-5.2, -4.1, -1.6, -0.9, 0.8, 1.8, 3.9})
    if (std::abs(std::abs(x) - kAxle) > 0.65) seam(s, x, 0.36, x, 1.10, 0.012);
  return s;
}

void furnish(Surface& s) {
  s.box({-0.3, 0, 0.36}, {5.8, 1.15, 0.02}, "interior");
  for (double x = -5.2; x < 4.0; x += 0.80)
    for (const double y : {0.95, 0.50, -0.50, -0.95}) {
      if (y < 0 && x > -1.1 && x < 1.2) continue;  // before the middle door
      const double floor = std::abs(std::abs(x) - kAxle) < 0.8 || x < -3.5 ? 0.75 : 0.40;
      s.box({x, y, floor + 0.44}, {0.22, 0.20, 0.035}, "seat");
      s.box({x - 0.22, y, floor + 0.80}, {0.035, 0.20, 0.36}, "seat", -0.15);
    }
  for (const double x : {-1.1, 0.9, 2.1, 3.9})
    for (const double y : {0.28, -0.28}) s.box({x, y, 1.55}, {0.016, 0.016, 1.15}, "handrail");
  // the driver's place
  s.box({5.05, 0.55, 1.02}, {0.25, 0.60, 0.10}, "interior", -0.2);
  seat(s, {4.25, 0.65, 0.95}, 0.24);
  s.box({3.88, 0.65, 1.35}, {0.02, 0.50, 0.65}, "interior");
  steering_wheel(s, {4.72, 0.65, 1.22}, 0.24, 0.5);
}

}  // namespace

Surface bus() {
  Surface left = half(Side::left), s = half(Side::right);
  s.mirror_y();
  // of the right half, keep its mirror image: the second half of the faces
  s.faces.erase(s.faces.begin(), s.faces.begin() + static_cast<long>(s.faces.size() / 2));
  s.append(left);
  for (const double side : {-1.0, 1.0}) {
    s.box({5.50, side * 1.36, 2.22}, {0.06, 0.08, 0.24}, "trim");
    s.box({5.46, side * 1.28, 2.52}, {0.03, 0.12, 0.03}, "trim");
  }
  s.box({-3.4, 0, 3.13}, {1.1, 0.80, 0.10}, "paint");  // air conditioning
  furnish(s);
  return s;
}

Surface bus_shell() {
  Surface s = half_coach(shape(), "paint", {14, 3, 30, 5});
  s.mirror_y();
  return s;
}

std::vector<Paint> bus_paints() {
  std::vector<Paint> paints = car_paints();
  paints.front().colour = {0.62, 0.47, 0.06};
  paints.push_back({"display", {0.05, 0.045, 0.02}});
  paints.push_back({"grille", {0.06, 0.06, 0.06}});
  paints.push_back({"seat", {0.05, 0.09, 0.20}});
  paints.push_back({"handrail", {0.60, 0.45, 0.05}});
  return paints;
}

}  // namespace assets
