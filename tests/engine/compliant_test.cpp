// The compliant contact law against its closed forms, and what locating its events is worth.
#include <gtest/gtest.h>

#include "engine/laws/compliant_contact.h"
#include "engine/measure/metrics.h"
#include "tests/engine/experiment.h"
#include "tests/engine/hand_made_runs.h"

namespace {

using namespace engine;
using namespace engine::test;

Model dropped(double e, Scheme scheme, double step) {
  Model model = on_ground(0.8, step);
  model.settings.contact_law = ContactLaw::compliant;
  model.settings.scheme = scheme;
  model.settings.record_interval = step;
  model.bodies = {ball(0.1, 1, {0, 0, 1.1})};
  model.bodies[0].surface.restitution_ground = e;
  return model;
}

/// Height [m] the ball would rise to from its first instant in the air after the bounce.
double rebound(const Recording& run) {
  for (const Snapshot& s : run.snapshots) {
    const double z = s.bodies[0].X_WB.p.z() - 0.1, v = s.bodies[0].V_WB.v.z();
    if (s.time > 0.44 && v > 0 && z > 1e-3) return z + v * v / (2 * kGravity);
  }
  return 0;
}

TEST(CompliantBall, RisesToItsShareOfTheDrop) {
  // stiff, so that the weight's work over the depth, m g (1 - e) d with d = v sqrt(m/S) = 0.014 mm, is below 0.1 % of e too
  for (const Scheme scheme : {Scheme::rk4, Scheme::adaptive})
    for (const double step : {2e-3, 1e-3})
      for (const double e : {0.1, 0.25, 0.5, 0.9}) {
        Model model = dropped(e, scheme, step);
        model.bodies[0].surface.stiffness = 1e13;
        model.ground.surface.stiffness = 1e11;
        EXPECT_NEAR(rebound(simulate(model)), e, 1e-3 * e) << "e " << e << " step " << step;
      }
}

TEST(CompliantBall, SoftOneLosesWhatItsWeightTakesOverTheDepth) {
  // 1/2 S d^2 = m g (H + d); what comes back e S d^2/2 lifts the ball to e H - (1 - e) d
  const double S = 50e3, e = 0.5, H = 1;
  const double d = (kGravity + std::sqrt(kGravity * kGravity + 2 * S * kGravity * H)) / S;
  Model model = dropped(e, Scheme::rk4, 1e-3);
  model.bodies[0].surface.stiffness = S;
  model.ground.surface.stiffness = 1e13;
  // a step turns the spring by at most 0.3 rad, over which Runge-Kutta 4 keeps its energy to 1e-5
  EXPECT_NEAR(rebound(simulate(model)), e * H - (1 - e) * d, 1e-5);
}

TEST(CompliantBall, SteppingConvergesToIt) {
  // implicit and of first order: a bounce of some ten steps is right to a few per cent and twice as right at half the step
  const double S = 20e3, e = 0.5;
  const double d = (kGravity + std::sqrt(kGravity * kGravity + 2 * S * kGravity)) / S;
  const double exact = e - (1 - e) * d;
  double error[2];
  for (int k = 0; k < 2; ++k) {
    Model model = dropped(e, Scheme::stepping, k ? 1.25e-4 : 1e-3);
    model.bodies[0].surface.stiffness = S;
    model.ground.surface.stiffness = 1e13;
    error[k] = std::abs(rebound(simulate(model)) - exact);
  }
  EXPECT_LT(error[0], 0.05 * exact);
  EXPECT_LT(error[1], 0.4 * error[0]);
}

/// How deep [m] a head of 4.5 kg and 9 cm goes into a panel that covers the top of a fixed box, struck square on at `speed` [m/s],
/// and what energy the ledger cannot explain.
struct Dent {
  double depth = 0, unexplained = 0;
};
Dent head_into(Panel panel, double speed) {
  constexpr double kAbove = 5;  // [m] the ground has no part in it
  Model model;
  model.settings.contact_law = ContactLaw::persons_yield;
  model.settings.gravity = Vec3::Zero();
  model.settings.step = 1e-4;
  model.settings.record_interval = 1e-4;
  model.settings.duration = 0.06;
  model.bodies = {ball(0.09, 4.5, {0, 0, kAbove + 0.0905}), Body{}};
  model.bodies[0].person = 0;
  model.bodies[0].V_WB.v = {0, 0, -speed};
  model.bodies[0].surface.stiffness = 1e6;
  model.bodies[1].name = "car";
  model.bodies[1].fixed = true;
  model.bodies[1].X_WB.p.z() = kAbove;
  const auto mesh = box({-1, -1, -1}, {1, 1, 0});
  model.bodies[1].shape = MeshShape{mesh, Pose{}, 0, std::make_shared<Panels>(mesh->triangles().size(), panel)};
  model.persons = {of_one_part(0)};
  const Recording run = simulate(model);
  Dent out;
  for (const Snapshot& s : run.snapshots) {
    out.depth = std::max(out.depth, kAbove + 0.09 - s.bodies[0].X_WB.p.z());
    out.unexplained = std::max(out.unexplained, std::abs(s.energies.residual));
  }
  return out;
}

/// A roof, and beside it a sliver whose sharp corner points at it: the lines of its edges come within a hair of what lies far ahead
/// of the corner.
TEST(PanelAt, ASharpCornerIsAsFarAsItsPoint) {
  const TriangleMesh mesh(
      {{-0.02, -0.02, -9e-4}, {0.02, -0.02, -9e-4}, {0, 0.02, -9e-4}, {0.05, 0, 0}, {0.5, -1e-3, 0}, {0.5, 1e-3, 0}},
      {{0, 1, 2}, {3, 4, 5}});
  const Panels panels{Panel::roof, Panel::side};
  const Vec3 up = Vec3::UnitZ();
  EXPECT_EQ(panel_at(mesh, panels, {0, 0, 0}, up), Panel::roof);
  EXPECT_EQ(panel_at(mesh, panels, {0.3, 0, 0}, up), Panel::side);
  EXPECT_EQ(panel_at(mesh, panels, {0.3, 0, 0.05}, up), Panel::side);
  EXPECT_EQ(panel_at(mesh, panels, {0, 0, 0.2}, up), Panel::unknown);
  EXPECT_EQ(panel_at(mesh, panels, {0.3, 0, 0}, -up), Panel::unknown);
}

/// How much [-] of its room a pane gives that a head of 4.5 kg closing at v [m/s] does not leave to its film. The energy E beyond
/// what the film bears goes evenly over the way left until a twentieth of the room w is, then by E / w: E = E_0 exp(-y / w). The
/// head stops where its own is gone, E_0 exp(-y / w) = F (y - w).
double room_taken(double v, double F, double S, double room) {
  const double w = 0.05 * room, beyond = 0.05 * (0.5 * 4.5 * v * v - F * (room - 0.5 * F / S));
  double y = w;
  while (beyond * std::exp(-y / w) > F * (y - w)) y += 1e-4 * w;
  return 0.95 + y / room;
}

TEST(PanelRoom, APaneGivesWayUntilTheHeadIsThroughAndSheetMetalLess) {
  const double S_pane = stiffness_in_series(1e6, stiffness_of(Panel::windscreen));
  const double S_bonnet = stiffness_in_series(1e6, stiffness_of(Panel::bonnet));
  // what the spring bears: 1/2 m v^2 = 1/2 S d^2, to a step's way; the pane yields before, 1/2 m v^2 = F d - F^2 / 2 S
  const double F = yield_of(Panel::windscreen);
  EXPECT_NEAR(head_into(Panel::windscreen, 5).depth, 5 * std::sqrt(4.5 / S_pane), 5 * 1e-4);
  EXPECT_NEAR(head_into(Panel::windscreen, 10).depth, 0.5 * 4.5 * 100 / F + 0.5 * F / S_pane, 10 * 1e-4);
  EXPECT_NEAR(head_into(Panel::bonnet, 10).depth, 10 * std::sqrt(4.5 / S_bonnet), 10 * 1e-4);
  // what it does not is stopped at the end of the room, a tenth before the part would be taken for having gone through
  const double pane = 0.9 * 2 * 0.09, metal = 0.9 * 1.75 * 0.09;
  for (const double speed : {18.0, 22.0, 25.0}) {
    const Dent glass = head_into(Panel::windscreen, speed);
    EXPECT_NEAR(glass.depth, room_taken(speed, F, S_pane, pane) * pane, 1e-3 * pane) << speed;
    EXPECT_LT(glass.unexplained, 1e-3 * 0.5 * 4.5 * speed * speed);
  }
  for (const double speed : {22.0, 25.0}) {
    const Dent bonnet = head_into(Panel::bonnet, speed);
    EXPECT_GT(bonnet.depth, 0.94 * metal) << speed;
    EXPECT_LT(bonnet.depth, 1.01 * metal) << speed;
    EXPECT_LT(bonnet.unexplained, 1e-3 * 0.5 * 4.5 * speed * speed);
  }
}

TEST(CompliantBall, WithoutRestitutionDoesNotSpringBackWithinItsLastStep) {
  // the force of the approach must not go on past the turn: it would throw back by 0.3 to 4 m/s
  for (const double S : {5e3, 20e3, 100e3, 1e6}) {
    Model model = dropped(0, Scheme::stepping, 1e-3);
    model.bodies[0].surface.stiffness = S;
    model.ground.surface.stiffness = 1e13;
    double fastest = 0;
    for (const Snapshot& s : simulate(model).snapshots) fastest = std::max(fastest, s.bodies[0].V_WB.v.z());
    EXPECT_LT(fastest, 0.2) << S;  // of the thousandth of its energy that it keeps, and 4 g h
  }
}

constexpr double kNever = std::numeric_limits<double>::infinity();  // [N] yields

TEST(Bottoming, StopsWhatItsSpringCannotWithinTheRoom) {
  const double S = 200e3, mass = 3, room = 0.05, v_spring = room * std::sqrt(S / mass);
  EXPECT_EQ(bottoming_force(S, kNever, 0.01, std::sqrt(v_spring * v_spring - S * 1e-4 / mass) - 1e-9, mass, room), 0)
      << "the spring can";
  EXPECT_EQ(bottoming_force(S, kNever, 0.01, -30, mass, room), 0) << "parting";
  for (const double v0 : {1.01 * v_spring, 2 * v_spring, 30.0}) {
    // what the spring leaves over, evenly: F = (1/2 m v0^2 - 1/2 S room^2) / room all the way
    const double even = (0.5 * mass * v0 * v0 - 0.5 * S * room * room) / room, h = 1e-7;
    double depth = 1e-9, v = v0;
    while (v > 0 && depth < 0.9 * room) {
      const double force = bottoming_force(S, kNever, depth, v, mass, room);
      EXPECT_NEAR(force, even, 1e-2 * even) << v0;
      v -= h * (S * depth + force) / mass;
      depth += h * v;
    }
    EXPECT_GT(v, 0) << "it stops just at the end of the room";
  }
}

TEST(Bottoming, CountsOnNoMoreThanTheForceAtWhichASpringYields) {
  const double S = 50e3, yield = 3e3, mass = 4.5, room = 0.15;
  EXPECT_EQ(work_of_yielding_spring(S, yield, 0.04), 0.5 * S * 0.04 * 0.04);
  EXPECT_NEAR(work_of_yielding_spring(S, yield, room), yield * (room - 0.5 * yield / S), 1e-9);
  const double borne = std::sqrt(2 * work_of_yielding_spring(S, yield, room) / mass);
  EXPECT_EQ(bottoming_force(S, yield, 1e-9, borne - 1e-6, mass, room), 0);
  EXPECT_NEAR(bottoming_force(S, yield, 1e-9, 2 * borne, mass, room), 3 * 0.5 * mass * borne * borne / room, 1);
  // where it has yielded, its secant says the same
  EXPECT_NEAR(bottoming_force(yield / 0.1, yield, 0.1, 20, mass, room), bottoming_force(S, yield, 0.1, 20, mass, room), 1e-6);
}

TEST(CompliantBall, ComesToRestUnderItsWeight) {
  for (const Scheme scheme : {Scheme::stepping, Scheme::rk4}) {
    Model model = dropped(0.5, scheme, 1e-3);
    model.settings.duration = 6;
    model.bodies[0].surface.stiffness = 50e3;
    model.ground.surface.stiffness = 1e13;
    const BodyState end = simulate(model).snapshots.back().bodies[0];
    EXPECT_LT(end.V_WB.v.norm(), 1e-3);
    // the resting law stands between S and (1 + e)/2 S
    const double depth = 0.1 - end.X_WB.p.z();
    EXPECT_GT(depth, 0.99 * kGravity / 50e3);
    EXPECT_LT(depth, 1.01 * kGravity / (0.75 * 50e3));
  }
}

/// The books follow each impulse by the velocities at both ends of the step. The sum of force times velocity over the stages, which
/// they followed once, left 4 % of what a held box turned over unexplained.
TEST(CompliantLedger, ClosesForABoxHeldOnASlope) {
  for (const Scheme scheme : {Scheme::stepping, Scheme::rk4, Scheme::adaptive}) {
    Model model = on_ground(1);
    model.settings.contact_law = ContactLaw::compliant;
    model.settings.scheme = scheme;
    const double slope = 0.2;
    model.settings.gravity = {kGravity * std::sin(slope), 0, -kGravity * std::cos(slope)};
    model.bodies = {solid({{0.2, 0.15, 0.1}, 8}, 5, {0, 0, 0.1})};
    const Recording run = simulate(model);
    EXPECT_GT(run.diagnostics.energy_turned_over, 1e-3);
    EXPECT_LT(run.diagnostics.max_unexplained, 1e-6 * run.diagnostics.energy_turned_over);
  }
}

TEST(CompliantBox, SinksByItsWeightOverItsStiffnessHoweverManyPointsItStandsOn) {
  // a box (n = 30) stands on the four corners of its face, which share S; on a sheet too, where each corner has its triangle
  const double S = 50e3, m = 20;
  std::vector<Vec3> corners{{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}};
  for (const bool on_sheet : {false, true})
    for (const Scheme scheme : {Scheme::stepping, Scheme::rk4}) {
      Model model = on_ground(4);
      model.settings.contact_law = ContactLaw::compliant;
      model.settings.scheme = scheme;
      model.bodies = {solid({{0.3, 0.2, 0.1}, 30}, m, {0.01, 0.02, 0.1})};
      model.bodies[0].surface.stiffness = S;
      model.ground.surface.stiffness = 1e13;
      if (on_sheet) {
        model.ground.plane = false;
        model.ground.terrain = std::make_shared<TriangleMesh>(corners, std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}});
      }
      const BodyState end = simulate(model).snapshots.back().bodies[0];
      // the resting law of e = 0 stands between S and S/2; the corners of the face lie 0.2 mm above its middle
      EXPECT_GT(0.1 - end.X_WB.p.z(), 0.98 * m * kGravity / S) << on_sheet;
      EXPECT_LT(0.1 - end.X_WB.p.z(), 2.02 * m * kGravity / S + 3e-4) << on_sheet;
      EXPECT_LT(end.V_WB.v.norm(), 5e-3);
    }
}

