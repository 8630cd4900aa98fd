// Events inside a step: impacts at the surface itself, landings, edges and ramps of friction. Each is exact, or of second order.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/simulate.h"
#include "tests/engine/experiment.h"

namespace located_events_tests {
namespace {

using namespace engine;

Body round_body(const Vec3& axes, double exponent, const Vec3& at, const Vec3& velocity) {
  Body body = test::solid({axes, exponent}, 1, at);
  body.V_WB.v = velocity;
  return body;
}

/// A block so hard to turn that it is a point with friction.
Body block(const Vec3& at, const Vec3& velocity, const Schedule& friction) {
  Body body = round_body({0.02, 0.02, 0.005}, 2, at + Vec3(0, 0, 0.005), velocity);
  body.inertia_B = 50 * Mat3::Identity();
  body.surface.friction_ground = friction;
  return body;
}

Model on_ground(const Body& body, double duration, double step) {
  Model model;
  model.bodies = {body};
  model.settings.duration = duration;
  model.settings.step = step;
  model.settings.record_interval = duration;
  model.settings.stop_at_rest = false;
  return model;
}

double travel(const Model& model) {
  const Recording run = simulate(model);
  EXPECT_FALSE(run.failure);
  return run.snapshots.back().bodies[0].X_WB.p.x() - run.snapshots.front().bodies[0].X_WB.p.x();
}

/// The largest error over steps of about this length that share no phase with the event; each divides the run.
template <class ErrorAt>
double worst(double duration, double step, const ErrorAt& error_at) {
  double out = 0;
  for (const double share : {1.0, 0.94, 0.87, 0.81})
    out = std::max(out, std::abs(error_at(duration / std::round(duration / (share * step)))));
  return out;
}

TEST(LocatedEvents, AnImpactIsAtTheSurfaceItself) {
  // against a wall at 1 m: forth at v, back at e v. An impact a distance d off moves the end by (1 + e) d.
  constexpr double kEnd = 0.5, kRestitution = 0.7;
  for (const double speed : {3.0, 30.0}) {
    const auto error = [speed](double step) {
      Model model = on_ground(round_body({0.1, 0.1, 0.1}, 2, {0, 0, 0}, {speed, 0, 0}), kEnd, step);
      model.ground.plane = false;
      model.settings.gravity.setZero();
      model.bodies.push_back(round_body({0.5, 3, 3}, 30, {1.6, 0, 0}, {0, 0, 0}));
      model.bodies[1].fixed = true;
      for (Body& body : model.bodies) body.surface.restitution_body = kRestitution, body.surface.friction_body = 0;
      return travel(model) - (1 - kRestitution * (kEnd * speed - 1));
    };
    EXPECT_LT(worst(kEnd, 2e-3, error), 2e-9) << speed;
  }
}

TEST(LocatedEvents, ABallFallsOnTheGroundItself) {
  // after the bounce at e v it flies: z(t) = e v s - g s^2/2
  constexpr double kEnd = 0.8, kRestitution = 0.6, kHeight = 1.3;
  const double fall = std::sqrt(2 * kHeight / kGravity), after = kEnd - fall;
  const double exact = 0.1 + kRestitution * kGravity * fall * after - 0.5 * kGravity * after * after;
  const auto error = [&](double step) {
    Model model = on_ground(round_body({0.1, 0.1, 0.1}, 2, {0, 0, kHeight + 0.1}, {0, 0, 0}), kEnd, step);
    model.bodies[0].surface.restitution_ground = kRestitution;
    return simulate(model).snapshots.back().bodies[0].X_WB.p.z() - exact;
  };
  EXPECT_LT(worst(kEnd, 2e-3, error), 1e-8);
}

TEST(LocatedEvents, ALandingWithoutBounceIsExact) {
  // thrown flat from a height it loses mu v_z at the landing, by Coulomb's impulse, and slides on
  constexpr double kHeight = 0.9, kSpeed = 9, kFriction = 0.4, kEnd = 1.0;
  const double fall = std::sqrt(2 * kHeight / kGravity), left = kSpeed - kFriction * kGravity * fall, slide = kEnd - fall;
  const double exact = kSpeed * fall + left * slide - 0.5 * kFriction * kGravity * slide * slide;
  const auto error = [&](double step) {
    return travel(on_ground(block({0, 0, kHeight}, {kSpeed, 0, 0}, kFriction), kEnd, step)) - exact;
  };
  // a nanometre of the fall is two of the way along
  EXPECT_LT(worst(kEnd, 2e-3, error), 2e-9);
  EXPECT_LT(worst(kEnd, 0.5e-3, error), 2e-9);
}

TEST(LocatedEvents, AnEdgeOfAPatchIsOfSecondOrder) {
  // 0.2 up to x = 1 m, 0.7 beyond
  constexpr double kSpeed = 6, kEnd = 1.0;
  const double edge = std::sqrt(kSpeed * kSpeed - 2 * 0.2 * kGravity), reached = (kSpeed - edge) / (0.2 * kGravity);
  const double stopped = edge / (0.7 * kGravity), on = std::min(kEnd - reached, stopped);
  const double exact = 1 + edge * on - 0.5 * 0.7 * kGravity * on * on;
  const auto error = [&](double step) {
    Model model = on_ground(block({0, 0, 0}, {kSpeed, 0, 0}, 1.0), kEnd, step);
    model.ground.patches = {{{-9, -9, 0}, {1, 9, 0}, 0.2}, {{1, -9, 0}, {99, 9, 0}, 0.7}};
    return travel(model) - exact;
  };
  const double coarse = worst(kEnd, 4e-3, error), fine = worst(kEnd, 0.5e-3, error);
  EXPECT_LT(coarse, 1e-4);
  EXPECT_LT(fine, coarse / 16);  // an order of 4/3 and more over three halvings, whatever the phase
}

TEST(LocatedEvents, ARampAndAJumpOfFrictionAreOfSecondOrder) {
  // 0.2 to t = 0.1 s, a ramp to 0.4 at 0.3 s, there a jump to 0.6
  constexpr double kSpeed = 6, kEnd = 0.6;
  const double exact_speed_loss[] = {0.2 * 0.1, 0.3 * 0.2};
  const double v1 = kSpeed - kGravity * exact_speed_loss[0], x1 = kSpeed * 0.1 - 0.5 * kGravity * 0.2 * 0.01;
  const double v2 = v1 - kGravity * exact_speed_loss[1], x2 = x1 + v1 * 0.2 - kGravity * (0.5 * 0.2 * 0.04 + 1.0 / 6 * 0.008);
  const double exact = x2 + v2 * 0.3 - 0.5 * kGravity * 0.6 * 0.09;
  const Schedule friction({{0.1, 0.2}, {0.3, 0.4}, {0.3, 0.6}, {1, 0.6}});
  const auto error = [&](double step) { return travel(on_ground(block({0, 0, 0}, {kSpeed, 0, 0}, friction), kEnd, step)) - exact; };
  const double coarse = worst(kEnd, 8e-3, error), fine = worst(kEnd, 1e-3, error);
  EXPECT_LT(coarse, 3e-4);
  EXPECT_LT(fine, coarse / 16);
}

TEST(LocatedEvents, ASlipThatTurnsIsExact) {
  // up a slope of 25 degrees at 4 m/s; friction of 0.3 does not hold it there, and it comes back
  constexpr double kSlope = 25 * std::numbers::pi / 180, kFriction = 0.3, kSpeed = 4, kEnd = 1.2;
  const double up = kGravity * (std::sin(kSlope) + kFriction * std::cos(kSlope));
  const double down = kGravity * (std::sin(kSlope) - kFriction * std::cos(kSlope)), back = kEnd - kSpeed / up;
  const double exact = kSpeed * kSpeed / (2 * up) - 0.5 * down * back * back;
  const auto error = [&](double step) {
    Model model = on_ground(block({0, 0, 0}, {kSpeed, 0, 0}, kFriction), kEnd, step);
    model.settings.gravity = kGravity * Vec3(-std::sin(kSlope), 0, -std::cos(kSlope));
    return travel(model) - exact;
  };
  // 50 kg m^2 under the friction's moment of some 75 N m turn by 1e-7 rad before the ground stops them, over metres of slope
  EXPECT_LT(worst(kEnd, 4e-3, error), 1e-6);
}

TEST(LocatedEvents, AFlatSideLiesWhereItIsAndSlidesToItsRest) {
  // corners that stood micrometres above the side would let it sink by as much, and slide on by friction times that
  constexpr double kFriction = 0.5, kSpeed = 3, kEnd = 1;
  const double exact = kSpeed * kSpeed / (2 * kFriction * kGravity);
  double deepest = 0;
  const auto error = [&](double step) {
    Body box = round_body({0.3, 0.3, 0.03}, 4, {0, 0, 0.03}, {kSpeed, 0, 0});
    box.inertia_B = 1e7 * Mat3::Identity();
    box.surface.friction_ground = kFriction;
    const Recording run = simulate(on_ground(box, kEnd, step));
    deepest = std::max(deepest, std::abs(run.snapshots.back().bodies[0].X_WB.p.z() - 0.03));
    return run.snapshots.back().bodies[0].X_WB.p.x() - exact;
  };
  // an impact and a slip's end are placed within a nanometre; the body stands on the solver's residual
  EXPECT_LT(worst(kEnd, 4e-3, error), 5e-9);
  EXPECT_LT(deepest, 5e-9);
}

TEST(LocatedEvents, TheTimeOfRestIsSeenStepByStep) {
  // friction grows from 0.3 to 0.7 in 0.8 s: v = g (0.3 t + 0.25 t^2)
  constexpr double kSpeed = 2.5, kEnd = 1.2;
  const double exact = (-0.3 + std::sqrt(0.09 + kSpeed / kGravity)) / 0.5;
  const Schedule friction({{0, 0.3}, {0.8, 0.7}});
  const auto error = [&](double step) {
    Model model = on_ground(block({0, 0, 0}, {kSpeed, 0, 0}, friction), kEnd, step);
    model.settings.record_interval = 10 * step;
    for (const Event& event : simulate(model).events)
      if (event.kind == "rest") return event.time - exact;
    return kEnd;
  };
  // the mean loss of speed of one step for that of what is left, two steps at most: 1.5 h further on in the ramp, so 3 h^2 k/mu
  constexpr double kRate = 0.5, kAtRest = 0.55;
  EXPECT_LT(worst(kEnd, 4e-3, error), 3 * 4e-3 * 4e-3 * kRate / kAtRest);
  EXPECT_LT(worst(kEnd, 0.5e-3, error), 3 * 0.5e-3 * 0.5e-3 * kRate / kAtRest);
}

TEST(LocatedEvents, AStopOfAJointIsWhereItIs) {
  // a rod that turns freely, or falls as a pendulum, until its stop: there it stays
  constexpr double kArm = 0.5, kEnd = 1.6;
  for (const bool falls : {false, true})
    for (const double rate : {1.1, 2.2, 5.1}) {
      const auto error = [&](double step) {
        Model model = falls ? test::on_ground(kEnd, step) : test::free_space(kEnd, step);
        model.ground.plane = false;
        model.settings.record_interval = kEnd;
        model.bodies = {test::solid({{0.02, 0.02, 0.4}, 2}, 2, {kArm, 0, 0})};
        model.bodies[0].V_WB = {{0, 0, -rate * kArm}, {0, rate, 0}};
        Joint joint = test::joint_at(model, JointKind::revolute, -1, 0, Vec3::Zero());
        joint.angles[1].upper = falls ? 0.47 : 1.26;
        model.joints = {joint};
        const Vec3 at = simulate(model).snapshots.back().bodies[0].X_WB.p;
        return std::atan2(-at.z(), at.x()) - joint.angles[1].upper;
      };
      // the instant is placed to a nanoradian. What lies on its stop at angle a falls with A cos a, A = m g l / I, and is stopped
      // within each step by the mean of that: it sinks by A^2 h^4 sin a cos a / 24, at most a 48th of A^2 h^4
      const double most = kGravity * kArm / (kArm * kArm + 0.2 * (0.02 * 0.02 + 0.4 * 0.4));
      const auto sunk = [falls, most](double step) { return falls ? most * most * std::pow(step, 4) / 48 * kEnd / step : 0; };
      EXPECT_LT(worst(kEnd, 4e-3, error), 1e-9 + sunk(4e-3)) << falls << " " << rate;
      EXPECT_LT(worst(kEnd, 0.25e-3, error), 1e-9 + sunk(0.25e-3)) << falls << " " << rate;
    }
}

}  // namespace
}  // namespace located_events_tests
