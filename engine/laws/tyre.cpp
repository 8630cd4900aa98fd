#include "engine/laws/tyre.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/math/functions.h"
#include "engine/math/roots.h"

namespace engine {
namespace {

constexpr double kSlowest = 1e-9;  // [m/s] below it a wheel stands
constexpr double kLockedSlip = 1;  // [-] longitudinal slip of a wheel that stands still, counted against the speed over ground

/// Value at a load from those at nominal and twice nominal load: the parabola through them and the origin.
double degressive(double at_1, double at_2, double p) {
  return p * (2 * at_1 - 0.5 * at_2 - (at_1 - 0.5 * at_2) * p);
}

SlipCurve at_load(const SlipCurve& one, const SlipCurve& two, double p, double friction) {
  SlipCurve out;
  out.slope = degressive(one.slope, two.slope, p);
  out.force_max = friction * degressive(one.force_max, two.force_max, p);
  out.force_sliding = friction * degressive(one.force_sliding, two.force_sliding, p);
  out.slip_max = friction * (one.slip_max + (two.slip_max - one.slip_max) * (p - 1));
  out.slip_sliding = friction * (one.slip_sliding + (two.slip_sliding - one.slip_sliding) * (p - 1));
  return out;
}

double norm(double x, double y) {
  return math::hypot(x, y);
}

/// Both directions joined.
struct Combined {
  SlipCurve curve;
  double scale_x = 1, scale_y = 1;  // [-] slips are divided by them
  double cos = 1, sin = 0;          // of the slip's direction after that
  double slip = 0;
};

Combined combine(const TmEasyTyre& tyre, double load, double mu, double s_x, double s_y) {
  // beyond four times the nominal load the parabola would turn down: no tyre is used there
  const double p = std::clamp(load / tyre.nominal_load, 1e-3, 3.0);
  const double friction = mu * tyre.nominal_load / tyre.x.force_max;
  const SlipCurve x = at_load(tyre.x, tyre.x2, p, friction), y = at_load(tyre.y, tyre.y2, p, friction);
  Combined out;
  const double reach_x = x.force_max / x.slope, reach_y = y.force_max / y.slope;
  out.scale_x = x.slip_max / (x.slip_max + y.slip_max) + reach_x / (reach_x + reach_y);
  out.scale_y = y.slip_max / (x.slip_max + y.slip_max) + reach_y / (reach_x + reach_y);
  const double n_x = s_x / out.scale_x, n_y = s_y / out.scale_y;
  out.slip = norm(n_x, n_y);
  if (out.slip > 0)
    out.cos = n_x / out.slip, out.sin = n_y / out.slip;
  else
    out.cos = 0, out.sin = 1;  // the limit that the lateral secant asks for
  out.curve.slope = norm(x.slope * out.scale_x * out.cos, y.slope * out.scale_y * out.sin);
  out.curve.slip_max = norm(x.slip_max / out.scale_x * out.cos, y.slip_max / out.scale_y * out.sin);
  out.curve.force_max = norm(x.force_max * out.cos, y.force_max * out.sin);
  out.curve.slip_sliding = norm(x.slip_sliding / out.scale_x * out.cos, y.slip_sliding / out.scale_y * out.sin);
  out.curve.force_sliding = norm(x.force_sliding * out.cos, y.force_sliding * out.sin);
  return out;
}

}  // namespace

Grip linear_grip(double load, double mu, double own, double saturation_angle, double v_x, double) {
  const double speed = std::abs(v_x);
  if (speed < kSlowest) return {std::numeric_limits<double>::infinity(), mu};
  return {own * load / (math::tan(saturation_angle) * speed), mu};
}

double force_of(const SlipCurve& c, double slip) {
  if (slip <= c.slip_max) {
    const double t = slip / c.slip_max;
    return c.slip_max * c.slope * t / (1 + t * (t + c.slope * c.slip_max / c.force_max - 2));
  }
  if (slip < c.slip_sliding) {
    const double t = (slip - c.slip_max) / (c.slip_sliding - c.slip_max);
    return c.force_max - (c.force_max - c.force_sliding) * t * t * (3 - 2 * t);
  }
  return c.force_sliding;
}

TmEasyTyre passenger_car_tyre(double nominal_load) {
  const double f = nominal_load / 4000;
  TmEasyTyre tyre;
  tyre.nominal_load = nominal_load;
  tyre.x = {120e3 * f, 0.11, 4400 * f, 0.50, 4250 * f};
  tyre.x2 = {200e3 * f, 0.10, 8700 * f, 0.80, 7600 * f};
  tyre.y = {55e3 * f, 0.20, 4200 * f, 0.80, 4150 * f};
  tyre.y2 = {80e3 * f, 0.22, 7500 * f, 1.00, 7400 * f};
  return tyre;
}

TyreForce tm_easy_force(const TmEasyTyre& tyre, double load, double mu, double s_x, double s_y) {
  if (load <= 0 || mu <= 0) return {};
  const Combined c = combine(tyre, load, mu, s_x, s_y);
  const double force = force_of(c.curve, c.slip);
  return {force * c.cos, force * c.sin};
}

Grip tm_easy_grip(const TmEasyTyre& tyre, double load, double mu, double v_x, double v_y, double asked) {
  if (load <= 0 || mu <= 0) return {};
  const double speed = std::abs(v_x);
  if (speed < kSlowest) return {std::numeric_limits<double>::infinity(), mu};
  const double s_y = std::abs(v_y) / speed;
  // the longitudinal force rises with s_x to its maximum: bisect below it
  double high = combine(tyre, load, mu, 1, 0).curve.slip_max * combine(tyre, load, mu, 1, 0).scale_x;
  high = std::min(kLockedSlip, 3 * high + s_y);
  double s_x = 0;
  if (asked > 0) {
    if (tm_easy_force(tyre, load, mu, high, s_y).longitudinal <= asked &&
        tm_easy_force(tyre, load, mu, 0.5 * high, s_y).longitudinal <= asked) {
      s_x = kLockedSlip;
    } else {
      math::bisect({0, high}, 30, 0, [&](double s) {
        s_x = s;
        return tm_easy_force(tyre, load, mu, s, s_y).longitudinal < asked;
      });
    }
  }
  const Combined c = combine(tyre, load, mu, s_x, s_y);
  const double force = force_of(c.curve, c.slip);
  const double secant = c.slip > 0 ? force / c.slip : c.curve.slope;
  // below the maximum the circle is that of the maximum, beyond it what the tyre still gives
  const double most = c.slip > c.curve.slip_max ? force : c.curve.force_max;
  return {secant / (c.scale_y * speed), most / load};
}

}  // namespace engine