TEST(CompliantBody, PressedInByItsThicknessIsWarnedOf) {
  Model model = dropped(0.5, Scheme::stepping, 1e-3);
  model.settings.effects["air_drag"] = Force::off;
  model.bodies[0].surface.stiffness = 200;  // m g / S alone is 5 cm, v sqrt(m / S) 0.3 m
  const Diagnostics soft = simulate(model).diagnostics;
  ASSERT_EQ(soft.warnings.size(), 1u);
  EXPECT_NE(soft.warnings[0].find("stiffness"), std::string::npos);
  EXPECT_GT(soft.max_compression, 0.1);
  model.bodies[0].surface.stiffness = 50e3;
  const Diagnostics firm = simulate(model).diagnostics;
  EXPECT_TRUE(firm.warnings.empty());
  EXPECT_NEAR(firm.max_compression, std::sqrt(2 * kGravity / 50e3), 0.05 * std::sqrt(2 * kGravity / 50e3));
}

/// A body thrown, turning, that bounces twice: where it is at the end.
Vec3 thrown(Scheme scheme, bool located, double step, long& stages) {
  Model model = on_ground(1.2, step);
  model.settings.contact_law = ContactLaw::compliant;
  model.settings.scheme = scheme;
  model.settings.locate_events = located;
  model.bodies = {ball(0.12, 5, {0, 0, 0.8})};
  model.bodies[0].V_WB = {{6, 0, 2}, {0, 3, 0}};
  model.bodies[0].surface.restitution_ground = 0.5;
  model.bodies[0].surface.friction_ground = 0.3;
  model.bodies[0].surface.stiffness = 20e3;
  const Recording run = simulate(model);
  for (const EffectCost& cost : run.costs)
    if (cost.effect == "ground_contact") stages = cost.calls;  // looks for contacts: the work of a run whatever its scheme
  return run.snapshots.back().bodies[0].X_WB.p;
}

