// An undamped standing person struck from the side: light limbs, rigid limits, a box of 1500 kg.
#include <gtest/gtest.h>

#include "tests/hard_cases/hard_case.h"

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
      for (engine::ArticulationAngle& angle : joint.angles) angle.damping = angle.friction_torque = angle.stiffness = 0;
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

}  // namespace
}  // namespace hard_cases
