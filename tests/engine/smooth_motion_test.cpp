// Smooth motion against closed forms and published references.
#include <gtest/gtest.h>

#include "engine/math/same_bits.h"
#include "tests/engine/experiment.h"

namespace engine::test {
namespace {

constexpr double kDegrees = std::numbers::pi / 180;

double pendulum_period_ratio(double amplitude) {
  return 2 / std::numbers::pi * std::comp_ellint_1(std::sin(amplitude / 2));
}

TEST(Pendulum, HasThePeriodOfTheEllipticIntegral) {
  // rod 0.6 m from the hinge to its centre; started at 60 deg
  const double l = 0.6, amplitude = 60 * kDegrees;
  Model model = free_space(6);
  model.settings.gravity = {0, 0, -kGravity};
  model.settings.record_interval = 1e-3;
  model.bodies.push_back(inert(2, {0.1, 0.1, 0.02}, {-l * std::sin(amplitude), 0, -l * std::cos(amplitude)}));
  model.joints.push_back(joint_at(model, JointKind::revolute, -1, 0, {0, 0, 0}));
  const Recording run = simulate(model);
  std::vector<double> crossings;
  for (std::size_t i = 1; i < run.snapshots.size(); ++i) {
    const double a = run.snapshots[i - 1].bodies[0].X_WB.p.x(), b = run.snapshots[i].bodies[0].X_WB.p.x();
    if (a < 0 && b >= 0) crossings.push_back(run.snapshots[i - 1].time + 1e-3 * a / (a - b));
  }
  ASSERT_GE(crossings.size(), 3u);
  const double expected =
      2 * std::numbers::pi * std::sqrt((0.1 + 2 * l * l) / (2 * kGravity * l)) * pendulum_period_ratio(amplitude);
  // linear interpolation of the crossing over 1 ms errs by x'' h^2 / (8 x') < 1e-6 s
  EXPECT_NEAR((crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1), expected, 2e-6);
}

TEST(FreeBody, KeepsEnergyAndMomentumWhenItTumbles) {
  // Dzhanibekov: turned about its middle axis with a small disturbance
  for (const Scheme scheme : {Scheme::stepping, Scheme::rk4}) {
    Model model = free_space(100);
    model.settings.scheme = scheme;
    model.settings.record_interval = 0.1;
    model.bodies.push_back(inert(1, {1, 2, 3}, Vec3::Zero()));
    model.bodies[0].V_WB.w = {0.01, 5, 0.01};
    const Recording run = simulate(model);
    const double E0 = mechanical_energy(run.snapshots.front());
    const Vec3 L0 = angular_momentum(model, run.snapshots.front());
    bool turned_over = false;
    for (const Snapshot& s : run.snapshots) {
      EXPECT_NEAR(mechanical_energy(s) / E0, 1, 1e-8);
      EXPECT_LT((angular_momentum(model, s) - L0).norm() / L0.norm(), 1e-8);
      turned_over = turned_over || (s.bodies[0].X_WB.q.conjugate() * s.bodies[0].V_WB.w).y() < -4;
    }
    EXPECT_TRUE(turned_over);
  }
}

TEST(SymmetricBody, PrecessesAtTheRateOfTheClosedForm) {
  // transverse inertia I, axial I3: the axis turns about L at |L| / I
  const double I = 2, I3 = 1;
  Model model = free_space(5);
  model.bodies.push_back(inert(1, {I, I, I3}, Vec3::Zero()));
  model.bodies[0].V_WB.w = {3, 0, 4};
  const Vec3 L(I * 3, 0, I3 * 4);
  const double rate = L.norm() / I;
  const Recording run = simulate(model);
  const Vec3 expected = Eigen::AngleAxisd(rate * 5, L.normalized()) * Vec3::UnitZ();
  EXPECT_LT((run.snapshots.back().bodies[0].X_WB.q * Vec3::UnitZ() - expected).norm(), 1e-9);
}

TEST(HeavyTop, AgreesWithThePublishedQuaternion) {
  // 15 kg, centre of mass at body (0,1,0) from the fixed point; reference values at 0.2 s and 1 s of the common benchmark
  Model model = free_space(1);
  model.settings.gravity = {0, 0, -9.81};
  model.bodies.push_back(inert(15, {0.234375, 0.46875, 0.234375}, {0, 1, 0}));
  model.bodies[0].V_WB.w = {0, 150, -4.61538};
  model.bodies[0].V_WB.v = model.bodies[0].V_WB.w.cross(Vec3(0, 1, 0));
  model.joints.push_back(joint_at(model, JointKind::spherical, -1, 0, {0, 0, 0}));
  model.settings.step = 1e-4;  // 150 rad/s: RK4 needs it for 1e-6
  const Recording run = simulate(model);
  auto distance = [&](double time, const Eigen::Vector4d& wxyz) {
    const Quat q = run.at(time).bodies[0].X_WB.q;
    const Eigen::Vector4d got(q.w(), q.x(), q.y(), q.z());
    return std::min((got - wxyz).norm(), (got + wxyz).norm());
  };
  EXPECT_LT(distance(0.2, {-0.7082791530, 0.4387810881, 0.5457283961, 0.0893997528}), 2e-6);
  EXPECT_LT(distance(1.0, {0.7329439807, -0.2782857193, 0.5318246113, -0.3201761427}), 1e-5);
}

TEST(Babyboot, AgreesWithThePublishedAngles) {
  // Kane's double pendulum: A on a fixed hinge along x, plate B on A by a hinge along A's long axis; chaotic, so the step is fine.
  // Our hinges turn about y: the whole experiment is turned by 90 deg about z.
  Model model = free_space(10, 5e-4);
  model.settings.gravity = {0, 0, -9.81};
  model.settings.record_interval = 1e-3;
  const double qA = 90 * kDegrees, qB = 1 * kDegrees;
  const Quat turn(Eigen::AngleAxisd(qA, Vec3::UnitX()));  // A about x
  const Quat q_B = turn * Quat(Eigen::AngleAxisd(qB, Vec3::UnitZ()));
  Body A = inert(0.010, {50e-7, 50e-7, 1e-9}, turn * Vec3(0, 0, -0.075));
  A.X_WB.q = turn;
  Body B = inert(0.100, {2500e-7, 500e-7, 2000e-7}, turn * Vec3(0, 0, -0.20));
  B.X_WB.q = q_B;
  model.bodies = {A, B};
  const Quat y_to_x(Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitZ()));  // joint frame whose y axis is world x
  model.joints.push_back(joint_at(model, JointKind::revolute, -1, 0, {0, 0, 0}, y_to_x));
  const Quat y_to_z = turn * Quat(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitX()));  // y axis along A's long axis
  model.joints.push_back(joint_at(model, JointKind::revolute, 0, 1, turn * Vec3(0, 0, -0.1), y_to_z));
  const Recording run = simulate(model);
  double q_A_sum = qA, q_B_sum = qB;
  double last_A = qA, last_B = qB;
  for (const Snapshot& s : run.snapshots) {
    const Vec3 down = s.bodies[0].X_WB.q * -Vec3::UnitZ();
    const double a = std::atan2(down.y(), -down.z());
    const Quat rel = s.bodies[0].X_WB.q.conjugate() * s.bodies[1].X_WB.q;
    const double b = 2 * std::atan2(rel.z(), rel.w());
    q_A_sum += std::remainder(a - last_A, 2 * std::numbers::pi);
    q_B_sum += std::remainder(b - last_B, 2 * std::numbers::pi);
    last_A = a;
    last_B = b;
  }
  // RK4 at 0.5 ms; the motion multiplies a disturbance by some 1e4 in 10 s
  EXPECT_NEAR(q_A_sum / kDegrees, -61.3129835, 2e-3);
  EXPECT_NEAR(q_B_sum / kDegrees, -929.477898, 2e-2);
}