TEST(LocatedEvents, AreWorthFiftyTimesThePlainSchemeAtEqualCost) {
  long work = 0, unused = 0;
  const Vec3 exact = thrown(Scheme::rk4, true, 2.5e-5, unused);
  const double located = (thrown(Scheme::rk4, true, 1e-3, work) - exact).norm();
  // plain steps that cost at least as much
  double step = 1e-3, plain = 0;
  for (long spent = 0; spent < work; step *= 0.8) plain = (thrown(Scheme::rk4, false, step, spent) - exact).norm();
  RecordProperty("gain", std::to_string(plain / located));
  EXPECT_GT(plain, 50 * located) << "plain " << plain << " located " << located << " step " << step;
}

TEST(Adaptive, HoldsItsTolerance) {
  long unused = 0;
  const Vec3 exact = thrown(Scheme::rk4, true, 2.5e-5, unused);
  Model model = on_ground(1.2, 0.01);
  double last = 1;
  for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
    model.settings.contact_law = ContactLaw::compliant;
    model.settings.scheme = Scheme::adaptive;
    model.settings.adaptive_tolerance = tolerance;
    model.bodies = {ball(0.12, 5, {0, 0, 0.8})};
    model.bodies[0].V_WB = {{6, 0, 2}, {0, 3, 0}};
    model.bodies[0].surface.restitution_ground = 0.5;
    model.bodies[0].surface.friction_ground = 0.3;
    model.bodies[0].surface.stiffness = 20e3;
    const double error = (simulate(model).snapshots.back().bodies[0].X_WB.p - exact).norm();
    EXPECT_LT(error, std::max(300 * tolerance, 1e-6)) << tolerance;  // some tens of steps, carried over half a second
    EXPECT_LT(error, last);
    last = error + 1e-9;
  }
}

