// Joints that slide, against closed forms and against textbook equations integrated by themselves.
#include <gtest/gtest.h>

#include <array>

#include "engine/joints/rows.h"
#include "tests/engine/experiment.h"

namespace {

using namespace engine;
using namespace engine::test;

// [m] A run keeps places on a grid of 1.5e-8 m about its first body: lengths that a model gives are good to that.
constexpr double kGrid = 3e-8;
constexpr double kMass = 2, kInertia = 0.05;  // [kg], [kg m^2]

/// Frame whose y points down a slope of 30 deg along x.
Quat down_the_slope() {
  const Vec3 y(std::cos(std::numbers::pi / 6), 0, -0.5);
  Mat3 R;
  R << Vec3(0, -1, 0), y, Vec3(0, -1, 0).cross(y);
  return Quat(R);
}
constexpr double kPull = kMass * kGravity * 0.5;  // [N] along the slope

/// A body on a rail of the world down the slope; what holds it is to be filled in.
Model on_a_rail(Scheme scheme, double duration, double step) {
  Model model = free_space(duration, step);
  model.settings.gravity = {0, 0, -kGravity};
  model.settings.scheme = scheme;
  model.settings.record_interval = step;
  model.bodies = {inert(kMass, Vec3::Constant(kInertia), {0.3, -0.2, 1})};
  model.joints = {joint_at(model, JointKind::prismatic, -1, 0, {0.1, 0.1, 1.2}, down_the_slope())};
  return model;
}

double way(const Model& model, const Snapshot& s) {
  return (s.bodies[0].X_WB.p - model.bodies[0].X_WB.p).dot(down_the_slope() * Vec3::UnitY());
}

class Prismatic : public testing::TestWithParam<Scheme> {};
INSTANTIATE_TEST_SUITE_P(Scheme, Prismatic, testing::Values(Scheme::stepping, Scheme::rk4, Scheme::adaptive));

TEST_P(Prismatic, SlidesDownASlopeAgainstADamper) {
  // v' = g sin a - c/m v: s = v_end (t - T (1 - exp(-t/T)))
  constexpr double kDamping = 6, kTime = kMass / kDamping, kEnd = kPull / kDamping;
  double error[2];
  for (const int i : {0, 1}) {
    Model model = on_a_rail(GetParam(), 1, i ? 1e-3 : 2e-3);
    model.joints[0].slide.damping = kDamping;
    const Recording run = simulate(model);
    const Snapshot& last = run.snapshots.back();
    error[i] = std::abs(way(model, last) - kEnd * (1 - kTime * (1 - std::exp(-1 / kTime))));
    // nothing across the rail, no turn, and the damper has what is missing
    EXPECT_LT((last.bodies[0].X_WB.p - model.bodies[0].X_WB.p - way(model, last) * (down_the_slope() * Vec3::UnitY())).norm(),
              1e-12);
    EXPECT_LT(last.bodies[0].X_WB.q.vec().norm(), 1e-12);
    EXPECT_LT(std::abs(last.energies.residual), (i ? 2e-3 : 4e-3) * kPull * way(model, last));
  }
  // linearly implicit over the step: of first order; in the stages: of fourth, at rounding already
  if (GetParam() == Scheme::stepping) {
    EXPECT_LT(error[1], 1e-3);
    EXPECT_NEAR(error[0] / error[1], 2, 0.1);
  } else {
    EXPECT_LT(error[0], 1e-9);
  }
}

/// What hangs on a spring at rest turns over no energy, however long.
TEST_P(Prismatic, HangsOnASpringAtNoCost) {
  Model model = on_a_rail(GetParam(), 2, 1e-3);
  model.joints[0].slide.stiffness = 200;
  model.joints[0].slide.damping = 4;
  model.joints[0].slide.rest = -kPull / 200;
  EXPECT_LT(std::abs(simulate(model).snapshots.back().energies.residual), 1e-9);
}

TEST_P(Prismatic, SwingsOnASpring) {
  // about where the spring carries it, with w = sqrt(k/m), for 1.6 swings
  constexpr double kStiffness = 200, kRest = 0.05, kMiddle = kRest + kPull / kStiffness;
  double error[2];
  for (const int i : {0, 1}) {
    Model model = on_a_rail(GetParam(), 1, i ? 5e-4 : 1e-3);
    model.joints[0].slide.stiffness = kStiffness;
    model.joints[0].slide.rest = kRest;
    error[i] = std::abs(way(model, simulate(model).snapshots.back()) - kMiddle * (1 - std::cos(std::sqrt(kStiffness / kMass))));
  }
  if (GetParam() == Scheme::stepping) {
    // at the mean of both ends a swing of w t radians is late by w t (w h)^2 / 12: of second order
    EXPECT_LT(error[1], kMiddle * 10 * 25e-6 / 12 + kGrid);
    EXPECT_NEAR(error[0] / error[1], 4, 0.2);
  } else {
    EXPECT_LT(error[1], 1e-9);
  }
}

/// A minute on an undamped spring, which keeps its swing; a spring too stiff for the step comes to rest, with no energy gained. An
/// instant every 10 ms misses the end of a swing by (w 5 ms)^2 / 2, a thousandth, at most.
TEST_P(Prismatic, KeepsItsSwingOnASpring) {
  for (const double stiffness : {200.0, 5e6}) {
    Model model = on_a_rail(GetParam(), 60, 1e-3);
    model.settings.record_interval = 0.01;
    model.joints[0].slide.stiffness = stiffness;
    const double middle = kPull / stiffness;
    double furthest = 0, late = 0;
    for (const Snapshot& s : simulate(model).snapshots) {
      furthest = std::max(furthest, std::abs(way(model, s) / middle - 1));
      if (s.time > 50) late = std::max(late, std::abs(way(model, s) / middle - 1));
    }
    EXPECT_LT(furthest, 1 + 1e-3) << stiffness;
    if (stiffness < 1000) {
      EXPECT_GT(late, 1 - 1e-3);
    }
  }
}

TEST_P(Prismatic, DryFrictionHoldsOrTakesItsForce) {
  Model model = on_a_rail(GetParam(), 2, 1e-3);
  model.joints[0].slide.friction = 1.02 * kPull;
  EXPECT_LT(std::abs(way(model, simulate(model).snapshots.back())), 2 * 1e-5);  // it gives way at 1e-5 m/s and no faster
  // half the pull: s = a t^2 / 2 with half of g sin a, late by the few steps in which it breaks loose
  model.joints[0].slide.friction = 0.5 * kPull;
  const double fallen = 0.5 * (0.5 * kPull / kMass) * 4;
  EXPECT_NEAR(way(model, simulate(model).snapshots.back()), fallen, 0.005 * fallen);
  // what slides on the level stops after m v^2 / 2F
  model.settings.gravity.setZero();
  model.bodies[0].V_WB.v = down_the_slope() * Vec3(0, 3, 0);
  model.joints[0].slide.friction = 12;
  const double stops = kMass * 9 / (2 * 12.0);
  EXPECT_NEAR(way(model, simulate(model).snapshots.back()), stops, 2e-3 * stops);
}

TEST_P(Prismatic, EndsAtAStop) {
  for (const double speed : {0.0, 4.0}) {
    Model model = on_a_rail(GetParam(), 1, 1e-3);
    model.bodies[0].V_WB.v = down_the_slope() * Vec3(0, speed, 0);
    model.joints[0].slide.lower = -0.3;
    model.joints[0].slide.upper = 0.4;
    const Recording run = simulate(model);
    for (const Snapshot& s : run.snapshots) EXPECT_LT(way(model, s), 0.4 + 9e-4);
    EXPECT_NEAR(way(model, run.snapshots.back()), 0.4, 1e-4);
    EXPECT_LT(run.snapshots.back().bodies[0].V_WB.v.norm(), 1e-9);
    EXPECT_LT(run.diagnostics.max_penetration, 9e-4);
    EXPECT_EQ(run.diagnostics.max_joint_angle_error, 0);
  }
}

TEST_P(Prismatic, TheStopIsADampedSpringWithTheCompliantLaw) {
  constexpr double kSpeed = 2, kStiffness = 5000;
  Model model = on_a_rail(GetParam(), 0.3, 1.25e-4);
  model.settings.gravity.setZero();
  model.settings.contact_law = ContactLaw::compliant;
  model.bodies[0].V_WB.v = down_the_slope() * Vec3(0, kSpeed, 0);
  // on the rail through the body's centre: its response there is 1/m
  model.joints = {joint_at(model, JointKind::prismatic, -1, 0, model.bodies[0].X_WB.p, down_the_slope())};
  model.joints[0].slide.upper = 0.1;
  model.joints[0].slide.stop_stiffness = kStiffness;
  double deepest = 0;
  for (const Snapshot& s : simulate(model).snapshots) deepest = std::max(deepest, way(model, s) - 0.1);
  const double exact = kSpeed / (std::exp(1.0) * std::sqrt(kStiffness / kMass));  // critical damping
  EXPECT_NEAR(deepest, exact, 0.015 * exact);
}

TEST(Prismatic, ThePlanTellsHowFarItsStopMayBePassed) {
  const auto left_out = [](const Model& model) {
    for (const PlanLine& line : compile(model).lines)
      if (std::string(line.effect) == "joint_limits") return line.left_out;
    return std::string();
  };
  Model model = on_a_rail(Scheme::stepping, 1, 1e-3);
  model.joints[0].slide.upper = 0.4;
  EXPECT_NE(left_out(model).find("passed by more than 0.9 mm has the step taken again"), std::string::npos) << left_out(model);
  model.joints[0].angles[0].upper = 1;
  EXPECT_NE(left_out(model).find("0.4 deg or 0.9 mm"), std::string::npos) << left_out(model);
  model.settings.contact_law = ContactLaw::compliant;
  EXPECT_EQ(left_out(model), "ends out of reach of a step");
}

TEST(Cylindrical, SlidesAndSpinsEachForItself) {
  for (const Scheme scheme : {Scheme::stepping, Scheme::rk4}) {
    constexpr double kSpin = 30, kThrust = 4, kDamping = 0.02;
    Model model = free_space(0.5);
    model.settings.gravity = {0, 0, -kGravity};
    model.settings.scheme = scheme;
    model.bodies = {inert(kMass, {0.03, 0.04, kInertia}, {0, 0, 2})};
    model.bodies[0].V_WB = {{0, 0, kThrust}, {0, 0, kSpin}};
    const Quat upright(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitX()));  // y of the frame up
    model.joints = {joint_at(model, JointKind::cylindrical, -1, 0, {0, 0, 1.5}, upright)};
    for (const double damping : {0.0, kDamping}) {
      model.joints[0].angles[1].damping = damping;
      const BodyState last = simulate(model).snapshots.back().bodies[0];
      EXPECT_NEAR(last.X_WB.p.z(), 2 + kThrust * 0.5 - 0.5 * kGravity * 0.25, 1e-12);
      EXPECT_NEAR(last.V_WB.v.z(), kThrust - kGravity * 0.5, 1e-12);
      // w = w0 exp(-c t / I); over the step implicit, off by h c / 2I of the exponent
      const double exponent = damping * 0.5 / kInertia;
      EXPECT_NEAR(last.V_WB.w.z(), kSpin * std::exp(-exponent),
                  kSpin * exponent * (scheme == Scheme::stepping ? 3e-4 : 1e-10) + 1e-12);
    }
  }
}

