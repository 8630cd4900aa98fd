// Ends of the range of motion: rigid with Default-Auto, damped springs with the compliant law.
#include <gtest/gtest.h>

#include "tests/engine/experiment.h"

namespace {

using namespace engine;
using namespace engine::test;

constexpr double kInertia = 0.05;   // [kg m^2]
constexpr double kStiffness = 300;  // [N m/rad]
constexpr double kRate = 12;        // [rad/s]

/// A body on a hinge, turning at kRate into a stop 0.1 rad ahead.
Recording turned(ContactLaw law, Scheme scheme, double step, double duration = 0.2) {
  Model model = free_space(duration, step);
  model.settings.contact_law = law;
  model.settings.scheme = scheme;
  model.settings.record_interval = step;
  model.bodies = {inert(2, Vec3::Constant(kInertia), Vec3::Zero())};
  model.bodies[0].V_WB.w = {0, kRate, 0};
  model.joints = {joint_at(model, JointKind::revolute, -1, 0, Vec3::Zero())};
  model.joints[0].angles[1].upper = 0.1;
  model.joints[0].angles[1].stop_stiffness = kStiffness;
  return simulate(model);
}

double angle(const BodyState& body) {
  return 2 * std::atan2(body.X_WB.q.y(), body.X_WB.q.w());
}

/// Critical damping: depth = rate t exp(-w t) with w = sqrt(k / I), at most rate / (e w).
double deepest(const Recording& run) {
  double depth = 0;
  for (const Snapshot& s : run.snapshots) depth = std::max(depth, angle(s.bodies[0]) - 0.1);
  return depth;
}

double hardest(const Recording& run, double step) {
  double most = 0;
  for (std::size_t i = 1; i < run.snapshots.size(); ++i)
    most = std::max(most, std::abs(run.snapshots[i].bodies[0].V_WB.w.y() - run.snapshots[i - 1].bodies[0].V_WB.w.y()) / step);
  return most;
}

TEST(JointStop, IsADampedSpringWithTheCompliantLaw) {
  const double w = std::sqrt(kStiffness / kInertia), exact = kRate / (std::exp(1.0) * w);
  for (const Scheme scheme : {Scheme::stepping, Scheme::rk4, Scheme::adaptive}) {
    // the stop is reached anywhere within a step, and undamped until the next: of first order
    const double coarse = std::abs(deepest(turned(ContactLaw::compliant, scheme, 1e-3)) - exact) / exact;
    const double fine = std::abs(deepest(turned(ContactLaw::compliant, scheme, 1.25e-4)) - exact) / exact;
    EXPECT_LT(coarse, 0.15);
    EXPECT_LT(fine, 0.015);
  }
}

TEST(JointStop, GivesAnAccelerationThatTheStepDoesNotChange) {
  // 2 w rate at most, when it is reached; a rigid stop gives rate / step, whatever the step
  const double most = 2 * std::sqrt(kStiffness / kInertia) * kRate;
  for (const double step : {1e-3, 2.5e-4, 6.25e-5}) {
    EXPECT_LT(hardest(turned(ContactLaw::compliant, Scheme::stepping, step), step), 1.05 * most) << step;
    EXPECT_GT(hardest(turned(ContactLaw::compliant, Scheme::stepping, step), step), 0.8 * most) << step;
    EXPECT_GT(hardest(turned(ContactLaw::default_auto, Scheme::stepping, step), step), 0.45 * kRate / step) << step;
  }
}

TEST(JointStop, DoesNotThrowBackAndGainsNoEnergy) {
  const double initial = 0.5 * kInertia * kRate * kRate;
  for (const double step : {1e-2, 1e-3}) {
    const Recording run = turned(ContactLaw::compliant, Scheme::stepping, step, 1);
    for (const Snapshot& s : run.snapshots) {
      EXPECT_GT(s.bodies[0].V_WB.w.y(), -0.16 * kRate) << step;  // critical damping: exp(-2) = 0.14 of the rate at most
      EXPECT_LT(s.energies.kinetic, initial * (1 + 1e-9));
      EXPECT_NEAR(s.energies.residual, 0, 1e-9 * initial);
    }
  }
}

/// A beam falls on its stop and rests there, and a ball on the beam: what the stop displaces gravity works on, and the ball's
/// weight acts in the stages of rk4.
TEST(JointStop, KeepsItsBooksBesideContactsInTheStages) {
  for (const Scheme scheme : {Scheme::stepping, Scheme::rk4, Scheme::adaptive}) {
    Model model = on_ground(1.5);
    model.ground.plane = false;
    model.settings.contact_law = ContactLaw::compliant;
    model.settings.scheme = scheme;
    model.bodies = {solid({{0.5, 0.1, 0.05}, 2}, 4, {0.5, 0, 1}), ball(0.05, 1, {0.5, 0, 1.11})};
    for (Body& body : model.bodies) body.surface.friction_body = 0;
    model.joints = {joint_at(model, JointKind::revolute, -1, 0, {0, 0, 1})};
    model.joints[0].angles[1].upper = 0.02;
    model.joints[0].angles[1].stop_stiffness = 5e3;
    const Recording run = simulate(model);
    EXPECT_GT(run.diagnostics.energy_turned_over, 0.1);
    EXPECT_LT(run.diagnostics.max_unexplained, 1e-3 * run.diagnostics.energy_turned_over) << static_cast<int>(scheme);
  }
}

TEST(JointStop, IsRigidWithDefaultAuto) {
  const Recording run = turned(ContactLaw::default_auto, Scheme::stepping, 1e-3);
  EXPECT_LT(deepest(run), 1e-3);
  EXPECT_NEAR(run.snapshots.back().bodies[0].V_WB.w.y(), 0, 1e-9);
}

}  // namespace