TEST(Rk4, IsOfFourthOrderWithJointSpringsAndDampers) {
  auto swung = [](double step) {
    Model model = free_space(0.5, step);
    model.settings.gravity = {0, 0, -kGravity};
    model.settings.scheme = Scheme::rk4;
    model.bodies = {inert(2, {0.02, 0.03, 0.01}, {0, 0, -0.3}), inert(1, {0.01, 0.012, 0.004}, {0, 0, -0.8})};
    model.joints = {joint_at(model, JointKind::spherical, -1, 0, {0, 0, 0}),
                    joint_at(model, JointKind::ragdoll, 0, 1, {0, 0, -0.6})};
    model.bodies[0].V_WB.w = {1, 2, 0.5};
    model.bodies[0].V_WB.v = model.bodies[0].V_WB.w.cross(Vec3(0, 0, -0.3));
    model.bodies[1].V_WB.w = model.bodies[0].V_WB.w;
    model.bodies[1].V_WB.v = model.bodies[0].V_WB.w.cross(Vec3(0, 0, -0.8));
    for (JointCoordinate& a : model.joints[1].angles) a.stiffness = 3, a.damping = 0.05;
    return simulate(model).snapshots.back().bodies[1].X_WB.p;
  };
  const Vec3 exact = swung(1.0 / 8192);
  const double coarse = (swung(1.0 / 256) - exact).norm(), fine = (swung(1.0 / 512) - exact).norm();
  EXPECT_NEAR(std::log2(coarse / fine), 4, 0.3);
}

