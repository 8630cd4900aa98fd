// Contacts, friction and impacts against closed forms.
#include <gtest/gtest.h>

#include <random>

#include "engine/solver/contact_solver.h"
#include "engine/solver/one_contact.h"
#include "engine/world.h"
#include "tests/engine/experiment.h"

namespace engine::test {
namespace {

Body puck(double mu) {
  Body body = solid({{0.2, 0.2, 0.05}, 30}, 1, {0, 0, 0.05});
  body.surface.friction_ground = mu;
  return body;
}

/// Bodies are hyper-ellipsoids or meshes, vehicles meshes on tyres; what a tyre meets of ground and meshes is its suspension's, or
/// its vehicle's mesh brings the points of rim and flanks.
TEST(PairTable, HasOneRowForEveryTwoShapesThatCanMeet) {
  using enum ShapeKind;
  std::vector<ShapePair> missing = {{round, plane}, {round, terrain}, {round, mesh}, {round, tyre}, {round, round},
                                    {mesh, plane},  {mesh, terrain},  {mesh, mesh},  {tyre, tyre},  {round, round, true}};
  for (const PairKind& kind : pair_table()) {
    EXPECT_EQ(std::erase(missing, kind.shapes), 1u) << kind.name << ": twice in the table, or new";
    EXPECT_EQ(&pair_kind(kind.shapes), &kind);
    EXPECT_STREQ(name_of(kind.shapes), kind.name);
  }
  EXPECT_TRUE(missing.empty());
}

/// A guess: what turns evenly goes on so, what jumps, or was not looked for, does not.
TEST(PairMemory, ExpectsANormalToTurnOnAsItDid) {
  const auto turned = [](double angle) { return Vec3(std::cos(angle), std::sin(angle), 0); };
  PairMemory memory;
  EXPECT_EQ(memory.next_normal(), Vec3(0, 0, 0));
  memory.note_normal(turned(0), true);
  EXPECT_EQ(memory.next_normal(), turned(0));
  memory.note_normal(turned(0.01), true);
  EXPECT_NEAR((memory.next_normal() - turned(0.02)).norm(), 0, 2 * std::pow(0.01, 3));  // a chord for the arc: third order
  EXPECT_NEAR(memory.next_normal().norm(), 1, 1e-15);
  memory.note_normal(memory.next_normal(), false);
  EXPECT_EQ(memory.next_normal(), turned(0.01));
  memory.note_normal(turned(1), true);
  EXPECT_EQ(memory.next_normal(), turned(1));
}

TEST(Clearance, KeepsToWhatCannotHaveLeftYet) {
  // a limb 17 mm inside slides over a crack, where a look finds nothing of it, and on
  constexpr double kReach = 0.1;
  auto at = [](double x) { return Pose{{x, 0, 0}, Quat::Identity()}; };
  Clearance known;
  EXPECT_EQ(known.by_now(at(0), kReach), -std::numeric_limits<double>::infinity());
  known.note(-0.017, at(0), kReach);
  known.note(0, at(0.002), kReach);
  EXPECT_NEAR(known.least, -0.019, 1e-15);
  known.note(-0.0001, at(0.003), kReach);  // nor is another touch the one that was lost
  EXPECT_NEAR(known.least, -0.020, 1e-15);
  known.note(-0.0175, at(0.004), kReach);
  EXPECT_EQ(known.least, -0.0175);
  known.note(0, at(0.022), kReach);  // far enough to have left
  EXPECT_EQ(known.least, 0);
  known.note(0.05, at(0.08), kReach);
  EXPECT_EQ(known.least, 0.05);
}

class StepSize : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Steps, StepSize, testing::Values(2e-3, 1e-3, 5e-4));

TEST_P(StepSize, PuckStopsWhereCoulombFrictionSays) {
  Model model = on_ground(3, GetParam());
  model.settings.record_interval = GetParam();
  model.bodies = {puck(0.6)};
  model.bodies[0].V_WB.v = {13.4112, 0, 0};
  const Recording run = simulate(model);
  const double expected = 13.4112 * 13.4112 / (2 * 0.6 * kGravity);
  EXPECT_NEAR(run.snapshots.back().bodies[0].X_WB.p.x(), expected, 1e-3 * expected);
  double stopped = 0;
  for (const Snapshot& s : run.snapshots)
    if (s.bodies[0].V_WB.v.norm() > 1e-3) stopped = s.time;
  EXPECT_NEAR(stopped, 13.4112 / (0.6 * kGravity), 2 * GetParam() + 1e-3);
}

TEST_P(StepSize, HeldOnASlopeItDoesNotCreepAndAboveItSlidesAsItShould) {
  const double slope = 0.5;
  for (const double factor : {1.001, 0.999}) {
    Model model = on_ground(11, GetParam());
    model.settings.gravity = 9.81 * Vec3(std::sin(slope), 0, -std::cos(slope));  // the plane stays level, gravity leans
    const double mu = std::tan(slope) * factor;
    model.bodies = {puck(mu)};
    const Recording run = simulate(model);
    // the first second lets the body settle on its corners
    const double settled = run.at(1).bodies[0].X_WB.p.x();
    const double moved = run.snapshots.back().bodies[0].X_WB.p.x() - settled;
    if (factor > 1) {
      EXPECT_LT(std::abs(moved), 1e-6);
    } else {
      const double a = 9.81 * (std::sin(slope) - mu * std::cos(slope));
      const double v = run.at(1).bodies[0].V_WB.v.x();
      EXPECT_NEAR(moved, v * 10 + 0.5 * a * 100, 0.01 * moved);
    }
  }
}

TEST_P(StepSize, BallRisesToTheSquareOfRestitution) {
  for (const double e : {0.3, 0.5, 0.9}) {
    Model model = on_ground(0.46 + 0.46 * e * 1.2, GetParam());
    model.settings.record_interval = GetParam();
    model.bodies = {ball(0.1, 1, {0, 0, 1.1})};
    model.bodies[0].surface.restitution_ground = e;
    const Recording run = simulate(model);
    double lowest = 1, top = 0;
    for (const Snapshot& s : run.snapshots) {
      const double height = s.bodies[0].X_WB.p.z() - 0.1;
      lowest = std::min(lowest, height);
      if (s.bodies[0].V_WB.v.z() > 0) top = 0;
      if (lowest < 0.02 && s.time > 0.452) top = std::max(top, height);
    }
    EXPECT_NEAR(top, e * e, 1e-3 * e * e) << "e = " << e;
  }
}

TEST(Throw, SlidesToTheDistanceOfCoulombImpulses) {
  // s = (v cos + mu v sin)^2 / (2 mu g) + mu H: friction acts in the landing impulse too. A body that cannot turn stands for a
  // point.
  for (const double mu : {0.4, 0.6, 0.8}) {
    for (const double degrees : {0.0, 20.0, 40.0}) {
      const double theta = degrees * std::numbers::pi / 180, v = 11, H = 1;
      Model model = on_ground(6);
      Body body = ball(0.02, 1, {0, 0, H + 0.02});
      body.inertia_B = 1e6 * Mat3::Identity();
      body.surface.friction_ground = mu;
      body.V_WB.v = {v * std::cos(theta), 0, v * std::sin(theta)};
      model.bodies = {body};
      const double horizontal = v * (std::cos(theta) + mu * std::sin(theta));
      const double expected = horizontal * horizontal / (2 * mu * kGravity) + mu * H;
      EXPECT_NEAR(simulate(model).snapshots.back().bodies[0].X_WB.p.x(), expected, 5e-3 * expected) << mu << " " << degrees;
    }
  }
}

TEST(Sphere, RollsAwayWithFiveSeventhsOfItsSlidingSpeed) {
  const double v0 = 7, mu = 0.3, R = 0.1;
  Model model = on_ground(2);
  model.bodies = {ball(R, 1, {0, 0, R})};
  model.bodies[0].surface.friction_ground = mu;
  model.bodies[0].V_WB.v = {v0, 0, 0};
  const Recording run = simulate(model);
  EXPECT_NEAR(run.snapshots.back().bodies[0].V_WB.v.x(), 5.0 / 7 * v0, 1e-3);
  const double t = 2 * v0 / (7 * mu * kGravity), s = 12 * v0 * v0 / (49 * mu * kGravity);
  EXPECT_NEAR(run.at(t).bodies[0].X_WB.p.x(), s, 1e-3 * s);
}

TEST(Cradle, SharesTheImpactAsSimultaneousImpulsesDo) {
  Model model = free_space(0.05);
  for (int i = 0; i < 3; ++i) {
    model.bodies.push_back(ball(0.1, 1, {0.2 * i - (i == 0 ? 0.01 : 0), 0, 0}));
    model.bodies.back().surface.restitution_body = 1;
    model.bodies.back().surface.friction_body = 0;
  }
  model.bodies[0].V_WB.v = {1, 0, 0};
  const Recording run = simulate(model);
  const Snapshot& end = run.snapshots.back();
  EXPECT_LE(run.diagnostics.max_solver_residual, model.settings.solver_tolerance);
  EXPECT_NEAR(end.bodies[0].V_WB.v.x(), -1.0 / 3, 1e-7);
  EXPECT_NEAR(end.bodies[1].V_WB.v.x(), 2.0 / 3, 1e-7);
  EXPECT_NEAR(end.bodies[2].V_WB.v.x(), 2.0 / 3, 1e-7);
}

TEST(OneContact, SolvesSignoriniAndCoulomb) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 20000; ++trial) {
    Mat3 B;
    for (int i = 0; i < 9; ++i) B(i / 3, i % 3) = normal(random);
    const Mat3 A = B * B.transpose() + 0.3 * Mat3::Identity();
    const Vec3 b(normal(random), normal(random), normal(random));
    const double mu = std::abs(normal(random)) * 0.5, target = 0.1 * normal(random);
    const Vec3 L = solve_one_contact(A, b, target, mu, Vec3::Zero());
    const Vec3 u = A * L + b;
    if (A(0, 0) - mu * std::hypot(A(0, 1), A(0, 2)) <= 0.05 * A(0, 0)) continue;  // near Painleve a solution need not be unique
    const double slip = std::hypot(u[1], u[2]);
    const double rho = 1 / A.diagonal().maxCoeff();
    const Vec3 map = project_to_cone(L - rho * Vec3(u[0] - target + mu * slip, u[1], u[2]), mu);
    EXPECT_LT((L - map).norm(), 1e-6 * (1 + L.norm())) << "trial " << trial;
  }
}