TEST(Cylindrical, AnEccentricBodySpinsSteadilyWhileItFalls) {
  // the rod takes the forces of the unbalanced mass; about and along it nothing acts but the weight
  Model model = free_space(0.5);
  model.settings.gravity = {0, 0, -kGravity};
  model.bodies = {inert(kMass, {0.03, 0.04, kInertia}, {0.2, 0, 2})};
  model.bodies[0].V_WB = {{0, 0.2 * 12, 0}, {0, 0, 12}};
  const Quat upright(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitX()));
  model.joints = {joint_at(model, JointKind::cylindrical, -1, 0, {0, 0, 2}, upright)};
  const Recording run = simulate(model);
  const BodyState& last = run.snapshots.back().bodies[0];
  EXPECT_NEAR(last.V_WB.w.z(), 12, 1e-9);
  EXPECT_NEAR(last.X_WB.p.z(), 2 - 0.5 * kGravity * 0.25, 1e-9);
  EXPECT_NEAR(last.X_WB.p.head<2>().norm(), 0.2, 1e-12);
  EXPECT_LT(run.diagnostics.max_joint_gap, 1e-9);
}

/// Four numbers that change, integrated by RK4.
using Four = std::array<double, 4>;
template <class Rate>
Four integrate(Four y, double time, int steps, Rate rate) {
  const double h = time / steps;
  auto moved = [](const Four& a, double by, const Four& d) {
    Four out;
    for (std::size_t i = 0; i < 4; ++i) out[i] = a[i] + by * d[i];
    return out;
  };
  for (int k = 0; k < steps; ++k) {
    const Four a = rate(y), b = rate(moved(y, h / 2, a)), c = rate(moved(y, h / 2, b)), d = rate(moved(y, h, c));
    for (std::size_t i = 0; i < 4; ++i) y[i] += h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]);
  }
  return y;
}

