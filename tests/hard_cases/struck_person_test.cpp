// An undamped standing person struck from the side: light limbs, rigid limits, a box of 1500 kg.
#include <gtest/gtest.h>

#include "tests/hard_cases/hard_case.h"
#include "tests/hard_cases/meshes.h"

namespace hard_cases {
namespace {

class StruckPerson : public testing::TestWithParam<std::tuple<const char*, Setting>> {};
// without joint resistance both schemes are the same to the last bit: one will do
INSTANTIATE_TEST_SUITE_P(At, StruckPerson,
                         testing::Combine(testing::Values("11 m/s", "25 m/s"),
                                          testing::Values(Setting{"2 ms", "stepping"}, Setting{"1 ms", "stepping"},
                                                          Setting{"0.5 ms", "stepping"})));

TEST_P(StruckPerson, HoldsTogetherAndNeverGainsEnergy) {
  const auto [speed, setting] = GetParam();
  const std::string velocity = std::string(speed).substr(0, std::string(speed).find(' ')) + " 0 0 m/s";
  const Outcome it = run("struck_person", setting, {"body.box.velocity=" + velocity}, [](engine::Model& model) {
    model.settings.record_interval = model.settings.step;
    for (engine::Joint& joint : model.joints) {
      joint.passive = engine::PassiveTorque::none;
      for (engine::JointCoordinate& angle : joint.angles) angle.damping = angle.friction = angle.stiffness = 0;
    }
  });
  const auto& d = it.diagnostics();
  const auto [largest, sum] = rises(it.recording);
  row("struck person", it, "%s: drift %.1e m, limit %.3f deg, penetration %.2f mm, residual %.1e m/s, E rise %.2f J, in sum %.2f J",
      speed, d.max_joint_gap, degrees(d.max_joint_angle_error), d.max_penetration * 1e3, d.max_solver_residual, largest, sum);
  EXPECT_LT(d.max_joint_gap, 1e-5);
  EXPECT_LT(degrees(d.max_joint_angle_error), 0.5);
  EXPECT_LT(d.max_penetration, 2e-3);
  EXPECT_LT(largest, 5);
  EXPECT_LT(sum, 20);
  EXPECT_NEAR(it.recording.end_time(), 3, 1e-9);
}

class StruckPersonAside : public testing::TestWithParam<Setting> {};
INSTANTIATE_TEST_SUITE_P(At, StruckPersonAside, testing::ValuesIn(kSettings));

TEST_P(StruckPersonAside, MovesTheSameToTheLastBitWhereverTheFlatFrontMeetsIt) {
  // the box never turns, so where along its front the person stands changes nothing before a limb meets an edge; a last digit of
  // it would be decimetres at the end
  auto struck = [](double aside) {
    return run("struck_person", GetParam(), {"body.box.velocity=11 0 0 m/s", "simulation.duration=1 s"},
               [aside](engine::Model& model) {
                 for (engine::Body& body : model.bodies)
                   if (body.person >= 0) {
                     body.X_WB.p.y() += aside;
                   } else {
                     body.shape = engine::MeshShape{box_mesh({1, 0.9, 0.4}), {}};
                     body.inertia_B = engine::Vec3::Constant(1e60).asDiagonal();
                   }
               });
  };
  const Outcome first = struck(0);
  for (const double aside : {1e-6, 19e-6, 1e-3, 0.05}) {
    const Outcome other = struck(aside);
    ASSERT_EQ(other.recording.snapshots.size(), first.recording.snapshots.size());
    double farthest = 0;
    bool same = true;
    for (std::size_t i = 0; i < first.recording.snapshots.size(); ++i)
      for (std::size_t b = 0; b < first.model.bodies.size(); ++b) {
        if (first.model.bodies[b].person < 0) continue;
        const auto &x = first.recording.snapshots[i].bodies[b], &y = other.recording.snapshots[i].bodies[b];
        same = same && x.V_WB.v == y.V_WB.v && x.V_WB.w == y.V_WB.w && x.X_WB.q.coeffs() == y.X_WB.q.coeffs();
        farthest = std::max(farthest, (x.X_WB.p + aside * engine::Vec3::UnitY() - y.X_WB.p).norm());
      }
    EXPECT_TRUE(same) << aside;
    EXPECT_LT(farthest, 2e-8) << aside;  // the grid that a scene is put on (local_frame.h)
    if (aside == 19e-6) row("struck, 19 um aside", other, "same velocities to the last bit; %.1e m from there", farthest);
  }
}

}  // namespace
}  // namespace hard_cases