TEST(Cone, NothingPullsEvenWithoutFriction) {
  for (const double mu : {0.0, 0.6}) {
    EXPECT_EQ(project_to_cone({-1, 0, 0}, mu), Vec3(0, 0, 0)) << mu;
    EXPECT_EQ(project_to_cone({2, 0, 0}, mu), Vec3(2, 0, 0)) << mu;
    Constraint open;  // parts at 1 m/s, and may close at 3
    open.surface.friction = mu;
    open.rows = 3;
    open.target = -3;
    EXPECT_EQ(natural_residual(open, {1, 0, 0}, Mat3::Identity()), 0) << mu;
  }
}

/// From grip to slide, locked or turning, the impulse follows the velocity without a jump. A law that jumps has states that no
/// impulse answers. It is steep where the wheel, about to slide sideways, goes over from its grip to the slide of a block.
TEST(Wheel, GoesFromGripToSlideWithoutAJump) {
  constexpr double kStep = 1e-5;  // [m/s]
  Mat3 A = Vec3(1 / 380.0, 1 / 420.0, 1 / 300.0).asDiagonal();
  A(1, 2) = A(2, 1) = 1 / 2000.0;
  Constraint tread;
  tread.kind = ConstraintKind::wheel;
  tread.rows = 3;
  tread.surface.friction = 0.8;
  tread.wheel.grip_softness = 1 / 60.0;  // 60 kN/rad at 10 m/s and 10 ms
  const Vec3 old(4, 0, 0);
  const double most = tread.surface.friction * old[0];
  int crossings = 0;
  for (const double braking : {0.0, 1.5, 1e9})
    for (const double driving : {0.0, 1.0}) {
      tread.wheel.braking = braking, tread.wheel.driving = driving;
      for (const double along : {-0.03, 0.0, 2e-3, 0.2}) {
        bool grips = false, slides = false;
        double largest = 0;
        Vec3 before = solve_wheel(A, {0, along, 0}, old, tread);
        for (double across = kStep; across < 0.3; across += kStep) {
          const Vec3 L = solve_wheel(A, {0, along, across}, old, tread);
          largest = std::max(largest, (L - before).norm() / most);
          const double used = L.tail<2>().norm() / most;
          EXPECT_LE(used, 1 + 1e-9);
          (used < 1 - 1e-9 ? grips : slides) = true;
          before = L;
        }
        // a slide that forgets the slip angle jumps by half of the circle
        EXPECT_LT(largest, 0.05) << braking << ' ' << driving << ' ' << along;
        crossings += grips && slides ? 1 : 0;
      }
    }
  EXPECT_GE(crossings, 6) << "of 24 that could";
}

