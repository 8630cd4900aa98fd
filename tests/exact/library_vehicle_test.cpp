// Every vehicle of the library: its parts look like what they are, it stands on its springs and brakes straight.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "engine/record/rest_watch.h"
#include "engine/simulate.h"
#include "scenes/scene.h"
#include "tests/scenes/scene_file.h"

namespace {

constexpr double kGravity = 9.81;

class LibraryVehicle : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Models, LibraryVehicle, testing::Values("small_car", "sedan", "suv", "van", "bus", "truck"),
                         [](const auto& p) { return std::string(p.param); });

scenes::Scene scene_of(const std::string& model, const std::string& more) {
  const scenes::testing::SceneFolder folder;
  return folder.load("[simulation]\nduration = \"3 s\"\nstop_at_rest = false\n[[vehicle]]\nname = \"it\"\nmodel = \"" + model +
                     "\"\n" + more);
}

TEST_P(LibraryVehicle, HasPaintGlassLampsTyresAndRims) {
  const scenes::Scene scene = scene_of(GetParam(), "");
  EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front();
  std::set<render::MaterialKind> kinds;
  std::set<std::string> names;
  auto look = [&](const render::Mesh& mesh) {
    for (const render::Material& m : mesh.materials) kinds.insert(m.kind), names.insert(m.name);
  };
  for (const auto& actor : scene.stage.meshes) look(*actor.mesh);
  EXPECT_EQ(scene.stage.wheels.size(), 4u);
  for (const auto& actor : scene.stage.wheels) look(*actor.mesh);
  for (const auto kind : {render::MaterialKind::paint, render::MaterialKind::glass, render::MaterialKind::lamp,
                          render::MaterialKind::rubber, render::MaterialKind::metal})
    EXPECT_TRUE(kinds.contains(kind)) << static_cast<int>(kind);
  for (const char* name : {"paint", "glass", "lamp_front", "lamp_rear", "tyre", "rim"}) EXPECT_TRUE(names.contains(name)) << name;
}

TEST_P(LibraryVehicle, StandsOnItsSpringsAsItsCentreOfMassSays) {
  const scenes::Scene scene = scene_of(GetParam(), "");
  const engine::Recording run = engine::simulate(scene.model);
  const auto& s = run.snapshots.back();
  const engine::Body& body = scene.model.bodies[0];
  double sum = 0, moment = 0;
  for (std::size_t w = 0; w < s.wheels.size(); ++w) {
    sum += s.wheels[w].load;
    moment += s.wheels[w].load * scene.model.vehicles[0].wheels[w].hub_B.x();
  }
  EXPECT_NEAR(sum, body.mass * kGravity, 1e-4 * body.mass * kGravity);
  EXPECT_NEAR(moment / sum, 0, 1e-3);  // the loads' resultant stands under the centre of mass
  EXPECT_LT((s.bodies[0].X_WB.p - run.snapshots.front().bodies[0].X_WB.p).norm(), 1e-4);
}

TEST_P(LibraryVehicle, TakesTheFrictionOfTheScene) {
  const auto surface = [](const std::string& more) { return scene_of(GetParam(), more).model.bodies[0].surface; };
  const engine::SurfaceProperties both = surface("friction = 0.05\n"), one = surface("friction_body = 0.07\n");
  EXPECT_EQ(both.friction_body.at(0), 0.05);
  EXPECT_EQ(both.friction_ground.at(0), 0.05);
  EXPECT_EQ(one.friction_body.at(0), 0.07);
  EXPECT_EQ(one.friction_ground.at(0), surface("").friction_ground.at(0));
}

TEST_P(LibraryVehicle, IsNotAtRestWhileItRolls) {
  for (const double speed : {0.06, 0.1, 0.29}) {
    const scenes::Scene scene = scene_of(GetParam(), "speed = \"" + std::to_string(speed) + " m/s\"\n");
    const engine::Recording run = engine::simulate(scene.model);
    const engine::BodyState& last = run.snapshots.back().bodies[0];
    ASSERT_NEAR(last.X_WB.p.x() - run.snapshots.front().bodies[0].X_WB.p.x(), 3 * speed, 0.02 * speed) << "nothing brakes it";
    const engine::Twist travel = engine::travel_of(scene.model, 0, last.X_WB, last.V_WB);
    EXPECT_NEAR(travel.v.x(), speed, 0.01 * speed);
    EXPECT_LT(travel.w.norm(), 1e-3);
    EXPECT_TRUE(std::none_of(run.events.begin(), run.events.end(), [](const auto& e) { return e.kind == "rest"; })) << speed;
  }
}

TEST_P(LibraryVehicle, BrakesStraightAtHalfAGravity) {
  const scenes::Scene scene =
      scene_of(GetParam(), "speed = \"50 km/h\"\n[[vehicle.driver]]\nlevel = \"0.5 g\"\nbuild_up = \"0 s\"\n");
  const engine::Recording run = engine::simulate(scene.model);
  ASSERT_FALSE(run.failure);
  const auto at = run.at(2.0);
  EXPECT_NEAR(at.bodies[0].V_WB.v.x(), 50 / 3.6 - 0.5 * kGravity * 2, 0.1);  // pitching moves the centre of mass a little
  EXPECT_NEAR(at.bodies[0].X_WB.p.y(), 0, 1e-3);
  for (const auto& w : at.wheels) EXPECT_GT(w.load, 0);
}

TEST_P(LibraryVehicle, KeepsItsWheelsDownInABriskLaneChange) {
  const scenes::Scene scene = scene_of(GetParam(),
                                       "speed = \"50 km/h\"\nsteer = [[\"0.2 s\", \"0 deg\"], [\"0.6 s\", \"3 deg\"], [\"1.4 s\", "
                                       "\"-3 deg\"], [\"1.8 s\", \"0 deg\"]]\n");
  const engine::Recording run = engine::simulate(scene.model);
  ASSERT_FALSE(run.failure);
  const auto& s = run.snapshots.back();
  EXPECT_GT((s.bodies[0].X_WB.q * engine::Vec3::UnitZ()).z(), 0.99);
  EXPECT_GT(s.bodies[0].X_WB.p.y(), 0.5);
}

}  // namespace
