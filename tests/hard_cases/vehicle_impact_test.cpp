// An undamped standing person struck by a car: light limbs, rigid limits, a step of up to 2 ms.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "engine/simulate.h"
#include "scenes/scene.h"

namespace {

struct Case {
  const char* speed;
  const char* step;
};

class UndampedPerson : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(StruckByASedan, UndampedPerson,
                         testing::Values(Case{"11 m/s", "2 ms"}, Case{"11 m/s", "1 ms"}, Case{"11 m/s", "0.5 ms"},
                                         Case{"25 m/s", "2 ms"}, Case{"25 m/s", "1 ms"}, Case{"25 m/s", "0.5 ms"}));

TEST_P(UndampedPerson, HoldsTogetherAndNeverGainsEnergy) {
  const auto [speed, step] = GetParam();
  auto scene = scenes::load(std::string(CRASHREEL_SOURCE_DIR) + "/scenes/cases/sedan_pedestrian_40kmh.toml",
                            {std::string("vehicle.sedan.speed=") + speed, std::string("simulation.step=") + step,
                             "simulation.duration=3 s", "simulation.stop_at_rest=false", "person.pedestrian.pose=standing",
                             "person.pedestrian.speed=0 m/s", "person.pedestrian.position=0.16 -1.9 m"});
  for (engine::Joint& joint : scene.model.joints)
    for (engine::ArticulationAngle& angle : joint.angles) angle.damping = angle.friction_torque = angle.stiffness = 0;
  const engine::Recording run = engine::simulate(scene.model);
  const auto& d = run.diagnostics;
  std::printf("    %s at %s: drift %.1e m, limit %.3f deg, penetration %.2f mm, residual %.1e m/s, energy rise %.2f J\n", speed,
              step, d.max_joint_gap, d.max_joint_angle_error * 180 / std::numbers::pi, d.max_penetration * 1e3,
              d.max_solver_residual, d.max_energy_rise);
  EXPECT_FALSE(run.failure);
  EXPECT_LT(d.max_joint_gap, 1e-5);
  EXPECT_LT(d.max_energy_rise, 5);
  EXPECT_NEAR(run.end_time(), 3, 1e-9);
}

}  // namespace
