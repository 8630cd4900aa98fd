// Riders: joints that break at their strength, poses kept until the first touch, falling when struck.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/simulate.h"
#include "scenes/scene.h"

namespace {

long broken(const engine::Recording& run) {
  return std::count_if(run.events.begin(), run.events.end(), [](const engine::Event& e) { return e.kind == "joint_broken"; });
}

/// A weight of 10 kg hung from the world by a joint of a given strength.
engine::Recording hung(double strength) {
  engine::Model model;
  model.ground.plane = false;
  model.settings.duration = 0.5;
  model.settings.stop_at_rest = false;
  engine::Body body;
  body.name = "weight";
  body.mass = 10;
  body.inertia_B = 0.1 * engine::Mat3::Identity();
  model.bodies.push_back(body);
  engine::Joint joint;
  joint.parent = -1;
  joint.child = 0;
  joint.breaking_force = strength;
  model.joints.push_back(joint);
  return engine::simulate(model);
}

TEST(BreakableJoint, HoldsAWeightBelowItsStrengthAndDropsOneAboveIt) {
  // the mean of a constant force comes within e^-50 of it in half a second: one per cent either side decides
  const engine::Recording holds = hung(10 * 9.81 * 1.01), drops = hung(10 * 9.81 * 0.99);
  EXPECT_EQ(broken(holds), 0);
  EXPECT_NEAR(holds.snapshots.back().bodies[0].X_WB.p.z(), 0, 1e-3);  // a joint of the contact solver gives by 0.1 mm
  EXPECT_EQ(broken(drops), 1);
  EXPECT_LT(drops.snapshots.back().bodies[0].X_WB.p.z(), -0.9);  // free fall since 4.6 forgetting times of 10 ms
}

TEST(GripsAndPedals, HoldWithTheForceTheSceneSets) {
  const std::string scene = std::string(CRASHREEL_SOURCE_DIR) + "/scenes/cases/cyclist.toml";
  const auto run_with = [&](const std::string& grip, const std::string& pedal, const std::string& seat) {
    return engine::simulate(scenes::load(scene, {"simulation.duration=0.6 s", "person.rider.grip_force=" + grip,
                                                 "person.rider.pedal_force=" + pedal, "person.rider.seat_force=" + seat})
                                .model);
  };
  EXPECT_EQ(broken(run_with("10 MN", "10 MN", "10 MN")), 0) << "held by all means";
  EXPECT_EQ(broken(run_with("1 N", "10 MN", "10 MN")), 2) << "only the hands let go";
  EXPECT_EQ(broken(run_with("10 MN", "1 N", "10 MN")), 2) << "only the feet slip";
  EXPECT_EQ(broken(run_with("10 MN", "10 MN", "1 N")), 1) << "only the seat is left";
}

struct Case {
  const char* file;
  std::size_t mount;  // body
};

class Rider : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Cases, Rider, testing::Values(Case{"cyclist", 1}, Case{"motorcycle", 1}),
                         [](const auto& p) { return std::string(p.param.file); });

TEST_P(Rider, KeepsItsPoseUntilTheTouchThenLetsGoAndTheMountFallsOver) {
  const scenes::Scene scene = scenes::load(std::string(CRASHREEL_SOURCE_DIR) + "/scenes/cases/" + GetParam().file + ".toml");
  const engine::Recording run = engine::simulate(scene.model);
  ASSERT_FALSE(run.failure);
  const auto release =
      std::find_if(run.events.begin(), run.events.end(), [](const engine::Event& e) { return e.kind == "release"; });
  ASSERT_NE(release, run.events.end());
  EXPECT_GT(release->time, 0.05);
  // until then rider and mount move as one, to rounding
  const auto before = run.at(release->time - 0.01);
  const auto& first = run.snapshots.front();
  const engine::Vec3 moved = before.bodies[GetParam().mount].X_WB.p - first.bodies[GetParam().mount].X_WB.p;
  for (const int b : scene.model.persons[0].bodies)
    EXPECT_LT((before.bodies[static_cast<std::size_t>(b)].X_WB.p - first.bodies[static_cast<std::size_t>(b)].X_WB.p - moved).norm(),
              1e-9);
  EXPECT_EQ(broken(run), 5) << "two hands, two feet, the seat";
  const engine::Vec3 up = run.snapshots.back().bodies[GetParam().mount].X_WB.q * engine::Vec3::UnitZ();
  EXPECT_LT(up.z(), 0.5);
  const double initial = first.energies.kinetic + first.energies.potential;
  EXPECT_LT(run.diagnostics.max_energy_rise, 5e-3 * initial);
  EXPECT_LT(run.diagnostics.rest_penetration, 5e-3);
}

}  // namespace
