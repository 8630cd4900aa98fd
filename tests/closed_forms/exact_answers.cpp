#include "tests/closed_forms/exact_answers.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace exact {
namespace {

/// Time [s] of flight and speed along the ground after landing.
struct Landing {
  double time, x, speed;
};
Landing landing(double vx, double vz, double height, double mu) {
  const double down = std::sqrt(vz * vz + 2 * kGravity * height);
  const double time = (vz + down) / kGravity;
  return {time, vx * time, std::max(0.0, vx - mu * down)};
}

/// Jacobi's cn and dn by descending Landen transformations (Abramowitz and Stegun, 16.4).
struct Jacobi {
  double sn, cn, dn;
};
Jacobi jacobi(double u, double k) {
  std::array<double, 30> a{}, c{};
  a[0] = 1;
  c[0] = k;
  double b = std::sqrt(1 - k * k);
  std::size_t n = 0;
  for (; std::abs(c[n]) > 1e-16 && n + 1 < a.size(); ++n) {
    a[n + 1] = 0.5 * (a[n] + b);
    c[n + 1] = 0.5 * (a[n] - b);
    b = std::sqrt(a[n] * b);
  }
  double phi = std::ldexp(a[n] * u, static_cast<int>(n));
  for (; n > 0; --n) phi = 0.5 * (phi + std::asin(c[n] * std::sin(phi) / a[n]));
  const double sn = std::sin(phi);
  return {sn, std::cos(phi), std::sqrt(1 - k * k * sn * sn)};
}

using Spin = std::array<double, 7>;  // w, quaternion

Spin rate(const double I[3], const Spin& y) {
  const double p = y[0], q = y[1], r = y[2], w = y[3], x = y[4], z2 = y[5], z = y[6];
  return {(I[1] - I[2]) / I[0] * q * r,    (I[2] - I[0]) / I[1] * r * p,   (I[0] - I[1]) / I[2] * p * q,
          0.5 * (-x * p - z2 * q - z * r), 0.5 * (w * p + z2 * r - z * q), 0.5 * (w * q + z * p - x * r),
          0.5 * (w * r + x * q - z2 * p)};
}

Spin plus(const Spin& y, double h, const Spin& d) {
  Spin out;
  for (std::size_t i = 0; i < y.size(); ++i) out[i] = y[i] + h * d[i];
  return out;
}

/// Modified midpoint with n parts.
Spin midpoint(const double I[3], const Spin& y, double H, int n) {
  const double h = H / n;
  Spin before = y, now = plus(y, h, rate(I, y));
  for (int i = 1; i < n; ++i) {
    const Spin next = plus(before, 2 * h, rate(I, now));
    before = now;
    now = next;
  }
  Spin out = plus(before, h, rate(I, now));
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = 0.5 * (out[i] + now[i]);
  return out;
}

}  // namespace

double projectile_travel(double vx, double vz, double height, double mu) {
  const Landing l = landing(vx, vz, height, mu);
  return l.x + l.speed * l.speed / (2 * mu * kGravity);
}
double projectile_rest(double vx, double vz, double height, double mu) {
  const Landing l = landing(vx, vz, height, mu);
  return l.time + l.speed / (mu * kGravity);
}

double puck_travel(double v, double mu) {
  return v * v / (2 * mu * kGravity);
}
double puck_rest(double v, double mu) {
  return v / (mu * kGravity);
}

double ball_rebound(double e, double height, double mass, double stiffness) {
  // S d^2/2 = m g (H + d); what comes back, e S d^2/2, lifts the ball from -d
  const double mg = mass * kGravity;
  const double d = (mg + std::sqrt(mg * mg + 2 * stiffness * mg * height)) / stiffness;
  return e * height - (1 - e) * d;
}

double pendulum_angle(double amplitude, double w, double t) {
  const double k = std::sin(0.5 * amplitude);
  const Jacobi j = jacobi(w * t, k);
  return 2 * std::asin(k * j.cn / j.dn);
}

double free_body_turned(const double I[3], const double w0[3], double t) {
  Spin y = {w0[0], w0[1], w0[2], 1, 0, 0, 0};
  const int steps = static_cast<int>(std::ceil(t / 0.02));
  const double H = t / steps;
  for (int s = 0; s < steps; ++s) {
    constexpr int kRows = 6;
    std::array<Spin, kRows> row;  // extrapolations of the latest number of parts, lowest order first
    for (int k = 0; k < kRows; ++k) {
      std::array<Spin, kRows> next;
      next[0] = midpoint(I, y, H, 2 * (k + 1));
      for (int j = 1; j <= k; ++j) {
        const double ratio = static_cast<double>(k + 1) / (k + 1 - j);
        for (std::size_t i = 0; i < y.size(); ++i)
          next[j][i] = next[j - 1][i] + (next[j - 1][i] - row[j - 1][i]) / (ratio * ratio - 1);
      }
      row = next;
    }
    y = row[kRows - 1];
  }
  const double norm = std::sqrt(y[3] * y[3] + y[4] * y[4] + y[5] * y[5] + y[6] * y[6]);
  return 2 * std::acos(std::min(1.0, std::abs(y[3]) / norm));
}

}  // namespace exact