constexpr double kCart = 3, kBob = 1.5, kRod = 0.6, kBobInertia = 0.02;  // [kg], [kg], [m], [kg m^2]

/// A cart on a rail along x, a pendulum hinged to it, let go at 1 rad.
Model cart_and_pendulum(double duration, double step) {
  Model model = free_space(duration, step);
  model.settings.gravity = {0, 0, -kGravity};
  model.bodies = {inert(kCart, Vec3::Constant(0.1), {0, 0, 1}),
                  inert(kBob, Vec3::Constant(kBobInertia), {kRod * std::sin(1.0), 0, 1 - kRod * std::cos(1.0)})};
  const Quat along_x(Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitZ()));
  model.joints = {joint_at(model, JointKind::prismatic, -1, 0, {0, 0, 1}, along_x),
                  joint_at(model, JointKind::revolute, 0, 1, {0, 0, 1})};
  return model;
}

/// (x, angle from hanging towards +x, and their rates) by Lagrange:
/// (M + m) x'' + m l (a'' cos a - a'^2 sin a) = 0, (I + m l^2) a'' + m l x'' cos a = -m g l sin a.
Four textbook_cart(double time) {
  return integrate({0, 1, 0, 0}, time, 100000, [](const Four& y) -> Four {
    const double s = std::sin(y[1]), c = std::cos(y[1]), ml = kBob * kRod;
    const double A = kCart + kBob, B = ml * c, D = kBobInertia + ml * kRod;
    const double f = ml * y[3] * y[3] * s, g = -ml * kGravity * s, det = A * D - B * B;
    return {y[2], y[3], (D * f - B * g) / det, (A * g - B * f) / det};
  });
}

