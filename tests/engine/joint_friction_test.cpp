// Dry friction of a joint against closed forms: it holds, it lets go, it stops what turns, and a blow does not feel it.
#include <gtest/gtest.h>

#include "tests/engine/experiment.h"

namespace {

using namespace engine;
using namespace engine::test;

constexpr double kMass = 2, kArm = 0.3, kInertia = 0.05;        // [kg], [m], [kg m^2] about the centre of mass
constexpr double kAboutHinge = kInertia + kMass * kArm * kArm;  // [kg m^2]
constexpr double kLever = kMass * 9.81 * kArm;                  // [N m] when horizontal

/// A level rod on a hinge of the world with the given friction; turns about y, downwards with positive angles.
Model rod(double friction_torque, Scheme scheme, double duration, double step, bool gravity = true) {
  Model model = free_space(duration, step);
  if (gravity) model.settings.gravity = {0, 0, -9.81};
  model.settings.scheme = scheme;
  model.settings.record_interval = 0.01;
  model.bodies = {inert(kMass, Vec3::Constant(kInertia), {kArm, 0, 0})};
  model.joints = {joint_at(model, JointKind::revolute, -1, 0, Vec3::Zero())};
  model.joints[0].angles[1].friction = friction_torque;
  return model;
}

double angle(const Snapshot& s) {
  const Vec3& p = s.bodies[0].X_WB.p;
  return std::atan2(-p.z(), p.x());
}

class JointFriction : public testing::TestWithParam<Scheme> {};
INSTANTIATE_TEST_SUITE_P(Scheme, JointFriction, testing::Values(Scheme::stepping, Scheme::rk4, Scheme::adaptive));

TEST_P(JointFriction, HoldsWhatIsWeaker) {
  const Recording run = simulate(rod(1.02 * kLever, GetParam(), 20, 1e-3));
  // gives way at 1e-5 rad/s and no faster
  EXPECT_LT(angle(run.snapshots.back()), 20 * 1e-5);
}

TEST_P(JointFriction, ASpringItHoldsDoesNotMakeItCreep) {
  Model model = rod(3, GetParam(), 20, 1e-3, false);
  model.joints[0].angles[1].stiffness = 50;
  model.joints[0].angles[1].damping = 2;
  model.joints[0].angles[1].rest = 0.05;  // 2.5 N m
  const Recording run = simulate(model);
  EXPECT_LT(std::abs(angle(run.snapshots.back())), 20 * 1e-5);
}

TEST_P(JointFriction, LetsGoOfWhatIsStronger) {
  // first 0.3 s by Runge and Kutta on theta'' = (m g l cos theta - T) / I in steps of 10 us
  for (const double share : {0.5, 0.9}) {
    double theta = 0, omega = 0;
    const double h = 1e-5;
    auto rate = [&](double t) { return kLever * (std::cos(t) - share) / kAboutHinge; };
    for (int k = 0; k < 30000; ++k) {
      const double k1 = rate(theta), k2 = rate(theta + 0.5 * h * omega), k3 = rate(theta + 0.5 * h * omega + 0.25 * h * h * k1);
      theta += h * omega + h * h / 6 * (k1 + k2 + k3);
      omega += h * rate(theta - 0.5 * h * omega);
    }
    double error[2];
    for (const int i : {0, 1}) {
      const Recording run = simulate(rod(share * kLever, GetParam(), 0.3, i ? 5e-4 : 1e-3));
      error[i] = std::abs(angle(run.snapshots.back()) - theta);
    }
    // it takes a few steps to break loose: of first order
    EXPECT_LT(error[0], 0.03 * theta) << share;
    EXPECT_LT(error[1], 0.55 * error[0]) << share;
  }
}

TEST_P(JointFriction, StopsWhatTurnsAfterItsClosedForm) {
  Model model = rod(1.5, GetParam(), 2, 1e-3, false);
  const double omega = 5;
  model.bodies[0].V_WB = {Vec3(0, 0, -omega * kArm), Vec3(0, omega, 0)};
  const Recording run = simulate(model);
  const double turned = 0.5 * kAboutHinge * omega * omega / 1.5;  // [rad] 1.92
  EXPECT_NEAR(angle(run.snapshots.back()), turned, 1e-3 * turned);
  EXPECT_LT(run.snapshots.back().bodies[0].V_WB.w.norm(), 1e-5);
}

TEST_P(JointFriction, ABlowTearsItLooseWithinAStep) {
  // a ball of 5 kg at 10 m/s on the tip of the resting rod; the friction takes T h from an angular momentum of 15 kg m^2/s
  auto struck = [&](double friction_torque) {
    Model model = rod(friction_torque, GetParam(), 0.02, 1e-3, false);
    model.settings.record_interval = 1e-3;
    model.bodies[0].shape = HyperEllipsoid{{0.3, 0.05, 0.05}, 2};
    model.bodies.push_back(ball(0.1, 5, {0.35, 0, 0.155}));
    model.bodies[1].V_WB.v = {0, 0, -10};
    const Recording run = simulate(model);
    return run.at(5e-3).bodies[0].V_WB.w.y();
  };
  const double without = struck(0), with = struck(10);
  EXPECT_GT(without, 5);
  EXPECT_NEAR(with, without, 1.5 * 10 * 5e-3 / kAboutHinge);
}

}  // namespace
