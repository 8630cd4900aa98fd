#include "assets/generate/two_wheelers.h"

#include <cmath>
#include <numbers>

namespace assets {
namespace {

constexpr double kPi = std::numbers::pi;

/// A round tube from a to b with closed ends.
void tube(Surface& s, V3 a, V3 b, double ra, double rb, const std::string& material, int n = 12) {
  const V3 along = unit(b - a);
  const V3 x = unit(cross(std::abs(along.z) < 0.9 ? V3{0, 0, 1} : V3{1, 0, 0}, along)), y = cross(along, x);
  auto at = [&](int k, bool end) {
    const double t = 2 * kPi * k / n;
    const V3 d = std::cos(t) * x + std::sin(t) * y;
    return Vertex{(end ? b : a) + (end ? rb : ra) * d, d};
  };
  for (int k = 0; k < n; ++k) {
    s.add(at(k, false), at(k + 1, false), at(k + 1, true), material);
    s.add(at(k, false), at(k + 1, true), at(k, true), material);
    s.add({a, -1 * along}, {at(k + 1, false).p, -1 * along}, {at(k, false).p, -1 * along}, material);
    s.add({b, along}, {at(k, true).p, along}, {at(k + 1, true).p, along}, material);
  }
}

/// A rounded body: ellipsoid of half axes r, raised to a fuller shape by the power p, leaning by `lean` [rad] about y.
void rounded(Surface& s, V3 m, V3 r, const std::string& material, double lean = 0, double p = 0.75) {
  const int n = 16;
  auto full = [&](double c) { return std::copysign(std::pow(std::abs(c), p), c); };
  auto turn = [&](V3 v) {
    return V3{std::cos(lean) * v.x + std::sin(lean) * v.z, v.y, -std::sin(lean) * v.x + std::cos(lean) * v.z};
  };
  auto at = [&](int i, int j) {
    const double a = kPi * i / n, b = 2 * kPi * j / n;
    const V3 d{full(std::sin(a)) * full(std::cos(b)), full(std::sin(a)) * full(std::sin(b)), full(std::cos(a))};
    const V3 round{std::sin(a) * std::cos(b) / r.x, std::sin(a) * std::sin(b) / r.y, std::cos(a) / r.z};
    return Vertex{m + turn({r.x * d.x, r.y * d.y, r.z * d.z}), turn(unit(round))};
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      s.add(at(i, j), at(i + 1, j), at(i + 1, j + 1), material);
      s.add(at(i, j), at(i + 1, j + 1), at(i, j + 1), material);
    }
}

void arc(Surface& s, V3 centre, double r, double from, double to, double half, const std::string& material) {
  const int n = 14;
  for (int k = 0; k < n; ++k) {
    auto at = [&](int i) {
      const double a = from + (to - from) * i / n;
      return centre + r * V3{std::cos(a), 0, std::sin(a)};
    };
    tube(s, at(k), at(k + 1), half, half, material, 8);
  }
}

}  // namespace

Surface bicycle() {
  Surface s;
  const V3 crank{-0.08, 0, 0.28}, rear{-0.53, 0, 0.34}, front{0.53, 0, 0.34}, seat{-0.33, 0, 0.74}, head{0.30, 0, 0.86};
  tube(s, crank, seat, 0.016, 0.016, "paint");
  tube(s, crank, {0.36, 0, 0.70}, 0.02, 0.02, "paint");
  tube(s, {-0.30, 0, 0.70}, {0.315, 0, 0.82}, 0.016, 0.016, "paint");
  tube(s, {0.36, 0, 0.69}, head, 0.02, 0.02, "paint");
  tube(s, seat, {-0.355, 0, 0.795}, 0.013, 0.013, "chrome");
  for (const double side : {-1.0, 1.0}) {
    const V3 y{0, 0.055 * side, 0}, z{0, 0.03 * side, 0};
    tube(s, crank + z, rear + y, 0.010, 0.009, "paint");
    tube(s, seat + z, rear + y, 0.009, 0.008, "paint");
    tube(s, V3{0.365, 0, 0.68} + y, front + y, 0.012, 0.009, "paint");
    tube(s, {0.27, 0.03 * side, 0.93}, {0.30, 0.20 * side, 0.955}, 0.012, 0.012, "chrome");
    tube(s, {0.30, 0.20 * side, 0.955}, {0.368, 0.32 * side, 0.955}, 0.012, 0.012, "chrome");
    tube(s, {0.33, 0.25 * side, 0.955}, {0.372, 0.33 * side, 0.955}, 0.018, 0.018, "trim");
    // cranks as the pose has its feet: left in front
    const V3 pedal{crank.x + 0.16 * side, 0.085 * side, crank.z - 0.06 - 0.012 * side};
    tube(s, crank + V3{0, 0.06 * side, 0}, {pedal.x, 0.06 * side, pedal.z}, 0.010, 0.008, "chrome");
    s.box(pedal, {0.045, 0.04, 0.010}, "trim");
  }
  tube(s, {0.365, -0.06, 0.68}, {0.365, 0.06, 0.68}, 0.014, 0.014, "paint");
  tube(s, head, {0.27, 0, 0.93}, 0.014, 0.014, "chrome");
  tube(s, {0.27, -0.04, 0.93}, {0.27, 0.04, 0.93}, 0.012, 0.012, "chrome");
  tube(s, crank + V3{0, -0.045, 0}, crank + V3{0, -0.05, 0}, 0.085, 0.085, "chrome", 28);
  rounded(s, {-0.36, 0, 0.81}, {0.13, 0.07, 0.025}, "trim", -0.05);
  arc(s, rear, 0.375, 0.35 * kPi, 1.05 * kPi, 0.018, "trim");
  arc(s, front, 0.375, 0.30 * kPi, 0.85 * kPi, 0.018, "trim");
  rounded(s, {0.36, 0, 0.83}, {0.025, 0.03, 0.03}, "lamp_front");
  rounded(s, {-0.92, 0, 0.55}, {0.015, 0.025, 0.025}, "lamp_rear");
  return s;
}

Surface motorcycle() {
  Surface s;
  const V3 rear{-0.72, 0, 0.31}, front{0.72, 0, 0.31};
  rounded(s, {0.13, 0, 0.82}, {0.28, 0.15, 0.12}, "paint", 0.10);    // tank
  rounded(s, {-0.32, 0, 0.79}, {0.34, 0.14, 0.045}, "trim", -0.02);  // seat
  rounded(s, {-0.72, 0, 0.80}, {0.18, 0.10, 0.06}, "paint", 0.15);   // tail
  rounded(s, {0.05, 0, 0.46}, {0.26, 0.17, 0.18}, "steel");          // engine
  rounded(s, {0.20, 0, 0.50}, {0.12, 0.14, 0.16}, "trim", 0.3);      // cylinders
  rounded(s, {0.50, 0, 0.96}, {0.09, 0.11, 0.11}, "paint");          // lamp housing
  rounded(s, {0.565, 0, 0.95}, {0.04, 0.085, 0.085}, "lamp_front");
  rounded(s, {-0.90, 0, 0.80}, {0.015, 0.07, 0.03}, "lamp_rear");
  s.box({-0.93, 0, 0.62}, {0.006, 0.09, 0.075}, "plate", 0.2);
  for (const double side : {-1.0, 1.0}) {
    tube(s, {0.40, 0.09 * side, 1.00}, front + V3{0, 0.09 * side, 0}, 0.026, 0.024, "chrome");
    tube(s, {-0.10, 0.10 * side, 0.40}, rear + V3{0, 0.10 * side, 0}, 0.030, 0.022, "steel");
    tube(s, {-0.35, 0.11 * side, 0.74}, {-0.66, 0.11 * side, 0.36}, 0.024, 0.024, "chrome");
    tube(s, {0.30, 0.05 * side, 0.85}, {-0.15, 0.13 * side, 0.40}, 0.020, 0.020, "steel");
    tube(s, {0.36, 0.04 * side, 1.05}, {0.43, 0.26 * side, 1.12}, 0.013, 0.013, "chrome");
    tube(s, {0.43, 0.26 * side, 1.12}, {0.445, 0.40 * side, 1.115}, 0.019, 0.019, "trim");
    tube(s, {0.42, 0.22 * side, 1.12}, {0.40, 0.30 * side, 1.27}, 0.006, 0.006, "trim");
    rounded(s, {0.40, 0.32 * side, 1.29}, {0.015, 0.065, 0.045}, "trim");
    tube(s, {0.10, 0.12 * side, 0.25}, {0.13, 0.31 * side, 0.235}, 0.014, 0.014, "trim");
  }
  tube(s, {0.20, -0.14, 0.30}, {-0.45, -0.19, 0.30}, 0.030, 0.040, "chrome");
  tube(s, {-0.45, -0.19, 0.30}, {-0.85, -0.20, 0.42}, 0.050, 0.055, "chrome");
  tube(s, {0.38, -0.10, 1.02}, {0.38, 0.10, 1.02}, 0.022, 0.022, "steel");
  arc(s, front, 0.345, 0.20 * kPi, 0.80 * kPi, 0.045, "paint");
  return s;
}

Surface spoked_wheel(double r, double t, int spokes) {
  Surface s;
  const int n = 48, m = 10;
  auto ring = [&](double radius, double thick, double wide, const std::string& material) {
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < m; ++k) {
        auto at = [&](int a, int b) {
          const double u = 2 * kPi * a / n, v = 2 * kPi * b / m;
          const V3 out{std::cos(u), 0, std::sin(u)};
          const V3 d = std::cos(v) * out + V3{0, std::sin(v), 0};
          return Vertex{(radius + thick * std::cos(v)) * out + V3{0, wide * std::sin(v), 0}, d};
        };
        s.add(at(i, k), at(i, k + 1), at(i + 1, k + 1), material);
        s.add(at(i, k), at(i + 1, k + 1), at(i + 1, k), material);
      }
  };
  ring(r - 0.5 * t, 0.5 * t, 0.5 * t, "tyre");
  ring(r - 1.05 * t, 0.18 * t, 0.35 * t, "rim");
  tube(s, {0, -0.05, 0}, {0, 0.05, 0}, 0.022, 0.022, "rim");
  for (int k = 0; k < spokes; ++k) {
    const double a = 2 * kPi * k / spokes, lean = k % 2 ? 0.025 : -0.025;
    const V3 out{std::cos(a), 0, std::sin(a)};
    tube(s, 0.02 * out + V3{0, lean, 0}, (r - 1.1 * t) * out, spokes > 12 ? 0.0018 : 0.012, spokes > 12 ? 0.0018 : 0.009, "rim", 5);
  }
  return s;
}

std::vector<Paint> two_wheeler_paints() {
  return {{"paint", {0.02, 0.16, 0.20}},      {"chrome", {0.62, 0.62, 0.62}},      {"steel", {0.28, 0.28, 0.29}},
          {"trim", {0.02, 0.02, 0.022}},      {"tyre", {0.022, 0.022, 0.024}},     {"rim", {0.50, 0.51, 0.53}},
          {"lamp_front", {0.80, 0.82, 0.85}}, {"lamp_rear", {0.42, 0.012, 0.012}}, {"plate", {0.75, 0.75, 0.70}}};
}

}  // namespace assets