TEST(Prismatic, ACartAndItsPendulumMoveAsInTheTextbook) {
  const Four exact = textbook_cart(1.5);
  double error[2];
  for (const int i : {0, 1}) {
    const Model model = cart_and_pendulum(1.5, i ? 7.5e-3 : 1.5e-2);
    const Recording run = simulate(model);
    const auto& bodies = run.snapshots.back().bodies;
    const Vec3 hangs = bodies[1].X_WB.p - bodies[0].X_WB.p;
    error[i] = std::hypot(bodies[0].X_WB.p.x() - exact[0], std::atan2(hangs.x(), -hangs.z()) - exact[1]);
    EXPECT_NEAR(kCart * bodies[0].V_WB.v.x() + kBob * bodies[1].V_WB.v.x(), 0, 1e-11);  // nothing pushes along the rail
    EXPECT_LT(std::abs(run.snapshots.back().energies.residual), i ? 1e-5 : 1e-4);
  }
  EXPECT_LT(error[0], 1e-4);
  EXPECT_GT(std::log2(error[0] / error[1]), 3.7);
}

/// A bead on a spoke that turns about the world's z; the spoke's axis is y of the joint frame, its hinge 0.3 m off.
Model bead_on_a_spoke(bool bead_first, double duration, double step) {
  Model model = free_space(duration, step);
  model.bodies = {inert(1, Vec3::Constant(0.2), Vec3::Zero()), inert(0.5, Vec3::Constant(0.01), {0, 0.4, 0})};
  model.bodies[0].V_WB.w = model.bodies[1].V_WB.w = {0, 0, 5};
  model.bodies[1].V_WB.v = {-5 * 0.4, 0, 0};
  const Quat up(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitX()));
  const Joint hinge = joint_at(model, JointKind::revolute, -1, 0, Vec3::Zero(), up);
  const Joint slider = bead_first ? joint_at(model, JointKind::prismatic, 1, 0, {0, 0.3, 0})  //
                                  : joint_at(model, JointKind::prismatic, 0, 1, {0, 0.4, 0});
  model.joints = {hinge, slider};
  return model;
}