TEST(CompliantJoint, HasTheFrictionOfTheStepThatWasTaken) {
  // two parts on a joint with dry friction fall on a corner: events end steps anywhere inside, and friction must act over what is
  // left
  for (const Scheme scheme : {Scheme::rk4, Scheme::adaptive}) {
    Model model = on_ground(0.5);
    model.settings.contact_law = ContactLaw::compliant;
    model.settings.scheme = scheme;
    model.bodies = {solid({{0.15, 0.05, 0.05}, 2.5}, 3, {0, 0, 0.4}), solid({{0.15, 0.04, 0.04}, 2.5}, 1, {0.28, 0, 0.4})};
    model.bodies[1].name = "far";
    for (Body& body : model.bodies) body.V_WB.v = {2, 0, -3};
    model.joints = {joint_at(model, JointKind::ragdoll, 0, 1, {0.14, 0, 0.4})};
    model.bodies[0].V_WB.w = {0, 4, 1};
    model.bodies[1].V_WB.w = {0, 4, 1};
    model.bodies[1].V_WB.v += Vec3(0, 4, 1).cross(Vec3(0.28, 0, 0));
    for (JointCoordinate& a : model.joints[0].angles) a.friction = 1;
    const Recording run = simulate(model);
    double kinetic = run.snapshots.front().energies.kinetic, residual = 0, taken = 0;
    for (const Snapshot& s : run.snapshots) residual = std::max(residual, std::abs(s.energies.residual));
    for (std::size_t e = 0; e < run.costs.size(); ++e)
      if (run.costs[e].effect == "joint_resistance") taken = run.snapshots.back().energies.dissipated[e];
    RecordProperty("residual", std::to_string(residual / kinetic));
    RecordProperty("taken", std::to_string(taken));
    EXPECT_LT(residual, 0.02 * kinetic);
    EXPECT_GT(taken, 0);
    EXPECT_LT(taken, 0.5 * kinetic);
  }
}

