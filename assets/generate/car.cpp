#include "assets/generate/car.h"

#include <cmath>
#include <numbers>

#include "assets/generate/car_shape.h"
#include "assets/generate/details.h"

namespace assets {
namespace {

constexpr double kFront = 2.27, kRear = -2.37;  // [m] ends of the car
constexpr double kAxle = 1.35;                  // front axle at +, rear at -
constexpr double kArch = 0.375;                 // radius of the wheel openings
constexpr double kHub = 0.31;                   // height of the wheel centres

CarShape sedan_shape() {
  CarShape s;
  s.front = kFront;
  s.rear = kRear;
  s.half_width = 0.905;
  s.roof_half = 0.615;
  s.waist = 0.60;
  s.top = {{kRear, 0.80},  {-2.31, 0.97},  {-2.22, 1.035}, {-1.78, 1.075}, {-1.62, 1.10}, {-0.98, 1.345},
           {-0.62, 1.415}, {-0.20, 1.445}, {0.10, 1.425},  {0.34, 1.365},  {1.02, 0.985}, {1.16, 0.945},
           {1.60, 0.875},  {2.02, 0.775},  {2.17, 0.70},   {kFront, 0.56}};
  s.shoulder = {{kRear, 0.76}, {-2.20, 0.93}, {-1.5, 0.96}, {0.0, 0.915}, {1.0, 0.865}, {1.7, 0.775}, {2.1, 0.67}, {kFront, 0.53}};
  s.underside = {{kRear, 0.36}, {-2.15, 0.25}, {-1.2, 0.185}, {1.4, 0.185}, {2.1, 0.20}, {kFront, 0.28}};
  return s;
}

void cut_windows(Surface& s) {
  const std::vector<std::array<double, 2>> front_door{{-0.215, 0.955}, {0.80, 0.93}, {0.36, 1.285}, {0.10, 1.355}, {-0.215, 1.372}};
  const std::vector<std::array<double, 2>> rear_door{
      {-1.14, 0.99}, {-0.285, 0.957}, {-0.285, 1.372}, {-0.62, 1.348}, {-0.86, 1.293}};
  const std::vector<std::array<double, 2>> quarter{{-1.45, 1.015}, {-1.185, 0.994}, {-0.905, 1.280}, {-0.985, 1.255}};
  framed(s, Seen::from_side, front_door, 0.026, side_above(0.85));
  framed(s, Seen::from_side, rear_door, 0.026, side_above(0.85));
  framed(s, Seen::from_side, quarter, 0.026, side_above(0.85));
  // windscreen and rear window, seen from above; the upper surface only
  const Filter above = [](const V3& p, const V3& n) { return n.z > 0.25 && p.z > 0.90; };
  cut(s, Seen::from_above, {{0.30, -1}, {1.05, -1}, {1.05, 0.70}, {0.985, 0.745}, {0.30, 0.575}}, above, "trim");
  cut(s, Seen::from_above, {{0.335, -1}, {1.005, -1}, {0.985, 0.66}, {0.945, 0.70}, {0.335, 0.545}}, above, "glass");
  cut(s, Seen::from_above, {{-1.63, -1}, {-0.90, -1}, {-0.90, 0.545}, {-1.63, 0.665}}, above, "trim");
  cut(s, Seen::from_above, {{-1.595, -1}, {-0.935, -1}, {-0.935, 0.52}, {-1.595, 0.63}}, above, "glass");
}

void cut_seams(Surface& s) {
  seam(s, 0.94, 0.33, 0.90, 0.87);     // front door's leading edge
  seam(s, -0.25, 0.28, -0.25, 0.95);   // between the doors
  seam(s, -0.88, 0.62, -1.20, 0.965);  // rear door over the arch
  seam(s, 0.94, 0.30, -0.86, 0.30);    // along the sill
  seam(s, 1.92, 0.42, 1.60, 0.76);     // front bumper and wing
  seam(s, -1.86, 0.40, -2.05, 0.71);   // rear bumper
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
  const Outline headlamp{{0.50, 0.60}, {0.66, 0.585}, {0.86, 0.655}, {0.86, 0.735}, {0.70, 0.715}, {0.50, 0.665}};
  framed(s, Seen::from_front, headlamp, kShutLine, front, "lamp_front");
  const Filter nose = [](const V3& p, const V3& n) { return p.x > 2.0 && n.x > 0.2; };
  cut(s, Seen::from_front, {{-1, 0.50}, {0.46, 0.50}, {0.42, 0.64}, {-1, 0.66}}, nose, "trim");
  for (const double z : {0.535, 0.575, 0.615})
    cut(s, Seen::from_front, {{-1, z}, {0.43, z}, {0.43, z + 0.009}, {-1, z + 0.009}}, nose, "chrome");
  cut(s, Seen::from_front, {{-1, 0.30}, {0.52, 0.30}, {0.46, 0.405}, {-1, 0.405}}, nose, "trim");
  cut(s, Seen::from_front, {{0.58, 0.325}, {0.78, 0.34}, {0.76, 0.405}, {0.60, 0.395}}, front, "trim");
  cut(s, Seen::from_front, {{0.63, 0.345}, {0.72, 0.35}, {0.71, 0.39}, {0.64, 0.385}}, front, "lamp_front");
  cut(s, Seen::from_front, {{-1, 0.42}, {0.26, 0.42}, {0.26, 0.49}, {-1, 0.49}}, nose, "plate");
  const Filter tail = [](const V3& p, const V3& n) { return p.x < -1.85 && n.z < 0.9 && n.x < 0.15; };
  const Outline lamp{{0.50, 0.74}, {0.90, 0.74}, {0.90, 0.90}, {0.54, 0.885}};
  framed(s, Seen::from_front, lamp, 0.022, tail, "lamp_rear");
  cut(s, Seen::from_front, rectangle(-1, 0.575, 0.30, 0.715), tail, "trim");
  cut(s, Seen::from_front, {{-1, 0.60}, {0.26, 0.60}, {0.26, 0.69}, {-1, 0.69}}, tail, "plate");
  cut(s, Seen::from_front, {{-1, 0.30}, {0.62, 0.30}, {0.58, 0.40}, {-1, 0.40}}, tail, "trim");
}

void cut_arches(Surface& s) {
  for (const double x : {kAxle, -kAxle}) wheel_arch(s, x, kHub, kArch, 0.89, 0.5);
  darken_below(s, 0.215);
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
  Surface s = half_skin(sedan_shape(), 110, 60);
  // lamps end along straight lines on the flanks
  const Filter whole = [](const V3&, const V3&) { return true; };
  cut(s, Seen::from_side, rectangle(1.70, 0, 9, 9), whole, "paint");
  cut(s, Seen::from_side, rectangle(-9, 0, -1.85, 9), whole, "paint");
  cut_arches(s);
  cut_windows(s);
  cut_seams(s);
  cut_ends(s);  // lamps lie over the seams
  s.append(egg({0.74, 0.985, 1.0}, {0.065, 0.115, 0.075}, "paint"));
  s.box({0.76, 0.86, 0.955}, {0.035, 0.06, 0.018}, "trim");
  s.box({0.98, 0.30, 1.012}, {0.012, 0.28, 0.008}, "trim", 0.5);  // wiper
  s.mirror_y();
  underside(s, kAxle, kHub, 0.185, 0.77);
  s.append(interior());
  return s;
}

Surface shell() {
  Surface s = half_skin(sedan_shape(), 40, 22, Folds::none);
  s.mirror_y();
  return s;
}

std::vector<Paint> car_paints() {
  return {{"paint", {0.45, 0.02, 0.025}},      {"glass", {0.015, 0.02, 0.022}, 0.80}, {"lamp_front", {0.80, 0.82, 0.85}},
          {"lamp_rear", {0.42, 0.012, 0.012}}, {"trim", {0.018, 0.018, 0.02}},        {"plate", {0.75, 0.75, 0.70}},
          {"chrome", {0.62, 0.62, 0.62}},      {"interior", {0.05, 0.05, 0.055}},     {"underbody", {0.022, 0.022, 0.023}},
          {"exhaust", {0.17, 0.16, 0.15}},     {"subframe", {0.055, 0.055, 0.058}}};
}

}  // namespace assets
