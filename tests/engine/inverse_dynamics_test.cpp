// Forward dynamics of the factorised joints, undone by Newton's and Euler's equations written anew: what was put in must come back.
// And the response of contacts, made from the factors, against the motion that each of their rows gives all bodies.
#include <gtest/gtest.h>

#include <random>

#include "engine/solver/articulation.h"
#include "engine/solver/response.h"
#include "tests/engine/experiment.h"

namespace {

using namespace engine;
using namespace engine::test;

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  Vec3 vector(double size) {
    std::normal_distribution<double> normal(0, size);
    return {normal(engine_), normal(engine_), normal(engine_)};
  }
  Quat attitude() {
    std::normal_distribution<double> normal;
    return Quat(normal(engine_), normal(engine_), normal(engine_), normal(engine_)).normalized();
  }
  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  Mat3 inertia() {
    // principal moments of three point masses on the axes: every triangle inequality holds
    const Vec3 m(between(0.01, 0.1), between(0.01, 0.1), between(0.01, 0.1));
    const Mat3 R = attitude().toRotationMatrix();
    return R * Vec3(m.y() + m.z(), m.z() + m.x(), m.x() + m.y()).asDiagonal() * R.transpose();
  }

 private:
  std::mt19937_64 engine_;
};

struct Experiment {
  Model model;
  std::vector<Pose> X;
  std::vector<Twist> V;
};

/// Axes the joint lets the child turn about, world: columns, `count` of them; and along what of the parent's frame it slides.
struct FreeAxes {
  Mat3 axis = Mat3::Identity();
  int count = 0;
  Vec3 slide = Vec3::Zero();
};

FreeAxes free_axes(const Joint& joint, const Pose& X_WP, const Pose& X_WC) {
  const Vec3 y_P = X_WP.q * (joint.X_PF.q * Vec3::UnitY()), x_C = X_WC.q * (joint.X_CF.q * Vec3::UnitX());
  FreeAxes out;
  if (joint.kind == JointKind::prismatic || joint.kind == JointKind::cylindrical) out.slide = y_P;
  if (joint.kind == JointKind::spinal) out.slide = X_WP.q * (joint.X_PF.q * Vec3::UnitZ());
  switch (joint.kind) {
    case JointKind::fixed:
    case JointKind::prismatic:
      break;
    case JointKind::revolute:
    case JointKind::cylindrical:
      out.axis.col(0) = y_P;
      out.count = 1;
      break;
    case JointKind::universal:
      out.axis.col(0) = y_P;
      out.axis.col(1) = x_C;
      out.count = 2;
      break;
    default:
      out.count = 3;
  }
  return out;
}

/// A free chain of three bodies on two joints of a kind, in a random state that the joints allow.
Experiment chain(JointKind kind, Random& random) {
  Experiment e;
  for (int b = 0; b < 3; ++b) {
    Body body;
    body.mass = random.between(0.3, 20);
    body.inertia_B = random.inertia();
    body.X_WB = {random.vector(1), random.attitude()};
    e.model.bodies.push_back(body);
  }
  e.X = {e.model.bodies[0].X_WB};
  e.V = {{random.vector(3), random.vector(5)}};
  for (int j = 0; j < 2; ++j) {
    Joint joint;
    joint.kind = kind;
    joint.parent = j;
    joint.child = j + 1;
    joint.X_PF = {random.vector(0.3), random.attitude()};
    joint.X_CF = {random.vector(0.3), random.attitude()};
    const double a = random.between(-2, 2), b = random.between(-2, 2);
    Quat q_FF = Quat::Identity();
    if (kind == JointKind::revolute || kind == JointKind::cylindrical) q_FF = Eigen::AngleAxisd(a, Vec3::UnitY());
    if (kind == JointKind::universal) q_FF = Eigen::AngleAxisd(a, Vec3::UnitY()) * Eigen::AngleAxisd(b, Vec3::UnitX());
    if (kind == JointKind::spherical || kind == JointKind::ragdoll || kind == JointKind::spinal) q_FF = random.attitude();
    Pose X_WC;
    X_WC.q = e.X.back().q * joint.X_PF.q * q_FF * joint.X_CF.q.conjugate();
    const FreeAxes axes = free_axes(joint, e.X.back(), X_WC);
    const Vec3 point = e.X.back() * joint.X_PF.p + random.between(-1, 1) * axes.slide;
    X_WC.p = point - X_WC.q * joint.X_CF.p;
    Twist V_C{Vec3::Zero(), e.V.back().w};
    for (int i = 0; i < axes.count; ++i) V_C.w += random.between(-6, 6) * axes.axis.col(i);
    V_C.v = e.V.back().v + e.V.back().w.cross(point - e.X.back().p) + random.between(-4, 4) * axes.slide -
            V_C.w.cross(X_WC.q * joint.X_CF.p);
    e.X.push_back(X_WC);
    e.V.push_back(V_C);
    e.model.joints.push_back(joint);
  }
  return e;
}