TEST(RestingBox, NeitherHumsNorCreepsNorSinks) {
  for (const double tilt : {1e-6, 1e-4, 1e-2}) {
    Model model = on_ground(11);
    model.bodies = {solid({{0.2, 0.15, 0.1}, 30}, 5, {0, 0, 0.1 + 0.2 * tilt})};
    model.bodies[0].X_WB.q = Quat(Eigen::AngleAxisd(tilt, Vec3(0.6, 0.8, 0)));
    const Recording run = simulate(model);
    const BodyState settled = run.at(1).bodies[0];
    EXPECT_LT(settled.V_WB.v.norm(), 1e-3) << tilt;
    EXPECT_LT(settled.V_WB.w.norm(), 0.01) << tilt;
    EXPECT_LT((run.snapshots.back().bodies[0].X_WB.p - settled.X_WB.p).norm(), 1e-4) << tilt;
    double normal_force = 0;
    for (const ContactRecord& c : run.snapshots.back().contacts) normal_force += c.normal_force;
    EXPECT_NEAR(normal_force, 5 * kGravity, 0.01 * 5 * kGravity) << tilt;
    EXPECT_LT(run.diagnostics.rest_penetration, 5e-4) << tilt;
  }
}

TEST(Ledger, ClosesForABouncingSlidingBody) {
  Model model = on_ground(4);
  model.bodies = {solid({{0.3, 0.2, 0.15}, 2.5}, 10, {0, 0, 1})};
  model.bodies[0].V_WB = {{8, 0, 1}, {1, 3, 2}};
  model.bodies[0].surface.restitution_ground = 0.3;
  const Recording run = simulate(model);
  const double E0 = mechanical_energy(run.snapshots.front());
  EXPECT_LT(std::abs(run.snapshots.back().energies.residual), 5e-3 * E0);
  EXPECT_LT(run.diagnostics.max_energy_rise, 1e-3 * E0);
}

TEST(Determinism, SameModelSameBits) {
  Model model = on_ground(1);
  model.bodies = {puck(0.5), ball(0.1, 2, {0.5, 0.01, 0.6})};
  model.bodies[0].V_WB.v = {3, 0, 0};
  EXPECT_EQ(hash(simulate(model)), hash(simulate(model)));
}

}  // namespace
}  // namespace engine::test
