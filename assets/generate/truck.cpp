#include <cmath>

#include "assets/generate/car.h"
#include "assets/generate/coach.h"
#include "assets/generate/coaches.h"
#include "assets/generate/details.h"

namespace assets {
namespace {

constexpr double kAxle = 2.1, kHub = 0.43, kArch = 0.54;  // [m]
constexpr double kHalfCab = 1.16, kHalfLoad = 1.255;
constexpr double kLoadRear = -4.15, kLoadFront = 1.52, kLoadFloor = 1.06, kLoadTop = 3.45;

Coach cab() {
  Coach c;
  c.front = {{0.36, 3.30}, {0.55, 3.40}, {0.95, 3.42}, {1.35, 3.40}, {1.50, 3.37}, {2.30, 3.16}, {2.75, 2.92}};
  c.rear = {{0.36, 1.66}, {2.75, 1.70}};
  c.half = {{0.36, kHalfCab - 0.02}, {0.60, kHalfCab}, {1.40, kHalfCab}, {2.75, kHalfCab - 0.12}};
  c.bottom = 0.36;
  c.top = 2.76;
  c.corner_front = 0.24;
  c.corner_rear = 0.10;
  c.roof = 0.16;
  c.bow = 0.08;
  return c;
}

Coach load() {
  Coach c;
  c.front = {{kLoadFloor, kLoadFront}};
  c.rear = {{kLoadFloor, kLoadRear}};
  c.half = {{kLoadFloor, kHalfLoad}};
  c.bottom = kLoadFloor;
  c.top = kLoadTop;
  c.corner_front = 0.05;
  c.corner_rear = 0.05;
  c.roof = 0.05;
  return c;
}

Surface half_cab() {
  Surface s = half_coach(cab(), "paint", {48, 8, 12, 14});
  wheel_arch(s, kAxle, kHub, kArch, kHalfCab - 0.03, 0.62);
  darken_below(s, 0.37);
  framed(s, Seen::from_side, {{1.98, 1.42}, {3.12, 1.42}, {2.96, 2.26}, {1.98, 2.30}}, 0.035, side_above(1.0));
  const Filter front = [](const V3& p, const V3& n) { return p.x > 2.7 && n.x > 0.12; };
  cut(s, Seen::from_front, {{-1, 1.42}, {1.12, 1.46}, {1.02, 2.44}, {-1, 2.46}}, front, "trim");
  cut(s, Seen::from_front, {{-1, 1.50}, {1.05, 1.54}, {0.95, 2.36}, {-1, 2.38}}, front, "glass");
  cut(s, Seen::from_front, rectangle(-1, 0.94, 0.86, 1.30), front, "trim");
  for (const double z : {1.00, 1.09, 1.18}) cut(s, Seen::from_front, rectangle(-1, z, 0.82, z + 0.03), front, "chrome");
  cut(s, Seen::from_front, rectangle(-1, 0.42, 1.2, 0.86), front, "trim");  // bumper
  cut(s, Seen::from_front, rectangle(0.70, 0.56, 1.08, 0.78), front, "lamp_front");
  cut(s, Seen::from_front, rectangle(-1, 0.50, 0.26, 0.61), front, "plate");
  seam(s, 1.92, 0.95, 1.92, 2.36, 0.012);
  seam(s, 3.16, 1.00, 3.20, 1.40, 0.012);
  seam(s, 1.92, 2.36, 2.95, 2.34, 0.012);
  cut(s, Seen::from_side, rectangle(2.00, 1.20, 2.18, 1.25), on_side, "trim");  // handle
  cut(s, Seen::from_side, rectangle(2.68, 0.46, 3.14, 0.72), on_side, "trim");  // steps
  cut(s, Seen::from_side, rectangle(2.72, 0.52, 3.10, 0.55), on_side, "steel");
  for (const double z : {1.62, 1.90}) s.box({3.16, 1.33, z + 0.08}, {0.05, 0.10, z < 1.8 ? 0.10 : 0.20}, "trim");
  s.box({3.14, 1.20, 2.16}, {0.025, 0.10, 0.02}, "trim");
  return s;
}

Surface half_load() {
  Surface s = half_coach(load(), "panel", {6, 4, 10, 6});
  const Filter back = [](const V3& p, const V3& n) { return p.x < kLoadRear + 0.2 && n.x < -0.5; };
  const Filter side = [](const V3&, const V3& n) { return n.y > 0.5; };
  // aluminium frame, doors with their bars
  cut(s, Seen::from_side, rectangle(kLoadRear - 0.1, kLoadFloor - 0.1, kLoadFront + 0.1, kLoadFloor + 0.10), side, "steel");
  cut(s, Seen::from_side, rectangle(kLoadRear - 0.1, kLoadTop - 0.14, kLoadFront + 0.1, kLoadTop - 0.05), side, "steel");
  cut(s, Seen::from_front, rectangle(-1, kLoadFloor - 0.1, 2, kLoadFloor + 0.08), back, "steel");
  cut(s, Seen::from_front, rectangle(1.17, 0, 2, 9), back, "steel");
  cut(s, Seen::from_front, rectangle(-1, kLoadTop - 0.12, 2, kLoadTop), back, "steel");
  cut(s, Seen::from_front, rectangle(-1, 0, 0.008, 9), back, "trim");
  for (const double y : {0.30, 0.80}) s.box({kLoadRear - 0.02, y, 2.24}, {0.016, 0.016, 1.12}, "steel");
  for (const double z : {1.35, 2.25, 3.15}) s.box({kLoadRear - 0.012, 1.16, z}, {0.012, 0.06, 0.03}, "steel");
  for (const double z : {1.20, 3.30}) s.box({kLoadRear - 0.005, 1.21, z}, {0.012, 0.03, 0.035}, "lamp_rear");
  return s;
}

void add_frame(Surface& s) {
  for (const double side : {-1.0, 1.0}) {
    s.box({-0.45, side * 0.42, 0.88}, {3.6, 0.045, 0.12}, "steel");
    for (int i = 0; i < 16; ++i) {  // mudguard over the twin wheels
      const double a = 3.14159265358979323846 * (0.04 + 0.92 * i / 16.0),
                   b = 3.14159265358979323846 * (0.04 + 0.92 * (i + 1) / 16.0);
      auto at = [&](double t, double y) { return V3{-kAxle + 0.52 * std::cos(t), side * y, kHub + 0.52 * std::sin(t)}; };
      const V3 p = at(a, 0.58), q = at(a, 1.24), r = at(b, 1.24), t = at(b, 0.58);
      s.quad(p, q, r, t, "trim");
      s.quad(t, r, q, p, "trim");
    }
    // guard between the axles and lamps below the doors
    for (const double z : {0.52, 0.76}) s.box({0.0, side * 1.19, z}, {1.15, 0.02, 0.06}, "steel");
    for (const double x : {-0.9, 0.9}) s.box({x, side * 1.15, 0.80}, {0.03, 0.02, 0.28}, "steel");
    s.box({kLoadRear + 0.03, side * 0.93, 0.84}, {0.03, 0.26, 0.07}, "trim");
    s.box({kLoadRear - 0.002, side * 0.93, 0.84}, {0.02, 0.23, 0.055}, "lamp_rear");
  }
  s.box({kLoadRear + 0.12, 0, 0.52}, {0.04, 1.18, 0.06}, "steel");  // underrun bar
  for (const double y : {0.42, -0.42}) s.box({kLoadRear + 0.14, y, 0.70}, {0.03, 0.03, 0.16}, "steel");
  s.box({kLoadRear + 0.05, 0, 0.80}, {0.01, 0.26, 0.055}, "plate");
  s.box({0.35, 0.80, 0.66}, {0.55, 0.28, 0.26}, "tank");
  s.box({0.55, -0.80, 0.66}, {0.32, 0.28, 0.24}, "underbody");
  for (const double x : {kAxle, -kAxle}) s.box({x, 0, kHub}, {0.07, 0.75, 0.07}, "underbody");
  s.box({1.6, 0, 0.95}, {1.2, 0.50, 0.25}, "underbody");  // engine and gearbox
}

void furnish(Surface& s) {
  s.box({2.95, 0, 1.36}, {0.22, 1.00, 0.12}, "interior", -0.2);
  for (const double y : {0.62, -0.62}) seat(s, {2.35, y, 1.30}, 0.25);
  steering_wheel(s, {2.72, 0.62, 1.62}, 0.23, 0.55);
}

}  // namespace

Surface truck() {
  Surface s = half_cab();
  s.append(half_load());
  s.mirror_y();
  add_frame(s);
  furnish(s);
  return s;
}

Surface truck_shell() {
  Surface s = half_coach(cab(), "paint", {14, 3, 10, 5});
  s.append(half_coach(load(), "panel", {14, 2, 24, 6}));
  s.mirror_y();
  // what stands under the load: frame, guards, underrun bar
  s.box({-0.45, 0, 0.87}, {3.6, 0.46, 0.13}, "frame");
  s.box({0.0, 0, 0.64}, {1.15, 1.19, 0.18}, "frame");
  s.box({kLoadRear + 0.12, 0, 0.56}, {0.05, 1.18, 0.10}, "frame");
  return s;
}

std::vector<Paint> truck_paints() {
  std::vector<Paint> paints = car_paints();
  paints.front().colour = {0.05, 0.20, 0.38};
  paints.push_back({"panel", {0.76, 0.77, 0.77}});
  paints.push_back({"steel", {0.34, 0.35, 0.36}});
  paints.push_back({"tank", {0.42, 0.43, 0.44}});
  return paints;
}

}  // namespace assets
