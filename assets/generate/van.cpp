#include "assets/generate/car.h"
#include "assets/generate/coach.h"
#include "assets/generate/coaches.h"
#include "assets/generate/details.h"

namespace assets {
namespace {

constexpr double kAxle = 1.625, kHub = 0.34, kArch = 0.41;  // [m]
constexpr double kRear = -2.75;

Coach shape() {
  Coach c;
  c.front = {{0.26, 2.42}, {0.36, 2.54}, {0.55, 2.58}, {0.85, 2.56}, {0.98, 2.49}, {1.06, 2.36},
             {1.17, 2.04}, {1.24, 1.90}, {1.60, 1.53}, {2.00, 1.13}, {2.16, 0.93}, {2.30, 0.70}};
  c.rear = {{0.26, kRear + 0.05}, {0.40, kRear}, {1.20, kRear}, {2.30, kRear + 0.09}};
  c.half = {{0.26, 0.93}, {0.45, 0.985}, {0.85, 0.995}, {1.20, 0.975}, {2.30, 0.875}};
  c.bottom = 0.26;
  c.top = 2.34;
  c.corner_front = 0.42;
  c.corner_rear = 0.10;
  c.roof = 0.15;
  c.bow = 0.10;
  return c;
}

void cut_glass(Surface& s) {
  framed(s, Seen::from_side, {{0.70, 1.20}, {1.70, 1.20}, {1.22, 1.72}, {0.98, 1.88}, {0.70, 1.90}}, 0.03, side_above(1.0));
  const Filter ahead = [](const V3& p, const V3& n) { return p.x > 0.6 && p.z > 1.1 && n.x > 0.35; };
  cut(s, Seen::from_front, {{-1, 1.19}, {0.90, 1.21}, {0.78, 2.08}, {-1, 2.12}}, ahead, "trim");
  cut(s, Seen::from_front, {{-1, 1.24}, {0.855, 1.25}, {0.745, 2.02}, {-1, 2.06}}, ahead, "glass");
  const Filter behind = [](const V3& p, const V3& n) { return p.x < kRear + 0.3 && n.x < -0.5; };
  framed(s, Seen::from_front, {{0.10, 1.30}, {0.74, 1.30}, {0.70, 1.92}, {0.10, 1.92}}, 0.03, behind);
}

void cut_ends(Surface& s) {
  const Filter front = [](const V3& p, const V3& n) { return p.x > 1.9 && n.x > -0.1 && n.z < 0.95; };
  const Filter behind = [](const V3& p, const V3& n) { return p.x < kRear + 0.3 && n.x < 0.2; };
  cut(s, Seen::from_front, {{-1, 0.30}, {1, 0.30}, {1, 0.50}, {0.60, 0.50}, {-1, 0.50}}, front, "trim");  // bumper
  cut(s, Seen::from_front, {{-1, 0.62}, {0.50, 0.62}, {0.58, 0.86}, {-1, 0.90}}, front, "trim");
  for (const double z : {0.67, 0.74, 0.81}) cut(s, Seen::from_front, rectangle(-1, z, 0.49, z + 0.016), front, "chrome");
  framed(s, Seen::from_front, {{0.63, 0.66}, {0.90, 0.66}, {0.93, 0.97}, {0.72, 0.90}}, 0.015, front, "lamp_front");
  cut(s, Seen::from_front, rectangle(0.66, 0.37, 0.82, 0.44), front, "lamp_front");
  cut(s, Seen::from_front, rectangle(-1, 0.52, 0.26, 0.61), front, "plate");
  framed(s, Seen::from_front, rectangle(0.86, 0.80, 1.1, 1.22), 0.012, behind, "lamp_rear");
  cut(s, Seen::from_front, rectangle(-1, 0.30, 1.1, 0.47), behind, "trim");
  cut(s, Seen::from_front, rectangle(-1, 0.50, 0.006, 2.10), behind, "trim");  // between the doors
  cut(s, Seen::from_front, rectangle(-1, 0.33, 0.26, 0.44), behind, "plate");
  cut(s, Seen::from_front, rectangle(0.035, 1.05, 0.065, 1.22), behind, "trim");
}

void cut_doors(Surface& s) {
  seam(s, 1.72, 0.52, 1.80, 1.12, 0.012);
  seam(s, 1.00, 0.34, 0.62, 0.34, 0.012);
  seam(s, 0.62, 0.34, 0.62, 2.05, 0.012);
  seam(s, 0.52, 0.34, 0.52, 2.02, 0.012);  // sliding door
  seam(s, -0.92, 0.34, -0.92, 2.02, 0.012);
  seam(s, 0.52, 2.02, -0.92, 2.02, 0.012);
  seam(s, 0.52, 0.34, -0.92, 0.34, 0.012);
  cut(s, Seen::from_side, rectangle(-2.5, 1.255, -0.2, 1.275), on_side, "trim");  // rail of the sliding door
  for (const double x : {0.75, 0.36}) cut(s, Seen::from_side, rectangle(x - 0.04, 1.02, x + 0.12, 1.055), on_side, "trim");
  cut(s, Seen::from_side, rectangle(-1.17, 0.50, 1.17, 0.60), on_side, "trim");  // rubbing strip
  cut(s, Seen::from_side, rectangle(kRear + 0.05, 0.50, -2.08, 0.60), on_side, "trim");
}

}  // namespace

Surface van() {
  Surface s = half_coach(shape(), "paint", {60, 8, 24, 14});
  for (const double x : {kAxle, -kAxle}) wheel_arch(s, x, kHub, kArch, 0.95, 0.55);
  cut(
      s, Seen::from_side, rectangle(-20, 0, 20, 0.30), [](const V3&, const V3&) { return true; }, "underbody");
  darken_below(s, 0.27);
  cut_glass(s);
  cut_ends(s);
  cut_doors(s);
  s.box({1.55, 1.06, 1.38}, {0.05, 0.10, 0.17}, "trim", -0.05);  // mirror
  s.box({1.55, 0.97, 1.27}, {0.03, 0.05, 0.03}, "trim");
  s.mirror_y();
  // cab and the wall behind it
  s.box({1.62, 0, 1.10}, {0.30, 0.86, 0.12}, "interior", -0.2);
  for (const double y : {0.48, 0.0, -0.48}) seat(s, {0.82, y, 0.86}, 0.23);
  s.box({0.45, 0, 1.25}, {0.02, 0.84, 0.85}, "interior");
  steering_wheel(s, {1.25, 0.48, 1.24}, 0.20, 0.9);
  return s;
}

Surface van_shell() {
  Surface s = half_coach(shape(), "paint", {16, 3, 14, 4});
  s.mirror_y();
  return s;
}

std::vector<Paint> van_paints() {
  std::vector<Paint> paints = car_paints();
  paints.front().colour = {0.78, 0.79, 0.80};
  return paints;
}

}  // namespace assets