TEST(SpinningChain, StaysStraightWhateverTheMassRatio) {
  for (const double link_mass : {1.0, 0.05}) {
    Model model = free_space(2, 2.5e-4);
    model.settings.record_interval = 0.1;
    for (int i = 0; i < 20; ++i) {
      const double m = i == 0 || i == 19 ? 100 : link_mass;
      Body body = inert(m, m / 5 * Vec3(8e-4, 2.9e-3, 2.9e-3), {0.1 * (i - 9.5), 0, 0});
      body.V_WB = {Vec3(0, 0, 10).cross(body.X_WB.p), {0, 0, 10}};
      model.bodies.push_back(body);
      if (i > 0) model.joints.push_back(joint_at(model, JointKind::spherical, i - 1, i, {0.1 * (i - 10), 0, 0}));
    }
    const Recording run = simulate(model);
    const Vec3 across = run.snapshots.back().bodies[19].X_WB.p - run.snapshots.back().bodies[0].X_WB.p;
    EXPECT_NEAR(across.norm(), 1.9, 1e-6) << link_mass;
    EXPECT_NEAR(std::remainder(std::atan2(across.y(), across.x()) - 20, 2 * std::numbers::pi), 0, 1e-6) << link_mass;
    EXPECT_LT(run.diagnostics.max_joint_gap, 1e-9);
  }
}