TEST(Prismatic, ABeadIsFlungOutAlongATurningSpoke) {
  // r'' = r w^2 with (I + m r^2) w constant, I of spoke and bead about their centres; whichever of the two is called the parent
  const double L = (0.21 + 0.5 * 0.16) * 5;
  const Four exact = integrate({0.4, 0, 0, 0}, 0.5, 100000, [&](const Four& y) -> Four {
    const double w = L / (0.21 + 0.5 * y[0] * y[0]);
    return {y[1], y[0] * w * w, w, 0};
  });
  for (const bool bead_first : {false, true}) {
    const Recording run = simulate(bead_on_a_spoke(bead_first, 0.5, 1e-3));
    const BodyState& bead = run.snapshots.back().bodies[1];
    EXPECT_NEAR(bead.X_WB.p.norm(), exact[0], kGrid) << bead_first;
    EXPECT_NEAR(std::atan2(-bead.X_WB.p.x(), bead.X_WB.p.y()), std::remainder(exact[2], 2 * std::numbers::pi), kGrid) << bead_first;
    EXPECT_LT(std::abs(run.snapshots.back().energies.residual), 1e-8) << bead_first;
    EXPECT_LT(run.diagnostics.max_joint_gap, 1e-6) << bead_first;
  }
}

/// Crank, rod and piston; the joint that closes the ring is the last of the list.
Model slider_crank(bool slider_last, double duration, double step) {
  constexpr double kCrank = 0.1, kRodLength = 0.3;
  Model model = free_space(duration, step);
  model.bodies = {inert(2, Vec3::Constant(0.02), {kCrank / 2, 0, 0}),
                  inert(1, Vec3::Constant(0.008), {kCrank + kRodLength / 2, 0, 0}),
                  inert(1.5, Vec3::Constant(0.005), {kCrank + kRodLength, 0, 0})};
  const double w = 20, rod = -w * kCrank / kRodLength;  // about y: the crank pin moves along -z
  model.bodies[0].V_WB = {{0, 0, -w * kCrank / 2}, {0, w, 0}};
  model.bodies[1].V_WB = {{0, 0, -w * kCrank / 2}, {0, rod, 0}};
  const Quat along_x(Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitZ()));
  const Joint main = joint_at(model, JointKind::revolute, -1, 0, Vec3::Zero());
  const Joint big_end = joint_at(model, JointKind::revolute, 0, 1, {kCrank, 0, 0});
  const Joint small_end = joint_at(model, JointKind::revolute, 1, 2, {kCrank + kRodLength, 0, 0});
  const Joint slider = joint_at(model, JointKind::prismatic, -1, 2, {kCrank + kRodLength, 0, 0}, along_x);
  if (slider_last)
    model.joints = {main, big_end, small_end, slider};
  else
    model.joints = {slider, main, big_end, small_end};
  return model;
}