class JointKinds : public testing::TestWithParam<JointKind> {};
INSTANTIATE_TEST_SUITE_P(Every, JointKinds,
                         testing::Values(JointKind::fixed, JointKind::revolute, JointKind::universal, JointKind::spherical,
                                         JointKind::ragdoll, JointKind::prismatic, JointKind::cylindrical, JointKind::spinal));

TEST_P(JointKinds, InverseDynamicsGivesBackForcesAndJointTorques) {
  Random random(20 + static_cast<unsigned>(GetParam()));
  for (int trial = 0; trial < 200; ++trial) {
    const Experiment e = chain(GetParam(), random);
    const std::size_t n = e.X.size();

    // forward: forces and moments on every body, torques and forces in the joints along their free axes
    std::vector<Vec3> F(n), M(n);
    std::vector<Vec3> torque(2, Vec3::Zero());
    std::vector<double> along(2, 0);
    std::vector<Vec6> force(n), a(n, Vec6::Zero());
    for (std::size_t b = 0; b < n; ++b) {
      F[b] = random.vector(50);
      M[b] = random.vector(10);
      const Mat3 I = inertia_W(e.model.bodies[b], e.X[b].q);
      force[b] << F[b], M[b] - e.V[b].w.cross(I * e.V[b].w);
    }
    for (std::size_t j = 0; j < 2; ++j) {
      const FreeAxes axes = free_axes(e.model.joints[j], e.X[j], e.X[j + 1]);
      for (int i = 0; i < axes.count; ++i) torque[j][i] = random.between(-20, 20);
      for (int i = 0; i < axes.count; ++i) {
        force[j + 1].tail<3>() += torque[j][i] * axes.axis.col(i);
        force[j].tail<3>() -= torque[j][i] * axes.axis.col(i);
      }
      if (axes.slide.isZero(0)) continue;
      along[j] = random.between(-50, 50);
      const Vec3 point = e.X[j + 1] * e.model.joints[j].X_CF.p;
      for (const auto& [b, sign] : {std::pair{j + 1, 1.0}, std::pair{j, -1.0}}) {
        force[b].head<3>() += sign * along[j] * axes.slide;
        force[b].tail<3>() += sign * along[j] * (point - e.X[b].p).cross(axes.slide);
      }
    }
    const Topology topology = build_topology(e.model, {});
    Articulation articulation(e.model);
    articulation.reset(topology);
    articulation.factor(topology, 0, e.X, nullptr);
    articulation.set_bias(topology, 0, e.V);
    articulation.solve(topology, 0, force, a, Articulation::Bias::from_rows);

    // inverse, from the last body inwards: what each must get from its joint, by Newton and Euler
    Vec3 F_joint = Vec3::Zero(), M_joint = Vec3::Zero();  // on the body at hand from its child, about the child's joint
    for (std::size_t b = n; b-- > 0;) {
      const Body& body = e.model.bodies[b];
      const Mat3 R = e.X[b].q.toRotationMatrix();
      const Vec3 w_B = R.transpose() * e.V[b].w, alpha_B = R.transpose() * a[b].tail<3>();
      const Vec3 rate_B = body.inertia_B * alpha_B + w_B.cross(body.inertia_B * w_B);  // of angular momentum
      const Vec3 need_F = body.mass * a[b].head<3>() - F[b];
      const Vec3 need_M = R * rate_B - M[b];
      Vec3 got_F = Vec3::Zero(), got_M = Vec3::Zero();
      if (b + 1 < n) {
        got_F = -F_joint;
        got_M = -M_joint - (e.X[b + 1] * e.model.joints[b].X_CF.p - e.X[b].p).cross(F_joint);
      }
      if (b == 0) {
        // the root hangs on nothing: its own balance must close with what was put in
        EXPECT_LT((need_F - got_F).norm(), 1e-9 * (1 + F[0].norm() + F_joint.norm())) << trial;
        EXPECT_LT((need_M - got_M).norm(), 1e-9 * (1 + M[0].norm() + F_joint.norm() + M_joint.norm())) << trial;
        break;
      }
      const Joint& joint = e.model.joints[b - 1];
      F_joint = need_F - got_F;
      M_joint = need_M - got_M - (R * joint.X_CF.p).cross(F_joint);
      // along the free axes the joint gives its torque and nothing else (those of a cardan cross are at right angles)
      const FreeAxes axes = free_axes(joint, e.X[b - 1], e.X[b]);
      for (int i = 0; i < axes.count; ++i)
        EXPECT_NEAR(axes.axis.col(i).dot(M_joint), torque[b - 1][i], 1e-9 * (1 + F_joint.norm() + M_joint.norm())) << trial;
      EXPECT_NEAR(axes.slide.dot(F_joint), along[b - 1], 1e-9 * (1 + F_joint.norm())) << trial;
    }

    // and the motion is one the joints allow: points stay together but for the slide, only free turns accelerate
    for (std::size_t j = 0; j < 2; ++j) {
      const Joint& joint = e.model.joints[j];
      const Vec3 point = e.X[j + 1] * joint.X_CF.p;
      auto velocity = [&](std::size_t b) -> Vec3 { return e.V[b].v + e.V[b].w.cross(point - e.X[b].p); };
      auto at_joint = [&](std::size_t b) -> Vec3 {
        const Vec3 r = point - e.X[b].p;
        return a[b].head<3>() + a[b].tail<3>().cross(r) + e.V[b].w.cross(e.V[b].w.cross(r));
      };
      const double size = 1 + a[j].norm() + a[j + 1].norm() + e.V[j].w.squaredNorm() + e.V[j + 1].w.squaredNorm();
      const FreeAxes axes = free_axes(joint, e.X[j], e.X[j + 1]);
      // seen from the parent the point accelerates along the slide alone, beyond what Coriolis asks for
      Vec3 opening = at_joint(j + 1) - at_joint(j) - 2 * e.V[j].w.cross(velocity(j + 1) - velocity(j));
      opening -= axes.slide.dot(opening) * axes.slide;
      EXPECT_LT(opening.norm(), 1e-9 * size) << trial;
      // relative turn w = sum rate_i e_i, so its acceleration is sum rate_i' e_i + rate_i e_i': take the second part off
      const Vec3 w = e.V[j + 1].w - e.V[j].w;
      Vec3 alpha = a[j + 1].tail<3>() - a[j].tail<3>();
      if (axes.count == 1) alpha -= axes.axis.col(0).dot(w) * e.V[j].w.cross(axes.axis.col(0));
      if (axes.count == 2) {
        alpha -= axes.axis.col(0).dot(w) * e.V[j].w.cross(axes.axis.col(0));
        alpha -= axes.axis.col(1).dot(w) * e.V[j + 1].w.cross(axes.axis.col(1));
      }
      for (int i = 0; i < axes.count; ++i) alpha -= axes.axis.col(i).dot(alpha) * axes.axis.col(i);
      if (axes.count == 3) continue;
      EXPECT_LT(alpha.norm(), 1e-9 * size) << trial;
    }
  }
}

