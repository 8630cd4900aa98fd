#include "tests/closed_forms/families.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/closed_forms/exact_answers.h"

namespace closed_forms {
namespace {

constexpr double kG = exact::kGravity, kPi = std::numbers::pi;

std::string simulation(double duration, const std::string& more) {
  return fmt::format("title = \"closed form\"\n[simulation]\nduration = \"{:.17g} s\"\n{}\n", duration, more);
}

/// What stands under one [[body]].
std::string body(const std::string& name, const std::string& lines) {
  return fmt::format("[[body]]\nname = \"{}\"\n{}\n", name, lines);
}

/// A block that does not turn, however its friction pulls: a point.
std::string block(double x_speed, const std::string& friction, double mass) {
  return body("block", fmt::format("mass = \"{} kg\"\naxes = \"0.3 0.3 0.03 m\"\nexponent = 4\ninertia = \"1e7 1e7 1e7 kg m^2\"\n"
                                   "position = \"0 0 0.03 m\"\nvelocity = \"{:.17g} 0 0 m/s\"\nfriction = {}\n",
                                   mass, x_speed, friction));
}

std::string ball(const std::string& name, double mass, double radius, const std::string& place, const std::string& velocity,
                 double friction, double restitution) {
  return body(name, fmt::format("mass = \"{:.17g} kg\"\naxes = \"{:.17g} {:.17g} {:.17g} m\"\nposition = \"{} m\"\n"
                                "velocity = \"{} m/s\"\nfriction = {:.17g}\nrestitution = {:.17g}\n",
                                mass, radius, radius, radius, place, velocity, friction, restitution));
}

std::string slope(double angle) {
  return fmt::format("slope = \"{:.17g} deg\"\nstop_at_rest = false", angle * 180 / kPi);
}

constexpr const char* kSpace = "gravity = 0\nstop_at_rest = false\n[ground]\nkind = \"none\"";

/// On whole recorded instants of 5 ms.
double instant(double t) {
  return 0.005 * std::ceil(t / 0.005);
}

Known puck(Chance& draw) {
  const double v = draw(1, 15), mu = draw(0.1, 0.9), rest = v / (mu * kG);
  return {simulation(rest + 0.5, "") + block(v, fmt::format("{:.17g}", mu), draw(1, 50)),
          {{"travel_m", v * rest / 2}, {"rest_s", rest}}};
}

Known down_the_slope(Chance& draw) {
  const double angle = draw(0.2, 0.7), mu = draw(0, 0.9) * std::tan(angle), v = draw(0, 5), t = instant(draw(0.5, 2));
  const double a = kG * (std::sin(angle) - mu * std::cos(angle));
  return {simulation(t, slope(angle)) + block(v, fmt::format("{:.17g}", mu), 10), {{"travel_m", v * t + a * t * t / 2}}};
}

Known stops_on_slope(Chance& draw) {
  const double angle = draw(0.05, 0.5), mu = draw(1.2, 1.8) * std::tan(angle), v = draw(1, 6);  // below the road's 1
  const double a = kG * (mu * std::cos(angle) - std::sin(angle));
  return {simulation(v / a + 0.5, slope(angle)) + block(v, fmt::format("{:.17g}", mu), 10),
          {{"travel_m", v * v / (2 * a)}, {"rest_s", v / a}}};
}

Known up_and_back(Chance& draw) {
  const double angle = draw(0.3, 0.7), mu = draw(0.1, 0.8) * std::tan(angle), v = draw(2, 6);
  const double up = kG * (std::sin(angle) + mu * std::cos(angle)), down = kG * (std::sin(angle) - mu * std::cos(angle));
  const double turn = v / up, t = instant(turn + draw(0.3, 1)), back = t - turn;
  return {simulation(t, slope(angle)) + block(-v, fmt::format("{:.17g}", mu), 10),
          {{"travel_m", std::abs(v * v / (2 * up) - down * back * back / 2)}}};
}

Known friction_ramp(Chance& draw) {
  const double m0 = draw(0.1, 0.4), m1 = draw(0.5, 0.9), ramp = draw(0.3, 1), v = draw(3, 8), k = (m1 - m0) / ramp;
  const auto speed = [&](double t) {
    const double on = std::min(t, ramp);
    return v - kG * (m0 * on + k * on * on / 2 + m1 * (t - on));
  };
  const auto way = [&](double t) {
    const double on = std::min(t, ramp), over = t - on;
    return v * on - kG * (m0 * on * on / 2 + k * on * on * on / 6) + speed(on) * over - kG * m1 * over * over / 2;
  };
  double low = 0, high = v / (kG * m0);
  for (int i = 0; i < 200; ++i) (speed((low + high) / 2) > 0 ? low : high) = (low + high) / 2;
  return {simulation(low + 0.5, "") + block(v, fmt::format("[[\"0 s\", {:.17g}], [\"{:.17g} s\", {:.17g}]]", m0, ramp, m1), 10),
          {{"travel_m", way(low)}, {"rest_s", low}}};
}

Known patch_edge(Chance& draw) {
  const double m0 = draw(0.1, 0.5), m1 = draw(0.5, 0.9), edge = draw(0.5, 2), after = draw(1, 5);
  const double v = std::sqrt(after * after + 2 * m0 * kG * edge);
  const std::string ground =
      fmt::format("[ground]\n[[ground.patch]]\nfrom = \"-9 -9 m\"\nto = \"{:.17g} 9 m\"\nfriction = {:.17g}\n", edge, m0);
  const double rest = (v - after) / (m0 * kG) + after / (m1 * kG);
  std::string point = block(v, fmt::format("{:.17g}", 1.0), 10);
  const auto at = point.find("0.3 0.3 0.03");
  point.replace(at, 12, "0.01 0.01 0.03");
  point.replace(point.find("exponent = 4"), 12, "exponent = 2");  // touches at its centre, however it tilts
  return {simulation(rest + 0.5, ground) +
              fmt::format("[[ground.patch]]\nfrom = \"{:.17g} -9 m\"\nto = \"99 9 m\"\nfriction = {:.17g}\n", edge, m1) + point,
          {{"travel_m", edge + after * after / (2 * m1 * kG)}, {"rest_s", rest}}};
}

Known landing(Chance& draw) {
  const double mu = draw(0.2, 0.8), height = draw(0.3, 2), vz = draw(0, 4), vx = draw(6, 12);
  const double rest = exact::projectile_rest(vx, vz, height, mu);
  return {
      simulation(rest + 0.5, "") +
          body("stone", fmt::format("mass = \"5 kg\"\naxes = \"0.05 0.05 0.01 m\"\nexponent = 4\ninertia = \"1e7 1e7 1e7 kg m^2\"\n"
                                    "position = \"0 0 {:.17g} m\"\nvelocity = \"{:.17g} 0 {:.17g} m/s\"\nfriction = {:.17g}\n",
                                    height + 0.01, vx, vz, mu)),
      {{"travel_m", exact::projectile_travel(vx, vz, height, mu)}, {"rest_s", rest}}};
}

Known flight(Chance& draw) {
  const double vx = draw(1, 30), vz = draw(3, 8), t = instant(draw(0.3, 0.9) * 2 * vz / kG), w = draw(-8, 8);
  const double turned = std::abs(std::remainder(w * t, 2 * kPi));
  std::string scene =
      simulation(t, "stop_at_rest = false") + ball("ball", 1, 0.1, "0 0 0.2", fmt::format("{:.17g} 0 {:.17g}", vx, vz), 0.5, 0.5);
  scene += fmt::format("angular_velocity = \"0 0 {:.17g} rad/s\"\n", w);
  return {scene, {{"travel_m", vx * t}, {"turned_deg", turned * 180 / kPi}}};
}

Known rebound(Chance& draw) {
  const double e = draw(0.3, 0.95), height = draw(0.3, 3), v = draw(0, 3), down = std::sqrt(2 * height / kG);
  const double t = instant(down * (1 + 2 * e * draw(0.6, 0.95)));
  return {simulation(t, "stop_at_rest = false") +
              ball("ball", 1, 0.1, fmt::format("0 0 {:.17g}", height + 0.1), fmt::format("{:.17g} 0 0", v), 0, e),
          {{"rebound_height_m", e * e * height}, {"travel_m", v * t}}};
}

Known wall(Chance& draw) {
  const double e = draw(0.2, 1), v = draw(0.5, 20), gap = draw(0.2, 3), t = instant(gap / v * draw(1.2, 3));
  return {simulation(t, kSpace) + ball("ball", draw(0.1, 50), 0.1, "0 0 0.1", fmt::format("{:.17g} 0 0", v), 0, e) +
              body("wall", fmt::format("fixed = true\naxes = \"0.5 3 3 m\"\nexponent = 30\nposition = \"{:.17g} 0 0.1 m\"\n"
                                       "friction = 0\nrestitution = {:.17g}\n",
                                       gap + 0.6, e)),
          {{"travel_m", std::abs(gap - e * (v * t - gap))}}};
}

/// Balls in a row, hit one after the other: speeds and places to any time by the events between neighbours.
Known chain(Chance& draw) {
  const int n = draw.whole(2, 5);
  const double e = draw(0.5, 1), radius = 0.1, t = instant(draw(0.6, 1.5));
  std::vector<double> x, v, m, start;
  for (int i = 0; i < n; ++i) {
    x.push_back(i == 0 ? 0 : x.back() + 2 * radius + draw(0.05, 0.3));
    v.push_back(i == 0 ? draw(0.5, 4) : 0);
    m.push_back(draw(0.5, 5));
  }
  start = x;
  const std::vector<double> v0 = v;
  for (double now = 0; now < t;) {
    double next = t;
    int pair = -1;
    for (int i = 0; i + 1 < n; ++i)
      if (v[i] > v[i + 1] + 1e-12)
        if (const double when = now + (x[i + 1] - x[i] - 2 * radius) / (v[i] - v[i + 1]); when < next) next = when, pair = i;
    for (int i = 0; i < n; ++i) x[i] += v[i] * (next - now);
    now = next;
    if (pair < 0) break;
    const double L = (1 + e) * (v[pair] - v[pair + 1]) / (1 / m[pair] + 1 / m[pair + 1]);
    v[pair] -= L / m[pair];
    v[pair + 1] += L / m[pair + 1];
  }
  Known out{simulation(t, kSpace), {}};
  for (int i = 0; i < n; ++i) {
    out.scene +=
        ball(fmt::format("b{}", i), m[i], radius, fmt::format("{:.17g} 0 0.1", start[i]), fmt::format("{:.17g} 0 0", v0[i]), 0, e);
    out.answers[fmt::format("travel_m b{}", i)] = std::abs(x[i] - start[i]);
  }
  return out;
}

/// Two smooth balls that meet off their centres: the line of centres takes the impulse.
Known oblique(Chance& draw) {
  const double r = 0.1, m1 = draw(0.5, 5), m2 = draw(0.5, 5), e = draw(0.3, 1), v = draw(1, 8), off = draw(-0.15, 0.15),
               gap = draw(0.5, 1.5);
  const double along = std::sqrt(4 * r * r - off * off), hit = (gap - along) / v, t = instant(hit + draw(0.2, 0.6));
  const double nx = along / (2 * r), ny = off / (2 * r), L = (1 + e) * v * nx / (1 / m1 + 1 / m2), after = t - hit;
  return {simulation(t, kSpace) + ball("a", m1, r, "0 0 0", fmt::format("{:.17g} 0 0", v), 0, e) +
              ball("b", m2, r, fmt::format("{:.17g} {:.17g} 0", gap, off), "0 0 0", 0, e),
          {{"travel_m a", std::hypot(v * t - L / m1 * nx * after, L / m1 * ny * after)}, {"travel_m b", L / m2 * after}}};
}

/// A ball with spin that bounces on a rough ground: impulses of Coulomb and Newton, one flight after the other.
Known spinning_bounce(Chance& draw) {
  const double r = 0.1, e = draw(0.6, 0.95), mu = draw(0.1, 0.8), height = draw(0.4, 1.5);
  double v = draw(-3, 3), w = draw(-50, 50), x = 0, z = height, vz = 0, left = instant(draw(0.8, 2));
  const double t = left, v0 = v, w0 = w;
  for (;;) {
    const double fall = (vz + std::sqrt(vz * vz + 2 * kG * z)) / kG;
    if (fall >= left) break;
    left -= fall;
    x += v * fall;
    vz -= kG * fall;
    const double N = -(1 + e) * vz, slip = v - w * r;  // per mass; a turn about y moves the lowest point by -w r
    const double T = std::clamp(-slip * 2 / 7, -mu * N, mu * N);
    v += T;
    w -= T * 5 / (2 * r);
    vz = -e * vz;
    z = 0;
  }
  x += v * left;
  std::string scene = simulation(t, "stop_at_rest = false") +
                      ball("ball", 1, r, fmt::format("0 0 {:.17g}", height + r), fmt::format("{:.17g} 0 0", v0), mu, e);
  scene += fmt::format("angular_velocity = \"0 {:.17g} 0 rad/s\"\n", w0);
  return {scene, {{"travel_m", std::abs(x)}}};
}

/// A ball set sliding: it slips until it rolls, and rolls on.
Known slips_then_rolls(Chance& draw) {
  const double v = draw(1, 8), mu = draw(0.1, 0.6), rolls = 2 * v / (7 * mu * kG), t = instant(rolls + draw(0.2, 1));
  const double x = v * rolls - mu * kG * rolls * rolls / 2 + 5 * v / 7 * (t - rolls);
  return {simulation(t, "stop_at_rest = false") + ball("ball", 1, 0.1, "0 0 0.1", fmt::format("{:.17g} 0 0", v), mu, 0),
          {{"travel_m", x}}};
}

Known rolls_down(Chance& draw) {
  const double angle = draw(0.1, 0.5), mu = draw(1.1, 2) * 2 / 7 * std::tan(angle), t = instant(draw(0.5, 2));
  return {simulation(t, slope(angle)) + ball("ball", 2, 0.1, "0 0 0.1", "0 0 0", mu, 0),
          {{"travel_m", 5.0 / 14 * kG * std::sin(angle) * t * t}}};
}

Known pendulum(Chance& draw) {
  const double a = draw(0.1, 2.5), l = draw(0.3, 1), m = draw(1, 10), I = draw(0.01, 0.3), t = instant(draw(0.5, 3));
  const double end = exact::pendulum_angle(a, std::sqrt(m * kG * l / (I + m * l * l)), t);
  return {
      simulation(t, "stop_at_rest = false\n[ground]\nkind = \"none\"") +
          body("rod", fmt::format("mass = \"{:.17g} kg\"\naxes = \"0.02 0.02 0.2 m\"\ninertia = \"{:.17g} {:.17g} 0.01 kg m^2\"\n"
                                  "position = \"{:.17g} 0 {:.17g} m\"\nattitude = \"0 {:.17g} 0 deg\"\n",
                                  m, I, I, -l * std::sin(a), 2 - l * std::cos(a), a * 180 / kPi)) +
          "[[joint]]\nkind = \"revolute\"\nchild = \"rod\"\nat = \"0 0 2 m\"\naxis = [0, 1, 0]\n",
      {{"travel_m", l * std::abs(std::sin(end) - std::sin(a))},
       {"turned_deg", std::abs(std::remainder(end - a, 2 * kPi)) * 180 / kPi}}};
}

std::string slider(double mass, double speed, const std::string& slide) {
  return body("slider",
              fmt::format(
                  "mass = \"{:.17g} kg\"\naxes = \"0.1 0.1 0.1 m\"\nposition = \"0 0 1 m\"\nvelocity = \"{:.17g} 0 0 m/s\"\n", mass,
                  speed)) +
         "[[joint]]\nkind = \"prismatic\"\nchild = \"slider\"\naxis = [1, 0, 0]\n[joint.slide]\n" + slide;
}

Known spring(Chance& draw) {
  const double m = draw(0.5, 10), w = draw(1, 20), rest = draw(0.1, 1), t = instant(draw(0.5, 2));
  return {simulation(t, "stop_at_rest = false") +
              slider(m, 0, fmt::format("stiffness = \"{:.17g} N/m\"\nrest = \"{:.17g} m\"\n", m * w * w, rest)),
          {{"travel_m", rest * (1 - std::cos(w * t))}}};
}

Known damper(Chance& draw) {
  const double m = draw(0.5, 10), rate = draw(0.3, 20), v = draw(1, 10), t = instant(draw(0.3, 1.5));
  return {simulation(t, "stop_at_rest = false") + slider(m, v, fmt::format("damping = \"{:.17g} N s/m\"\n", m * rate)),
          {{"travel_m", v / rate * -std::expm1(-rate * t)}}};
}

Known slide_friction(Chance& draw) {
  const double m = draw(0.5, 10), a = draw(1, 10), v = draw(1, 6);
  return {simulation(v / a + 0.5, "stop_at_rest = false") + slider(m, v, fmt::format("friction = \"{:.17g} N\"\n", m * a)),
          {{"travel_m", v * v / (2 * a)}}};
}

Known slide_stop(Chance& draw) {
  const double v = draw(0.5, 8), end = draw(0.1, 1), t = instant(end / v + draw(0.1, 0.5));
  return {simulation(t, "stop_at_rest = false") + slider(2, v, fmt::format("range = [\"-1 m\", \"{:.17g} m\"]\n", end)),
          {{"travel_m", end}}};
}

Known hinge_stop(Chance& draw) {
  const double w = draw(0.5, 6), end = draw(0.3, 1.5), t = instant(end / w + draw(0.1, 0.5)), l = 0.5;
  return {simulation(t, kSpace) +
              fmt::format("[[body]]\nname = \"rod\"\nmass = \"2 kg\"\naxes = \"0.02 0.02 0.4 m\"\nposition = \"0 0 {:.17g} m\"\n"
                          "velocity = \"{:.17g} 0 0 m/s\"\nangular_velocity = \"0 {:.17g} 0 rad/s\"\n"
                          "[[joint]]\nkind = \"revolute\"\nchild = \"rod\"\nat = \"0 0 2 m\"\naxis = [0, 1, 0]\nrange = [\"-3 "
                          "rad\", \"{:.17g} rad\"]\n",
                          2 - l, -w * l, w, end),
          {{"turned_deg", end * 180 / kPi}, {"travel_m", l * std::sin(end)}}};
}

std::string air(double density, double wind) {
  return fmt::format("[air]\ndensity = \"{:.17g} kg/m^3\"\nwind = \"{:.17g} 0 0 m/s\"\n", density, wind);
}

Known drag(Chance& draw) {
  const double m = draw(0.02, 1), v = draw(5, 60), rho = draw(0.5, 2), r = draw(0.03, 0.2), t = instant(draw(0.5, 2));
  const double k = 0.5 * rho * 1.2 * kPi * r * r / m;
  return {simulation(t, kSpace) + "\n" + air(rho, 0) + ball("ball", m, r, "0 0 1", fmt::format("{:.17g} 0 0", v), 0, 0),
          {{"travel_m", std::log1p(k * v * t) / k}}};
}

Known wind(Chance& draw) {
  const double m = draw(0.02, 1), W = draw(2, 40), rho = draw(0.5, 2), r = draw(0.03, 0.2), t = instant(draw(0.5, 2));
  const double k = 0.5 * rho * 1.2 * kPi * r * r / m;
  return {simulation(t, kSpace) + "\n" + air(rho, W) + ball("ball", m, r, "0 0 1", "0 0 0", 0, 0),
          {{"travel_m", W * t - std::log1p(k * W * t) / k}}};
}

Known tumbling(Chance& draw) {
  const double a = draw(0.02, 0.04), b = draw(0.045, 0.06), I[3] = {a, b, draw(0.061, a + b)},
               w[3] = {draw(-1, 1), draw(-8, 8), draw(-2, 2)};
  const double t = instant(draw(0.5, 5));
  return {simulation(t, kSpace) + body("body", fmt::format("mass = \"2 kg\"\naxes = \"0.3 0.2 0.08 m\"\ninertia = \"{:.17g} "
                                                           "{:.17g} {:.17g} kg m^2\"\nposition = \"0 0 1 m\"\n"
                                                           "angular_velocity_body = \"{:.17g} {:.17g} {:.17g} rad/s\"\n",
                                                           I[0], I[1], I[2], w[0], w[1], w[2])),
          {{"turned_deg", exact::free_body_turned(I, w, t) * 180 / kPi}}};
}

Known soft_ball(Chance& draw) {
  const double e = draw(0.2, 0.9), height = draw(0.5, 2), own = 1e3 * std::pow(10, draw(1.3, 4)), ground = 1e9;
  return {simulation(instant(2 * std::sqrt(2 * height / kG) + 0.3), "stop_at_rest = false\ncontact_law = \"compliant\"") +
              ball("ball", 1, 0.1, fmt::format("0 0 {:.17g}", height + 0.1), "0 0 0", 0, e) +
              fmt::format("stiffness = \"{:.17g} N/m\"\n", own),
          {{"rebound_height_m", exact::ball_rebound(e, height, 1, own * ground / (own + ground))}}};
}

constexpr Family kFamilies[] = {{"puck", puck},
                                {"down_the_slope", down_the_slope},
                                {"stops_on_slope", stops_on_slope},
                                {"up_and_back", up_and_back},
                                {"friction_ramp", friction_ramp},
                                {"patch_edge", patch_edge},
                                {"landing", landing},
                                {"flight", flight},
                                {"rebound", rebound},
                                {"wall", wall},
                                {"chain", chain},
                                {"oblique", oblique},
                                {"spinning_bounce", spinning_bounce},
                                {"slips_then_rolls", slips_then_rolls},
                                {"rolls_down", rolls_down},
                                {"pendulum", pendulum},
                                {"spring", spring},
                                {"damper", damper},
                                {"slide_friction", slide_friction},
                                {"slide_stop", slide_stop},
                                {"hinge_stop", hinge_stop},
                                {"drag", drag},
                                {"wind", wind},
                                {"tumbling", tumbling},
                                {"soft_ball", soft_ball}};

}  // namespace

std::span<const Family> families() {
  return kFamilies;
}

}  // namespace closed_forms
