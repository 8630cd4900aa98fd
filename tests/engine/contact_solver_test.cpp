// The impulses of contacts by themselves, without a step around them.
#include "engine/solver/contact_solver.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "tests/engine/experiment.h"

namespace engine {
namespace {

/// A box on three feet that comes down at 1 m/s, slides at `sliding` [m/s] and turns at `spin` [rad/s] about the vertical.
class BoxOnThreeFeet {
 public:
  BoxOnThreeFeet(double sliding, double spin, double friction) : articulation_(model()) {
    const std::vector<Pose> X_WB(1);
    articulation_.reset(topology_);
    articulation_.factor(topology_, 0, X_WB, nullptr);
    for (const Vec3& foot : {Vec3(0.5, 0.3, -0.4), Vec3(-0.6, 0.2, -0.4), Vec3(0.1, -0.4, -0.4)}) {
      Constraint c;
      set_bodies(c, model(), 0, -1);
      c.frame << 0, 1, 0, 0, 0, 1, 1, 0, 0;  // normal, t1, t2: z, x, y
      for (int r = 0; r < 3; ++r) {
        const Vec3 along = c.frame.col(r);
        c.a.J.row(r) << along.transpose(), foot.cross(along).transpose();
      }
      c.surface.friction = friction;
      c.response.free = c.response.whole = 1 / model().bodies[0].mass;
      c.u.free = c.a.J * (Vec6() << sliding, 0, -1, 0, 0, spin).finished();
      contacts.push_back(c);
    }
  }

  SolveReport solve(double tolerance) {
    std::vector<int> members(contacts.size());
    std::iota(members.begin(), members.end(), 0);
    ContactSolver solver;
    solver.reserve(topology_, contacts.size());
    solver.assemble(topology_, articulation_, contacts, members);
    return solver.solve(contacts, members, tolerance);
  }

  /// What the impulses leave of the feet's velocities, by the inertia of the box itself.
  std::vector<Vec3> velocities_after() const {
    const Body& box = model().bodies[0];
    Vec6 momentum = Vec6::Zero();
    for (const Constraint& c : contacts) momentum += c.a.J.transpose() * c.impulse;
    Vec6 V;
    V << momentum.head<3>() / box.mass, box.inertia_B.inverse() * momentum.tail<3>();
    std::vector<Vec3> out;
    for (const Constraint& c : contacts) out.push_back(c.u.free + c.a.J * V);
    return out;
  }

  std::vector<Constraint> contacts;

 private:
  static const Model& model() {
    static const Model made = [] {
      Model model;
      model.bodies = {test::inert(20, {1.2, 2.1, 2.5}, Vec3::Zero())};
      return model;
    }();
    return made;
  }

  Topology topology_ = build_topology(model(), {});
  Articulation articulation_;
};

/// Each foot slides another way, and turns as the others hold it. With a wrong slope along or across the slip Newton takes 13 to 27
/// steps.
TEST(ContactSolver, FrictionOpposesTheSlipThatItLeaves) {
  for (const double spin : {0.0, 3.0, -8.0})
    for (const double friction : {0.2, 0.5}) {
      BoxOnThreeFeet box(4, spin, friction);
      const SolveReport report = box.solve(1e-9);
      EXPECT_LE(report.residual, 1e-9) << spin << " " << friction;
      EXPECT_LE(report.newton_steps, 10) << spin << " " << friction;
      EXPECT_LE(report.sweeps, 4) << spin << " " << friction;
      const std::vector<Vec3> after = box.velocities_after();
      for (std::size_t i = 0; i < after.size(); ++i) {
        const Constraint& c = box.contacts[i];
        const Eigen::Vector2d slip = after[i].tail<2>(), held = c.impulse.tail<2>();
        ASSERT_GT(slip.norm(), 0.1) << "it slides";
        EXPECT_GE(c.impulse[0], 0);
        EXPECT_GE(after[i][0], -1e-9);
        EXPECT_NEAR(c.impulse[0] * after[i][0], 0, 1e-8);
        EXPECT_NEAR((held + friction * c.impulse[0] * slip.normalized()).norm(), 0, 1e-8)
            << spin << " " << friction << " foot " << i;
      }
    }
}

/// What sticks has no slip, and less friction than it might have.
TEST(ContactSolver, WhatSticksStaysWithinItsCone) {
  BoxOnThreeFeet box(0.1, 0.1, 0.9);
  EXPECT_LE(box.solve(1e-9).residual, 1e-11);
  const std::vector<Vec3> after = box.velocities_after();
  for (std::size_t i = 0; i < after.size(); ++i) {
    EXPECT_NEAR(after[i].norm(), 0, 1e-9);
    EXPECT_LE(box.contacts[i].impulse.tail<2>().norm(), 0.9 * box.contacts[i].impulse[0] + 1e-9);
  }
}

/// Boxes side by side, each pressed on its neighbour and on the ground.
class RowOfBoxes {
 public:
  explicit RowOfBoxes(double tilt, int boxes = kFew) : model_(row_of(boxes)), articulation_(model_) {
    articulation_.reset(topology_);
    std::vector<Pose> X_WB(model_.bodies.size());
    for (int tree = 0; tree < boxes; ++tree) articulation_.factor(topology_, tree, X_WB, nullptr);
    solver_.reserve(topology_, 2 * model_.bodies.size());
    for (int box = 0; box < boxes; ++box) {
      add_contact(box, -1, {0.1, 0.2, -0.5}, Vec3::UnitZ());
      if (box > 0) add_contact(box, box - 1, {-0.5, 0.1, 0.2}, Vec3::UnitX());
    }
    contacts.back().response.free = contacts.back().response.whole = 1e4;  // answers too little for this: it is softened
    solver_.assemble(topology_, articulation_, contacts, members());
    X_WB[1].q = Quat(Eigen::AngleAxisd(tilt, Vec3(1, 2, 3).normalized()));
    articulation_.factor(topology_, 1, X_WB, nullptr);
  }