/// Four bodies on joints of every kind, tumbling freely.
Model mixed_tree(double step) {
  Model model = free_space(1, step);
  model.settings.gravity = {0, 0, -9.81};
  const JointKind kinds[] = {JointKind::spherical, JointKind::universal, JointKind::revolute, JointKind::fixed};
  for (int i = 0; i < 5; ++i) {
    model.bodies.push_back(inert(1 + i, Vec3(0.02, 0.03, 0.04) * (1 + 0.3 * i), {0.3 * i, 0, 0}));
    if (i > 0) model.joints.push_back(joint_at(model, kinds[i - 1], i - 1, i, {0.3 * i - 0.15, 0, 0}));
  }
  // velocities that the joints allow: down the tree, each relative turn within its joint's freedom
  const Vec3 relative[] = {{1, 2, -1}, {1.5, -1, 0}, {0, 3, 0}, {0, 0, 0}};
  model.bodies[0].V_WB.w = {1, -2, 3};
  for (int i = 1; i < 5; ++i) {
    Twist& V = model.bodies[i].V_WB;
    const Twist& P = model.bodies[i - 1].V_WB;
    V.w = P.w + relative[i - 1];
    V.v = P.v + P.w.cross(Vec3(0.15, 0, 0)) - V.w.cross(Vec3(-0.15, 0, 0));
  }
  return model;
}

TEST(JointedBodies, ConvergeWithOrderFour) {
  auto end = [](double step) { return simulate(mixed_tree(step)).snapshots.back(); };
  const Snapshot finest = end(1.25e-4);
  auto error = [&](const Snapshot& s) {
    double worst = 0;
    for (std::size_t b = 0; b < s.bodies.size(); ++b)
      worst = std::max(worst, (s.bodies[b].X_WB.p - finest.bodies[b].X_WB.p).norm());
    return worst;
  };
  const double coarse = error(end(4e-3)), fine = error(end(2e-3));
  EXPECT_NEAR(std::log2(coarse / fine), 4, 0.3);
  EXPECT_LT(error(end(1e-3)), 1e-9);
}

/// Two balls on a smooth plane, with a joint half-way between them, that turn against each other.
Model balls_on_ice(double step) {
  Model model = on_ground(1, step);
  model.bodies = {ball(0.2, 3, {0, 0, 0.2}), ball(0.2, 2, {1, 0, 0.2})};
  for (Body& body : model.bodies) body.surface.friction_ground = body.surface.friction_body = 0;
  model.bodies[0].V_WB = {Vec3::Zero(), {0, 0, 6}};
  model.bodies[1].V_WB = {{0, 1, 0}, {0, 0, -4}};  // the joint goes along y at 3 m/s
  model.joints = {joint_at(model, JointKind::spherical, 0, 1, {0.5, 0, 0.2})};
  return model;
}

// What lies on something has its joint forces at both ends of a step only.
TEST(JointedBodies, ConvergeWithOrderTwoWhereTheyAreTouched) {
  auto end = [](double step) { return simulate(balls_on_ice(step)).snapshots.back(); };
  const Snapshot finest = end(6.25e-5);
  auto error = [&](const Snapshot& s) {
    return std::max((s.bodies[0].X_WB.p - finest.bodies[0].X_WB.p).norm(), (s.bodies[1].X_WB.p - finest.bodies[1].X_WB.p).norm());
  };
  const double coarse = error(end(2e-3)), fine = error(end(1e-3)), finer = error(end(5e-4));
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.2);
  EXPECT_NEAR(std::log2(fine / finer), 2, 0.2);
  // the trapezium rule is off by (w h)^2 / 12 of each turn: 10 rad in the run against each other, on half a metre
  EXPECT_LT(fine, 0.5 * 10 * 1e-2 * 1e-2 / 12);
  const Model model = balls_on_ice(1e-3);
  const Recording run = simulate(model);
  const Snapshot &first = run.snapshots.front(), &last = run.snapshots.back();
  EXPECT_NEAR(mechanical_energy(last) / mechanical_energy(first), 1, 1e-5);
  const Vec3 L = angular_momentum(model, first);
  EXPECT_LT((angular_momentum(model, last) - L).norm(), 1e-5 * L.norm());
}