TEST_P(JointKinds, RowsAnswerEachOtherAsTheBodiesMoveUnderThem) {
  // a chain and two bodies that hang on its first, one of them on an axis; and a free body: two trees
  Random random(60 + static_cast<unsigned>(GetParam()));
  for (int trial = 0; trial < 40; ++trial) {
    Experiment e = chain(GetParam(), random);
    for (const auto& [kind, parent] :
         {std::pair{JointKind::revolute, 0}, std::pair{JointKind::spherical, 0}, std::pair{JointKind::fixed, -1}}) {
      const int child = static_cast<int>(e.model.bodies.size());
      Body body;
      body.mass = random.between(0.01, 20);
      body.inertia_B = random.inertia();
      e.model.bodies.push_back(body);
      Joint joint;
      joint.kind = kind;
      joint.parent = parent;
      joint.child = child;
      joint.X_PF = {random.vector(0.3), random.attitude()};
      joint.X_CF = {random.vector(0.3), random.attitude()};
      Pose X{random.vector(1), random.attitude()};
      if (parent >= 0) {
        const Quat turned = kind == JointKind::spherical ? random.attitude() : Quat(Eigen::AngleAxisd(0.7, Vec3::UnitY()));
        X.q = e.X[0].q * joint.X_PF.q * turned * joint.X_CF.q.conjugate();
        X.p = e.X[0] * joint.X_PF.p - X.q * joint.X_CF.p;
        e.model.joints.push_back(joint);
      }
      e.X.push_back(X);
    }
    const int bodies = static_cast<int>(e.X.size());

    // contacts of all pairs, with the world and with themselves, and limits of one row between them
    std::vector<Constraint> all;
    std::vector<int> members, offset;
    int size = 0;
    for (int a = 0; a < bodies; ++a)
      for (int b = -1; b < a; ++b) {
        Constraint c;
        c.rows = (a + b) % 3 == 0 ? 1 : 3;
        c.a.body = a;
        c.b.body = b;
        for (int r = 0; r < c.rows; ++r) {
          c.a.J.row(r) << random.vector(1).transpose(), random.vector(1).transpose();
          if (b >= 0) c.b.J.row(r) << random.vector(1).transpose(), random.vector(1).transpose();
        }
        if (all.size() % 7 == 3) {
          all.push_back(c);  // one that is not asked for
          continue;
        }
        members.push_back(static_cast<int>(all.size()));
        offset.push_back(size);
        size += c.rows;
        all.push_back(c);
      }
    std::vector<JointDamper> dampers(e.model.joints.size());
    for (JointDamper& damper : dampers) damper = {random.inertia(), random.inertia(), trial % 2 == 0};
    const Topology topology = build_topology(e.model, {});
    ASSERT_EQ(topology.trees.size(), 2u);
    Articulation articulation(e.model);
    articulation.reset(topology);
    for (const int tree : {0, 1}) articulation.factor(topology, tree, e.X, &dampers);
    Response response;
    response.reset(topology, all.size());
    const std::size_t stride = whole_rows(static_cast<std::size_t>(size));
    AlignedVector G(stride * static_cast<std::size_t>(size), std::numeric_limits<double>::quiet_NaN());
    for (int again = 0; again < 2; ++again) response.compute(topology, articulation, all, members, offset, stride, G);

    const Eigen::Map<const Eigen::MatrixXd> found(G.data(), static_cast<Eigen::Index>(stride), size);
    double largest = 0;
    for (std::size_t j = 0; j < members.size(); ++j)
      for (int q = 0; q < all[members[j]].rows; ++q) {
        const Constraint& push = all[members[j]];
        std::vector<Vec6> force(e.X.size(), Vec6::Zero()), a(e.X.size(), Vec6::Zero());
        force[push.a.body] += push.a.J.row(q).transpose();
        if (push.b.body >= 0) force[push.b.body] += push.b.J.row(q).transpose();
        for (const int tree : {0, 1}) articulation.solve(topology, tree, force, a, Articulation::Bias::zero);
        for (std::size_t i = 0; i < members.size(); ++i)
          for (int r = 0; r < all[members[i]].rows; ++r) {
            const Constraint& c = all[members[i]];
            double expected = c.a.J.row(r).dot(a[c.a.body]);
            if (c.b.body >= 0) expected += c.b.J.row(r).dot(a[c.b.body]);
            const double here = found(offset[i] + r, offset[j] + q);
            const double size_of_both = std::sqrt(found(offset[i] + r, offset[i] + r) * found(offset[j] + q, offset[j] + q));
            largest = std::max(largest, std::abs(here - expected) / size_of_both);
            EXPECT_EQ(here, found(offset[j] + q, offset[i] + r)) << "not symmetric";
          }
      }
    // rounding of inertias that differ by a thousand
    EXPECT_LT(largest, 1e-10) << trial;
    EXPECT_TRUE(found.bottomRows(static_cast<Eigen::Index>(stride) - size).isZero(0)) << trial;
  }
}