  /// Impulses and the velocities they leave, from nothing, with the responses all anew or those of the second box.
  std::vector<Vec3> solution(const std::vector<char>* anew) {
    for (Constraint& c : contacts) c.impulse.setZero();
    solver_.assemble(topology_, articulation_, contacts, members(), anew);
    EXPECT_LE(solve(1e-9).residual, 1e-9);
    std::vector<Vec3> out;
    for (const Constraint& c : contacts) {
      out.push_back(c.impulse);
      out.push_back(c.u.after);
    }
    return out;
  }

  SolveReport solve(double tolerance, Begin by = Begin::newton) { return solver_.solve(contacts, members(), tolerance, by); }

  static constexpr int kFew = 4;
  std::vector<Constraint> contacts;

 private:
  void add_contact(int a, int b, const Vec3& point_A, const Vec3& normal) {
    Constraint c;
    set_bodies(c, model_, a, b);
    c.frame << normal, normal.unitOrthogonal(), normal.cross(normal.unitOrthogonal());
    for (int r = 0; r < 3; ++r) {
      const Vec3 along = c.frame.col(r);
      c.a.J.row(r) << along.transpose(), point_A.cross(along).transpose();
      if (b >= 0) c.b.J.row(r) << -along.transpose(), -(point_A + Vec3::UnitX()).cross(along).transpose();
    }
    c.surface.friction = 0.4;
    c.response.free = c.response.whole = 1e-3;
    c.u.free = Vec3(-1 - 0.1 * a, 0.3, -0.2 * a);
    contacts.push_back(c);
  }
  std::vector<int> members() const {
    std::vector<int> all(contacts.size());
    std::iota(all.begin(), all.end(), 0);
    return all;
  }
  static Model row_of(int boxes) {
    Model model;
    for (int k = 0; k < boxes; ++k) model.bodies.push_back(test::inert(5 + k, {1.2, 2.1, 2.5}, Vec3(k, 0, 0)));
    return model;
  }

  Model model_;
  Topology topology_ = build_topology(model_, {});
  Articulation articulation_;
  ContactSolver solver_;
};

/// What a second pass through a step asks for: one tree has other factors, and all else of the matrix stands.
TEST(ContactSolver, HasTheSameBitsWhereOnlyOneTreeIsAnew) {
  RowOfBoxes boxes(0.7), before(0);
  std::vector<char> anew(RowOfBoxes::kFew, 0);
  const std::vector<Vec3> unchanged = before.solution(nullptr);
  anew[1] = 1;
  const std::vector<Vec3> in_part = boxes.solution(&anew), whole = boxes.solution(nullptr);
  EXPECT_EQ(in_part, whole);
  double moved = 0;
  for (std::size_t i = 0; i < whole.size(); ++i) moved = std::max(moved, (whole[i] - unchanged[i]).norm());
  EXPECT_GT(moved, 0.01) << "the second box answers otherwise";
}

/// From nothing, each box pressed by the next: a hundred plain sweeps would leave 3 mm/s. A few boxes are not swept alone: there
/// Newton costs less.
TEST(ContactSolver, ConjugateSweepsFindWhatNewtonFinds) {
  constexpr int kMany = 12;
  constexpr double kTolerance = 1e-6;  // [m/s]
  RowOfBoxes swept(0.7, kMany), by_newton(0.7, kMany), few(0.7);
  const SolveReport report = swept.solve(kTolerance, Begin::sweeps);
  EXPECT_LE(report.residual, kTolerance);
  EXPECT_EQ(report.newton_steps, 0);
  EXPECT_GT(by_newton.solve(kTolerance).newton_steps, 0);
  for (std::size_t i = 0; i < swept.contacts.size(); ++i) {
    const Vec3& impulse = swept.contacts[i].impulse;
    EXPECT_NEAR((swept.contacts[i].u.after - by_newton.contacts[i].u.after).norm(), 0, 10 * kTolerance) << i;
    EXPECT_LE(impulse.tail<2>().norm(), 0.4 * impulse[0] + 1e-12) << i << " is in its cone";
  }
  EXPECT_GT(few.solve(kTolerance, Begin::sweeps).newton_steps, 0);
}

}  // namespace
}  // namespace engine