TEST(Prismatic, ClosesTheRingOfASliderCrank) {
  double end[2];
  for (const bool slider_last : {false, true}) {
    const Recording run = simulate(slider_crank(slider_last, 1, 5e-4));
    for (const Snapshot& s : run.snapshots) {
      const Vec3& p = s.bodies[0].X_WB.p;
      const double c = p.x() / 0.05, sine = -p.z() / 0.05;
      EXPECT_NEAR(s.bodies[2].X_WB.p.x(), 0.1 * c + std::sqrt(0.09 - 0.01 * sine * sine), kGrid);
      EXPECT_NEAR(s.bodies[2].X_WB.p.z(), 0, 1e-12);
      EXPECT_LT(std::abs(s.energies.residual), 1e-6 * s.energies.kinetic);
    }
    end[slider_last] = run.snapshots.back().bodies[2].X_WB.p.x();
  }
  EXPECT_NEAR(end[0], end[1], kGrid);  // cut at the slider or at the small end: the same mechanism
}

/// A spring too stiff for the step is held stable, and loses its swing: that is told, with the step that keeps it. One with enough
/// of a damper has none to lose.
TEST(JointSpring, TellsWhatAStepDoesNotFollow) {
  for (const double step : {1e-3, 0.5e-3})
    for (const double damping : {0.0, 4e3}) {
      Model model = on_a_rail(Scheme::stepping, 0.02, step);
      model.joints[0].slide.stiffness = 1e6 * kMass;  // 1000 rad/s
      model.joints[0].slide.damping = damping;
      const Recording run = simulate(model);
      const bool lost = step > 0.7e-3 && damping == 0;
      ASSERT_EQ(run.diagnostics.warnings.size(), lost ? 1u : 0u) << step;
      if (lost) {
        EXPECT_NE(run.diagnostics.warnings[0].find("take a step below 0.707 ms"), std::string::npos);
      }
    }
}

TEST(MotionSubspace, IsWhatTheRowsLeaveFree) {
  for (int k = 0; k < static_cast<int>(JointKind::count); ++k) {
    const auto kind = static_cast<JointKind>(k);
    Joint joint;
    joint.kind = kind;
    joint.X_PF = {{0.1, 0.2, -0.3}, Quat(0.8, 0.1, -0.5, 0.3).normalized()};
    joint.X_CF = {{-0.2, 0.1, 0.4}, Quat(0.3, 0.7, 0.2, -0.6).normalized()};
    const Pose X_WP{{1, 2, 3}, Quat(0.5, -0.4, 0.6, 0.2).normalized()};
    const Pose X_WC = X_WP * joint.X_PF * joint.X_CF.inverse();
    JointRows rows;
    joint_rows(joint, X_WP, X_WC, rows);
    const JointType& type = type_of(kind);
    EXPECT_EQ(rows.count + type.slides() + type.turns(), 6) << type.name;
    const auto free = joint_coordinates(joint, X_WP, X_WC).free;
    EXPECT_EQ(free[kSlide], type.slides() == 1) << type.name;
    EXPECT_EQ(free[0] + free[1] + free[2], type.turns()) << type.name;
    const Mat6 S = motion_subspace(rows);
    for (int i = 0; i < 6 - rows.count; ++i) {
      EXPECT_NEAR(S.col(i).norm(), 1, 1e-12) << type.name;
      Vec6 V_C;  // of the child's centre
      V_C << S.col(i).head<3>() - S.col(i).tail<3>().cross(rows.r_C), S.col(i).tail<3>();
      for (int r = 0; r < rows.count; ++r) EXPECT_NEAR(row_on_child(rows, r).dot(V_C), 0, 1e-12) << type.name << " " << r;
    }
  }
}

}  // namespace