TEST(KnownFactors, AreThoseOfThePlaceAndWithoutDampers) {
  Random random(41);
  const Experiment e = chain(JointKind::spherical, random);
  const Topology topology = build_topology(e.model, {});
  ASSERT_EQ(topology.trees.size(), 1u);
  const auto links = static_cast<int>(topology.links.size());
  std::vector<Pose> elsewhere = e.X;
  elsewhere.back().q = Quat(Eigen::AngleAxisd(1e-7, Vec3::UnitX())) * elsewhere.back().q;

  Articulation made(e.model), asked(e.model), other(e.model);
  for (Articulation* one : {&made, &asked, &other}) one->reset(topology);
  const auto expect_factors_at = [&](const std::vector<Pose>& X, const char* when) {
    made.factor(topology, 0, X, nullptr);
    asked.factor_unless_known(topology, 0, X);
    for (int l = 0; l < links; ++l) {
      EXPECT_EQ(asked.of_link(l).D, made.of_link(l).D) << when;
      EXPECT_EQ(asked.of_link(l).X, made.of_link(l).X) << when;
    }
  };
  expect_factors_at(e.X, "at first");
  expect_factors_at(elsewhere, "moved by a hair");
  std::vector<JointDamper> dampers(e.model.joints.size());
  for (JointDamper& damper : dampers) damper = {Mat3::Identity(), Mat3::Identity(), true};
  asked.factor(topology, 0, elsewhere, &dampers);
  expect_factors_at(elsewhere, "damped before");
  // rows that were looked at elsewhere and are back: as joints are closed, whose factors stay behind
  asked.factor(topology, 0, e.X, nullptr);
  for (int l = 0; l < links; ++l)
    if (topology.links[static_cast<std::size_t>(l)].joint >= 0) asked.rows_at(topology, l, elsewhere);
  expect_factors_at(elsewhere, "its rows there alone");

  // known they are not made again: what is written into them stays
  asked.of_link(0).D *= 2;
  const Mat6 marked = asked.of_link(0).D;
  asked.factor_unless_known(topology, 0, elsewhere);
  EXPECT_EQ(asked.of_link(0).D, marked);
  other.take_over(asked);
  other.factor_unless_known(topology, 0, elsewhere);
  EXPECT_EQ(other.of_link(0).D, marked);
  expect_factors_at(elsewhere, "taken over by another");
}

}  // namespace
