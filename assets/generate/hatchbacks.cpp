#include "assets/generate/hatchbacks.h"

#include <cmath>

#include "assets/generate/car.h"
#include "assets/generate/car_shape.h"
#include "assets/generate/details.h"

namespace assets {
namespace {

constexpr double kBow = 0.52, kStern = 0.45;  // [m] how far lamps reach round the ends

/// Where the details of one car lie on its shape.
struct Hatchback {
  CarShape shape;
  double axle, hub, arch;                  // [m]
  double sill;                             // [m] height of the doors' lower edge
  Outline front_door, rear_door, quarter;  // panes from the side
  Outline windscreen;                      // from above
  Outline rear_window;                     // from behind
  Outline headlamp, tail_lamp;             // from the front
  double grille_low, grille_high, grille_half;
  double plate_front, plate_rear;  // heights
  double b_pillar, door_front;     // places of the door seams
  double seat;                     // height of the cushions
  double mirror_x;
};

void cut_glass(Surface& s, const Hatchback& c) {
  const double from = c.front_door.front()[1] - 0.12;
  for (const Outline& pane : {c.front_door, c.rear_door, c.quarter}) framed(s, Seen::from_side, pane, 0.026, side_above(from));
  const Filter above = [from](const V3& p, const V3& n) { return n.z > 0.25 && n.x > 0.1 && p.z > from; };
  Outline wide = c.windscreen;  // a black border along the sides and the lower edge
  for (auto& p : wide) p = {p[0] + (p[0] > 0.7 ? 0.05 : -0.03), p[1] > 0 ? p[1] + 0.03 : p[1]};
  cut(s, Seen::from_above, wide, above, "trim");
  cut(s, Seen::from_above, c.windscreen, above, "glass");
  const double tail = c.shape.rear + 0.75;
  const Filter behind = [tail](const V3& p, const V3& n) { return p.x < tail && n.x < -0.3; };
  framed(s, Seen::from_front, c.rear_window, 0.05, behind);
}

void cut_ends(Surface& s, const Hatchback& c) {
  const double bow = c.shape.front - kBow, stern = c.shape.rear + kStern;
  const Filter front = [bow](const V3& p, const V3& n) { return p.x > bow && n.z < 0.93 && n.x > -0.1; };
  const Filter nose = [bow](const V3& p, const V3& n) { return p.x > bow + 0.3 && n.x > 0.2; };
  const Filter tail = [stern](const V3& p, const V3& n) { return p.x < stern && n.z < 0.9 && n.x < 0.2; };
  framed(s, Seen::from_front, c.headlamp, kShutLine, front, "lamp_front");
  cut(s, Seen::from_front,
      {{-1, c.grille_low}, {c.grille_half - 0.05, c.grille_low}, {c.grille_half, c.grille_high}, {-1, c.grille_high}}, nose,
      "trim");
  const int bars = 3;
  for (int i = 1; i <= bars; ++i) {
    const double z = c.grille_low + (c.grille_high - c.grille_low) * i / (bars + 1);
    cut(s, Seen::from_front, rectangle(-1, z - 0.006, c.grille_half - 0.06, z + 0.006), nose, "chrome");
  }
  const double low = c.plate_front - 0.20;
  cut(s, Seen::from_front, {{-1, low}, {0.60, low}, {0.52, low + 0.11}, {-1, low + 0.11}}, nose, "trim");
  cut(s, Seen::from_front, {{0.60, low + 0.02}, {0.74, low + 0.03}, {0.73, low + 0.09}, {0.61, low + 0.08}}, front, "lamp_front");
  cut(s, Seen::from_front, rectangle(-1, c.plate_front - 0.055, 0.26, c.plate_front + 0.055), nose, "plate");
  framed(s, Seen::from_front, c.tail_lamp, 0.018, tail, "lamp_rear");
  cut(s, Seen::from_front, rectangle(-1, c.plate_rear - 0.09, 0.33, c.plate_rear + 0.08), tail, "trim");
  cut(s, Seen::from_front, rectangle(-1, c.plate_rear - 0.055, 0.26, c.plate_rear + 0.055), tail, "plate");
  const double bumper = c.sill + 0.10;
  cut(s, Seen::from_front, {{-1, c.sill - 0.02}, {0.66, c.sill - 0.02}, {0.62, bumper}, {-1, bumper}}, tail, "trim");
  cut(s, Seen::from_front, rectangle(0.48, bumper + 0.03, 0.66, bumper + 0.065), tail, "lamp_rear");
}

void cut_doors(Surface& s, const Hatchback& c) {
  const double belt = c.front_door.front()[1] - 0.01, sill = c.sill;
  seam(s, c.door_front + 0.03, sill + 0.04, c.door_front, belt - 0.06);
  seam(s, c.b_pillar - 0.035, sill, c.b_pillar - 0.035, belt);
  seam(s, -c.axle + c.arch + 0.11, sill + 0.33, -c.axle + 0.12, belt);
  seam(s, c.door_front + 0.03, sill, -c.axle + c.arch + 0.1, sill);
  seam(s, c.shape.front - 0.36, sill + 0.14, c.axle + 0.22, belt - 0.20);
  seam(s, c.shape.rear + 0.45, sill + 0.14, c.shape.rear + 0.22, belt - 0.20);
  for (const double x : {c.b_pillar + 0.33, c.b_pillar - 0.66}) {
    const double z = belt - 0.11;
    cut(s, Seen::from_side, {{x - 0.09, z}, {x + 0.09, z - 0.006}, {x + 0.09, z + 0.018}, {x - 0.09, z + 0.024}}, on_side,
        "chrome");
  }
  const double wing = c.shape.half_width * 0.82, bonnet = c.windscreen[1][0] + 0.09;
  const Filter above = [](const V3& p, const V3& n) { return n.z > 0.5 && p.z > 0.6; };
  cut(s, Seen::from_above, rectangle(bonnet, -1, bonnet + 0.007, wing), above, "trim");
  cut(s, Seen::from_above,
      {{bonnet, wing}, {c.shape.front - 0.2, wing - 0.08}, {c.shape.front - 0.2, wing - 0.073}, {bonnet, wing + 0.007}}, above,
      "trim");
}

void furnish(Surface& s, const Hatchback& c) {
  const double dash = c.door_front - 0.14;
  s.box({dash, 0, c.seat + 0.29}, {0.22, 0.80 * c.shape.half_width, 0.10}, "interior", -0.15);
  for (const double y : {0.35, -0.35}) seat(s, {c.b_pillar + 0.24, y, c.seat}, 0.23);
  for (const double y : {0.42, 0.0, -0.42}) seat(s, {c.b_pillar - 0.62, y, c.seat + 0.02}, 0.20);
  s.box({c.shape.rear + 0.55, 0, c.front_door.front()[1] - 0.02}, {0.25, 0.6, 0.012}, "interior");
  steering_wheel(s, {dash - 0.32, 0.35, c.seat + 0.38}, 0.18, 1.13);
}

Surface build(const Hatchback& c) {
  Surface s = half_skin(c.shape, 110, 60);
  // lamps end along straight lines on the flanks
  const Filter whole = [](const V3&, const V3&) { return true; };
  cut(s, Seen::from_side, rectangle(c.shape.front - kBow, 0, 9, 9), whole, "paint");
  cut(s, Seen::from_side, rectangle(-9, 0, c.shape.rear + kStern, 9), whole, "paint");
  for (const double x : {c.axle, -c.axle}) wheel_arch(s, x, c.hub, c.arch, c.shape.half_width - 0.012, c.shape.half_width - 0.40);
  darken_below(s, c.sill - 0.08);
  cut_glass(s, c);
  cut_doors(s, c);
  cut_ends(s, c);  // lamps lie over the seams
  const double z = c.front_door.front()[1] + 0.055;
  s.append(egg({c.mirror_x, c.shape.half_width + 0.08, z}, {0.06, 0.105, 0.07}, "paint"));
  s.box({c.mirror_x + 0.02, c.shape.half_width - 0.04, z - 0.045}, {0.035, 0.06, 0.018}, "trim");
  s.mirror_y();
  underside(s, c.axle, c.hub, through(c.shape.underside, 0), c.shape.half_width - 0.135);
  furnish(s, c);
  return s;
}

Hatchback small_car_details() {
  CarShape shape;
  shape.front = 1.92;
  shape.rear = -2.00;
  shape.half_width = 0.845;
  shape.roof_half = 0.585;
  shape.waist = 0.60;
  shape.nose = 8.0;
  shape.tail = 9.0;
  shape.top = {{-2.00, 0.72}, {-1.97, 0.88}, {-1.92, 0.985}, {-1.87, 1.035}, {-1.67, 1.34}, {-1.60, 1.395},
               {-1.45, 1.43}, {-0.90, 1.47}, {-0.20, 1.475}, {0.15, 1.445},  {0.36, 1.375}, {1.02, 0.985},
               {1.12, 0.945}, {1.45, 0.885}, {1.74, 0.79},   {1.85, 0.70},   {1.92, 0.54}};
  shape.shoulder = {{-2.0, 0.70}, {-1.85, 0.95}, {-1.3, 0.965}, {0.0, 0.915}, {0.95, 0.86}, {1.5, 0.77}, {1.8, 0.66}, {1.92, 0.50}};
  shape.underside = {{-2.0, 0.36}, {-1.85, 0.26}, {-1.0, 0.18}, {1.2, 0.18}, {1.75, 0.20}, {1.92, 0.28}};
  Hatchback c{shape, 1.235, 0.29, 0.345, 0.29, {}, {}, {}, {}, {}, {}, {}, 0.57, 0.66, 0.42, 0.48, 0.78, -0.15, 0.86, 0.53, 0.72};
  c.front_door = {{-0.115, 0.955}, {0.77, 0.925}, {0.38, 1.285}, {0.16, 1.375}, {-0.115, 1.395}};
  c.rear_door = {{-0.92, 0.975}, {-0.185, 0.957}, {-0.185, 1.395}, {-0.80, 1.375}};
  c.quarter = {{-1.42, 1.025}, {-0.98, 0.99}, {-0.88, 1.355}, {-1.20, 1.31}};
  c.windscreen = {{0.36, -1}, {0.98, -1}, {0.96, 0.62}, {0.92, 0.66}, {0.36, 0.50}};
  c.rear_window = {{-1, 1.06}, {0.52, 1.06}, {0.47, 1.32}, {-1, 1.34}};
  c.headlamp = {{0.46, 0.63}, {0.60, 0.60}, {0.82, 0.66}, {0.83, 0.77}, {0.66, 0.76}, {0.50, 0.71}};
  c.tail_lamp = {{0.57, 0.76}, {0.86, 0.76}, {0.86, 1.03}, {0.60, 1.03}};
  return c;
}

Hatchback suv_details() {
  CarShape shape;
  shape.front = 2.20;
  shape.rear = -2.35;
  shape.half_width = 0.93;
  shape.roof_half = 0.67;
  shape.waist = 0.78;
  shape.nose = 9.0;
  shape.tail = 9.0;
  shape.top = {{-2.35, 0.85},  {-2.33, 1.00}, {-2.28, 1.12},  {-2.23, 1.17}, {-2.06, 1.51}, {-1.99, 1.585},
               {-1.85, 1.625}, {-1.20, 1.67}, {-0.40, 1.685}, {0.10, 1.665}, {0.30, 1.61},  {1.02, 1.155},
               {1.14, 1.11},   {1.60, 1.055}, {1.96, 0.98},   {2.10, 0.88},  {2.20, 0.68}};
  shape.shoulder = {{-2.35, 0.82}, {-2.2, 1.07}, {-1.5, 1.10}, {0.0, 1.05}, {1.0, 1.02}, {1.7, 0.95}, {2.05, 0.84}, {2.20, 0.64}};
  shape.underside = {{-2.35, 0.44}, {-2.15, 0.35}, {-1.2, 0.26}, {1.4, 0.26}, {2.05, 0.28}, {2.20, 0.38}};
  Hatchback c{shape, 1.34, 0.355, 0.415, 0.38, {}, {}, {}, {}, {}, {}, {}, 0.68, 0.84, 0.50, 0.60, 0.92, -0.18, 0.90, 0.68, 0.76};
  c.front_door = {{-0.145, 1.095}, {0.80, 1.07}, {0.40, 1.46}, {0.16, 1.565}, {-0.145, 1.59}};
  c.rear_door = {{-1.05, 1.115}, {-0.215, 1.097}, {-0.215, 1.59}, {-1.00, 1.58}};
  c.quarter = {{-1.86, 1.17}, {-1.13, 1.125}, {-1.08, 1.575}, {-1.66, 1.52}};
  c.windscreen = {{0.30, -1}, {0.98, -1}, {0.96, 0.70}, {0.92, 0.74}, {0.30, 0.585}};
  c.rear_window = {{-1, 1.20}, {0.60, 1.20}, {0.55, 1.49}, {-1, 1.51}};
  c.headlamp = {{0.56, 0.79}, {0.70, 0.77}, {0.90, 0.81}, {0.91, 0.91}, {0.74, 0.92}, {0.58, 0.88}};
  c.tail_lamp = {{0.66, 0.90}, {0.95, 0.90}, {0.95, 1.16}, {0.69, 1.16}};
  return c;
}

std::vector<Paint> in_colour(std::array<double, 3> colour) {
  std::vector<Paint> paints = car_paints();
  for (Paint& p : paints)
    if (p.name == "paint") p.colour = colour;
  return paints;
}

Surface closed(const CarShape& shape) {
  Surface s = half_skin(shape, 40, 22, Folds::none);
  s.mirror_y();
  return s;
}

}  // namespace

Surface small_car() {
  return build(small_car_details());
}
Surface small_car_shell() {
  return closed(small_car_details().shape);
}
Surface suv() {
  Surface s = build(suv_details());
  // unpainted below, as such cars are
  cut(
      s, Seen::from_side, rectangle(-20, 0, 20, 0.50),
      [](const V3& p, const V3& n) { return std::abs(n.y) > 0.3 && std::abs(p.y) > 0.5; }, "trim");
  cut(
      s, Seen::from_front, rectangle(-2, 0, 2, 0.485), [](const V3& p, const V3& n) { return p.x > 1.5 && n.x > 0; }, "trim");
  for (const double y : {0.56, -0.56}) s.box({-0.72, y, 1.645}, {0.72, 0.018, 0.022}, "chrome");  // roof rails
  return s;
}
Surface suv_shell() {
  return closed(suv_details().shape);
}

std::vector<Paint> small_car_paints() {
  return in_colour({0.05, 0.22, 0.42});
}
std::vector<Paint> suv_paints() {
  return in_colour({0.30, 0.32, 0.33});
}

}  // namespace assets
