#include "cli/study/perturb.h"

#include <gtest/gtest.h>

namespace cli::study {
namespace {

engine::Model two_tied_bodies_and_a_free_one() {
  engine::Model model;
  model.bodies.resize(3);
  for (engine::Body& body : model.bodies) body.V_WB.v = {10, 0, 0};
  engine::Joint joint;
  joint.parent = 0;
  joint.child = 1;
  model.joints.push_back(joint);
  return model;
}

TEST(Perturb, MovesWhatIsTiedTogetherAsOne) {
  engine::Model model = two_tied_bodies_and_a_free_one();
  perturb(model, 1);
  EXPECT_EQ(model.bodies[0].X_WB.p, model.bodies[1].X_WB.p);
  EXPECT_EQ(model.bodies[0].V_WB.v, model.bodies[1].V_WB.v);
  EXPECT_NE(model.bodies[0].X_WB.p, model.bodies[2].X_WB.p);
  for (const engine::Body& body : model.bodies) {
    EXPECT_LE(body.X_WB.p.cwiseAbs().maxCoeff(), kPerturbedPosition);
    EXPECT_NEAR(body.V_WB.v.x(), 10, 10 * kPerturbedSpeed);
  }
}

TEST(Perturb, LeavesWhatHangsOnTheWorldInItsPlace) {
  engine::Model model = two_tied_bodies_and_a_free_one();
  model.joints[0].parent = -1;
  perturb(model, 1);
  EXPECT_TRUE(model.bodies[1].X_WB.p.isZero(0));
  EXPECT_FALSE(model.bodies[0].X_WB.p.isZero(0));
}

TEST(Perturb, IsTheSameForTheSameMember) {
  engine::Model a = two_tied_bodies_and_a_free_one(), b = a, c = a;
  perturb(a, 3);
  perturb(b, 3);
  perturb(c, 4);
  EXPECT_EQ(a.bodies[2].X_WB.p, b.bodies[2].X_WB.p);
  EXPECT_NE(a.bodies[2].X_WB.p, c.bodies[2].X_WB.p);
}

TEST(Perturb, MemberZeroIsTheModelItself) {
  engine::Model model = two_tied_bodies_and_a_free_one();
  perturb(model, 0);
  EXPECT_TRUE(model.bodies[2].X_WB.p.isZero(0));
}

}  // namespace
}  // namespace cli::study