TEST(HeadInjury, IsMeasuredWithTheCompliantLaw) {
  // a head-like ball against a wall-less world cannot be struck: the series itself is tested, sample by sample against dv/dt
  Model model = dropped(0.5, Scheme::rk4, 1e-4);
  model.bodies[0].person = 0;
  model.bodies[0].surface.stiffness = 50e3;
  model.persons = {of_one_part(0)};
  const Recording run = simulate(model);
  ASSERT_EQ(run.heads.size(), 1u);
  double sum = 0, peak = 0;
  for (std::size_t i = 0; i < run.heads[0].time.size(); ++i) {
    if (std::abs(run.heads[0].time[i] - 0.46) < 0.02) sum += run.heads[0].acceleration[i] * 1e-4;
    peak = std::max(peak, run.heads[0].acceleration[i]);
  }
  const double v = std::sqrt(2 * kGravity);
  // the change of speed in the bounce, and S d/m - g at the turn
  EXPECT_NEAR(sum, v * (1 + std::sqrt(0.5)), 0.06 * v);
  EXPECT_NEAR(peak, v * std::sqrt(50e3), 0.03 * v * std::sqrt(50e3));
  // the peak of every part is measured, the head's being that of its series
  std::vector<Metric> out;
  measure_segments(model, run, 0, out);
  ASSERT_EQ(out.size(), 1u);
  EXPECT_EQ(out[0].key, "peak_acceleration_mps2");
  EXPECT_EQ(out[0].object, model.bodies[0].name);
  EXPECT_EQ(out[0].value, peak);
  EXPECT_TRUE(simulate(on_ground(0.01)).peak_acceleration.empty());
}

}  // namespace