// What spins far away takes its steps in four parts of four stages.
TEST(JointedBodies, MoveAsByThemselvesBesideWhatSpinsFast) {
  Model model = balls_on_ice(1e-3);
  const Snapshot alone = simulate(model).snapshots.back();
  model.bodies.push_back(ball(0.2, 1, {50, 0, 20}));
  model.bodies.back().V_WB.w = {0, 0, 200};
  const Snapshot beside = simulate(model).snapshots.back();
  for (std::size_t b = 0; b < 2; ++b) {
    EXPECT_TRUE(same_bits(beside.bodies[b].X_WB, alone.bodies[b].X_WB));
    EXPECT_EQ(beside.bodies[b].V_WB.v, alone.bodies[b].V_WB.v);
    EXPECT_EQ(beside.bodies[b].V_WB.w, alone.bodies[b].V_WB.w);
  }
}

// A ball on ice is touched and turns as if it were not. Inertia of a rod or of a disc makes its axis turn about L at |L| / I.
TEST(BallOnIce, PrecessesAtTheRateOfTheClosedForm) {
  constexpr double kStep = 1e-3, kEnd = 0.2;  // [s]
  const struct {
    double I, I3;                         // [kg m^2]
    Vec3 w;                               // [rad/s]
  } all[] = {{0.01, 0.001, {5, 0, 150}},  // axis at 16 rad/s: two stages, though it turns by 0.15 rad a step
             {0.01, 0.02, {10, 0, 24}},   // 49 rad/s: two stages
             {0.01, 0.02, {20, 0, 60}}};  // 122 rad/s: four stages
  for (const auto& [I, I3, w] : all) {
    Model model = on_ground(kEnd, kStep);
    model.bodies = {ball(0.2, 5, {0, 0, 0.2})};
    model.bodies[0].surface.friction_ground = 0;
    model.bodies[0].inertia_B = Vec3(I, I, I3).asDiagonal();
    model.bodies[0].V_WB.w = w;
    const Recording run = simulate(model);
    const Snapshot &first = run.snapshots.front(), &last = run.snapshots.back();
    const Vec3 L(I * w.x(), 0, I3 * w.z());
    const double rate = L.norm() / I, aside = L.x() / L.norm();  // [-] of the axis from L
    const Vec3 axis = Eigen::AngleAxisd(rate * kEnd, L.normalized()) * Vec3::UnitZ();
    // the trapezium rule is off by a twelfth of the square of what a step turns, spin or axis, of each turn of the axis
    const double turned = std::max(w.norm(), rate) * kStep, bound = rate * kEnd * aside * turned * turned / 12;
    EXPECT_LT((last.bodies[0].X_WB.q * Vec3::UnitZ() - axis).norm(), bound);
    EXPECT_LT((angular_momentum(model, last) - L).norm(), bound * L.norm());
    // what Heun's rule gains at 0.05 rad a step is 0.05^4 / 8 each, of the part that is aside
    EXPECT_NEAR(mechanical_energy(last) / mechanical_energy(first), 1, kEnd / kStep * 7.8e-7 * aside);
  }
}

TEST(JointedBodies, KeepEnergyMomentumAndJoints) {
  const Model model = mixed_tree(1e-3);
  const Recording run = simulate(model);
  const double E0 = mechanical_energy(run.snapshots.front()), E1 = mechanical_energy(run.snapshots.back());
  EXPECT_NEAR(E1 / E0, 1, 1e-8);
  EXPECT_LT(run.diagnostics.max_joint_gap, 1e-9);
}

}  // namespace
}  // namespace engine::test
