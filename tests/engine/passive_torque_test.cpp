// Passive torques of the leg: the published curves, how they meet the joints, and their energy.
#include <gtest/gtest.h>

#include "engine/effects/passive_legs.h"
#include "tests/engine/experiment.h"

namespace {

using namespace engine;
using namespace engine::test;

constexpr double kDegree = std::numbers::pi / 180;

TEST(PassiveTorque, HasTheValuesOfThePublishedCurves) {
  // evaluated apart from the program, in the letters of the paper: hip, knee, ankle (plantarflexion) in degrees; moments in N m
  struct {
    double hip, knee, ankle, M_hip, M_knee, M_ankle;
  } const rows[] = {{0, 0, 0, 8.58151816, 10.41812376, 6.38690273},
                    {60, 30, -10, -3.97361443, 7.49931865, 9.41563821},
                    {-20, 10, 0, 25.17191699, -0.04891643, 5.06691672},
                    {90, 90, 30, 0.29772722, -4.87502313, -1.78599734},
                    {20, 120, 40, 8.24755627, -10.25584040, -2.67718963}};
  for (const auto& r : rows) {
    const PassiveTorques now = passive_torques(kDegree * Vec3(r.hip, r.knee, -r.ankle));
    EXPECT_LT((now.torque - Vec3(r.M_hip, r.M_knee, -r.M_ankle)).norm(), 1e-7);
  }
}

TEST(PassiveTorque, StiffnessIsMinusTheSlopeAndStaysBelowItsBound) {
  for (double hip = -30; hip <= 125; hip += 15)
    for (double knee = -5; knee <= 145; knee += 15)
      for (double ankle = -55; ankle <= 25; ankle += 16) {
        const Vec3 at = kDegree * Vec3(hip, knee, ankle);
        const PassiveTorques now = passive_torques(at);
        EXPECT_LT(now.stiffness.maxCoeff(), kStiffestPassiveTorque);
        for (int i = 0; i < 3; ++i) {
          const Vec3 e = 1e-6 * Vec3::Unit(i);
          const double slope = (passive_torques(at + e).torque[i] - passive_torques(at - e).torque[i]) / 2e-6;
          const bool at_end = (i == 0 && (hip == -30 || hip == 120)) || (i == 1 && (knee == -5 || knee == 145)) ||
                              (i == 2 && (ankle == -55 || ankle == 25));
          if (at_end) continue;
          EXPECT_NEAR(now.stiffness[i], -slope, 1e-4 * (1 + std::abs(slope))) << at.transpose();
        }
      }
}

TEST(PassiveTorque, FlexionIsTheFirstOfThreeTurnsAndItsGradientGivesItsRate) {
  Joint joint;
  const Pose X_WP{{1, 2, 3}, Quat(0.4, -0.3, 0.2, 0.7).normalized()};
  for (const int sense : {1, -1}) {
    joint.flexes_about = sense;
    const Quat q_PC = Eigen::AngleAxisd(sense * 1.1, Vec3::UnitY()) * Eigen::AngleAxisd(0.6, Vec3::UnitX()) *
                      Eigen::AngleAxisd(-0.4, Vec3::UnitZ());
    const Vec3 w(0.3, -0.8, 0.5);
    auto after = [&](double t) {
      return flexion_of(joint, X_WP, {X_WP.p, Quat(Eigen::AngleAxisd(t * w.norm(), w.normalized())) * X_WP.q * q_PC}).angle;
    };
    const Flexion now = flexion_of(joint, X_WP, {X_WP.p, X_WP.q * q_PC});
    EXPECT_NEAR(now.angle, 1.1, 1e-12);
    EXPECT_NEAR(now.gradient_W.dot(w), (after(1e-6) - after(-1e-6)) / 2e-6, 1e-8);
  }
}

/// A straight leg on hip, knee and ankle of a world that does not move, without gravity; `knees` joints share the knee's flexion.
Model leg(Scheme scheme, double step, int knees = 1) {
  Model model = free_space(0.5, step);
  model.settings.scheme = scheme;
  model.settings.record_interval = 0.05;
  auto hang = [&](double mass, const Vec3& inertia, double z, PassiveTorque passive, double joint_z, int sense) {
    const int parent = static_cast<int>(model.bodies.size()) - 1;
    model.bodies.push_back(inert(mass, inertia, {0, 0, z}));
    Joint joint = joint_at(model, passive == PassiveTorque::hip ? JointKind::ragdoll : JointKind::revolute, parent, parent + 1,
                           {0, 0, joint_z});
    joint.passive = passive;
    joint.flexes_about = sense;
    // two dampers in a row are half as stiff as one; without them the ball between two knees is held by nothing
    if (passive == PassiveTorque::knee) joint.angles[1].damping = knees;
    model.joints.push_back(joint);
  };
  hang(10, {0.19, 0.19, 0.04}, -0.2, PassiveTorque::hip, 0, -1);
  if (knees == 2) {
    hang(0.9, {2e-3, 2e-3, 2e-3}, -0.43, PassiveTorque::knee, -0.415, 1);
    hang(3.3, {0.04, 0.04, 0.004}, -0.65, PassiveTorque::knee, -0.445, 1);
  } else {
    hang(3.3, {0.04, 0.04, 0.004}, -0.65, PassiveTorque::knee, -0.43, 1);
  }
  hang(1, {0.001, 0.005, 0.005}, -0.88, PassiveTorque::ankle, -0.86, -1);
  return model;
}

TEST(PassiveTorque, FindsTheJointsOfALeg) {
  for (const int knees : {1, 2}) {
    const auto legs = passive_legs(leg(Scheme::rk4, 1e-3, knees));
    ASSERT_EQ(legs.size(), 1u);
    EXPECT_EQ(legs[0].hip, 0);
    EXPECT_EQ(legs[0].knees[0], 1);
    EXPECT_EQ(legs[0].knees[1], knees == 2 ? 2 : -1);
    EXPECT_EQ(legs[0].ankle, knees + 1);
  }
}

TEST(PassiveTorque, OfAHipAloneKeepsItsEnergy) {
  // M(h) = e^(a - b h) - e^(c + d h) + k has the potential U = (e^(a - b h)/b + e^(c + d h)/d - k h), angles in degrees
  auto potential = [](double h) {
    return kDegree * (std::exp(1.4655 - .0750 * h) / .0750 + std::exp(1.3403 + .0305 * h) / .0305 - 8.072 * h);
  };
  Model model = leg(Scheme::rk4, 1e-3);
  model.bodies.resize(1);
  model.joints.resize(1);
  model.bodies[0].V_WB.w = {0, -3, 0};
  model.bodies[0].V_WB.v = model.bodies[0].V_WB.w.cross(Vec3(0, 0, -0.2));
  model.settings.duration = 1;
  const Recording run = simulate(model);
  auto flexion = [&](const Snapshot& s) { return flexion_of(model.joints[0], Pose{}, s.bodies[0].X_WB).angle / kDegree; };
  const double initial = run.snapshots.front().energies.kinetic + potential(0);
  double most = 0, least = 0;
  for (const Snapshot& s : run.snapshots) {
    // fourth order: a swing of some 0.3 s in steps of 1 ms
    EXPECT_NEAR(s.energies.kinetic + potential(flexion(s)), initial, 1e-8 * initial);
    // the ledger's trapezium rule: P'' h^2 / 12 over the run, some 1e3 W/s^2 * 1e-6 s^2
    EXPECT_LT(std::abs(s.energies.residual), 1e-4);
    most = std::max(most, flexion(s));
    least = std::min(least, flexion(s));
  }
  EXPECT_GT(most, 20);
  EXPECT_LT(least, -5);
}

TEST(PassiveTorque, ClosesTheLedgerOfAWholeLegInBothSchemes) {
  for (const int knees : {1, 2})
    for (const Scheme scheme : {Scheme::stepping, Scheme::rk4}) {
      double residual[2];
      for (int k = 0; k < 2; ++k) {
        Model model = leg(scheme, k ? 2.5e-4 : 1e-3, knees);
        const Recording run = simulate(model);
        double kinetic = 0;
        residual[k] = 0;
        for (const Snapshot& s : run.snapshots) {
          kinetic = std::max(kinetic, s.energies.kinetic);
          residual[k] = std::max(residual[k], std::abs(s.energies.residual));
        }
        EXPECT_GT(kinetic, 1) << "the straight leg is not at rest: hamstrings and calf pull";
        EXPECT_LT(residual[k], 0.01 * kinetic);
      }
      // stepping is of first order, the ledger of rk4 of second
      EXPECT_LT(residual[1], residual[0] * (scheme == Scheme::stepping ? 0.35 : 0.12) + 1e-9) << knees;
    }
}

TEST(PassiveTorque, SchemesAgree) {
  for (const int knees : {1, 2}) {
    const Vec3 exact = simulate(leg(Scheme::rk4, 1e-4, knees)).snapshots.back().bodies.own().back().X_WB.p;
    EXPECT_LT((simulate(leg(Scheme::rk4, 1e-3, knees)).snapshots.back().bodies.own().back().X_WB.p - exact).norm(), 1e-5);
    EXPECT_LT((simulate(leg(Scheme::stepping, 1e-3, knees)).snapshots.back().bodies.own().back().X_WB.p - exact).norm(), 0.01);
  }
}

TEST(PassiveTorque, OfAKneeInTwoJointsIsThatOfOne) {
  // a light ball between the joints, both centres together: the same knee, its flexion shared as the torques have it
  auto foot = [](int knees) {
    Model model = leg(Scheme::rk4, 2.5e-4, knees);
    model.settings.duration = 0.2;
    const Recording run = simulate(model);
    const Snapshot& end = run.snapshots.back();
    const Vec3 shin = end.bodies[end.bodies.size() - 2].X_WB.q * -Vec3::UnitZ();
    return std::atan2(-shin.x(), -shin.z());
  };
  // the knee's own mass and its two centres, 3 cm apart, are the difference: some per cent
  EXPECT_NEAR(foot(2), foot(1), 0.1 * std::abs(foot(1)));
}

}  // namespace
