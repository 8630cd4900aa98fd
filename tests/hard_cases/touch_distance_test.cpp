// An impact acts at the surface, however near others take part in it.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/simulate.h"

namespace hard_cases {
namespace {

using engine::Vec3;

constexpr double kSpeed = 3, kRestitution = 0.7, kDuration = 1, kGap = 1.9;  // [m/s] [-] [s] [m]

/// How far from its start a ball ends that strikes a fixed wall head on, without gravity and friction [m]
double travel(double step, double touch_distance) {
  engine::Model model;
  model.ground.plane = false;
  model.settings.gravity.setZero();
  model.settings.duration = kDuration;
  model.settings.step = step;
  model.settings.record_interval = kDuration;
  model.settings.stop_at_rest = false;
  model.settings.touch_distance = touch_distance;
  for (const bool wall : {false, true}) {
    engine::Body body;
    const engine::HyperEllipsoid shape{wall ? Vec3(0.5, 3, 3) : Vec3(0.1, 0.1, 0.1), wall ? 30.0 : 2.0};
    body.mass = 1;
    body.shape = shape;
    body.inertia_B = engine::principal_inertia(shape, 1).asDiagonal();
    body.fixed = wall;
    body.surface.restitution_body = kRestitution;
    body.surface.friction_body = 0;
    body.X_WB.p.x() = wall ? 0.1 + kGap + 0.5 : 0;
    body.V_WB.v.x() = wall ? 0 : kSpeed;
    model.bodies.push_back(body);
  }
  const engine::Recording run = engine::simulate(model);
  EXPECT_FALSE(run.failure);
  return run.snapshots.back().bodies[0].X_WB.p.x();
}

/// Closed form: kGap forth at v, the rest of the time back at e v. An impact a distance d early moves the end by (1 + e) d at most.
TEST(TouchDistance, MovesNoImpactWhichActsAtTheSurfaceItself) {
  const double exact = kGap - kRestitution * (kDuration * kSpeed - kGap);
  for (const double touch : {2e-5, 2e-6, 2e-7})
    for (const double step : {2e-3, 1e-3, 2.5e-4})
      EXPECT_LT(std::abs(travel(step, touch) - exact), (1 + kRestitution) * 1e-9) << touch << " " << step;
}

}  // namespace
}  // namespace hard_cases
