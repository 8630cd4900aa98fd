// Wheels of a library vehicle that a scene changes one by one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scene_file.h"

namespace scenes {
namespace {

const std::string kSedan = "[[vehicle]]\nname = \"car\"\nmodel = \"sedan\"\n";

const engine::Wheel& named(const Scene& scene, const std::string& name) {
  for (const engine::Wheel& w : scene.model.vehicles.at(0).wheels)
    if (w.name == name) return w;
  throw std::out_of_range(name);
}

TEST(ModelWheels, AreChangedOneByOneByName) {
  const Scene plain = scenes::testing::folder().load(kSedan);
  for (const bool from_outside : {false, true}) {
    const Scene changed =
        from_outside ? scenes::testing::folder().load(kSedan, {"vehicle.car.wheel.front_left.friction=0.31"})
                     : scenes::testing::folder().load(kSedan + "[[vehicle.wheel]]\nname = \"front_left\"\nfriction = 0.31\n");
    ASSERT_EQ(changed.model.vehicles.at(0).wheels.size(), 4u);
    EXPECT_EQ(named(changed, "front_left").friction, 0.31);
    EXPECT_EQ(named(changed, "front_left").hub_B, named(plain, "front_left").hub_B);
    for (const std::string other : {"front_right", "rear_left", "rear_right"})
      EXPECT_EQ(named(changed, other).friction, named(plain, other).friction) << other;
  }
}

TEST(ModelWheels, ThatSayWhereTheyAreStandForThemselves) {
  const Scene scene =
      scenes::testing::folder().load(kSedan +
                                     "[[vehicle.wheel]]\nname = \"front_left\"\nat = \"1 0 0.3 m\"\nradius = \"0.3 m\"\n"
                                     "[[vehicle.wheel]]\nname = \"rear_left\"\nat = \"-1 0 0.3 m\"\nradius = \"0.3 m\"\n");
  EXPECT_EQ(scene.model.vehicles.at(0).wheels.size(), 2u);
  EXPECT_EQ(named(scene, "front_left").anti_roll, 0) << "nothing of the model's is left";
}

/// On a terrain that falls by a tenth along x: the wheels stand on it, and the speed is along it. The car stood level at z = 0 and
/// was thrown into the air by the wheels that it had in the ground.
TEST(SetDown, StandsAlongATerrain) {
  const auto& folder = scenes::testing::folder();
  folder.write("fall.obj", "v -50 -50 7\nv 50 -50 -3\nv 50 50 -3\nv -50 50 7\nf 1 2 3\nf 1 3 4\n");  // 2 - 0.1 x
  const std::string ground = "[ground]\nkind = \"none\"\nterrain = \"fall.obj\"\n";
  const auto stands_at = [](const Scene& scene, double lift) {
    const engine::Body& body = scene.model.bodies[0];
    const engine::Wheel& wheel = scene.model.vehicles[0].wheels[0];
    const engine::Vec3 below = body.X_WB * engine::Vec3(wheel.hub_B.x(), wheel.hub_B.y(), 0);
    const engine::Vec3 normal = engine::Vec3(0.1, 0, 1).normalized();
    const double level = scenes::testing::folder().load(kSedan).model.bodies[0].X_WB.p.z();  // of its centre, on a plane
    return normal.dot(below - engine::Vec3(0, 0, 2 + lift)) - level;
  };
  for (const int heading : {0, 90, 217}) {
    const Scene scene = folder.load(ground + kSedan + "speed = \"36 km/h\"\nheading = \"" + std::to_string(heading) + " deg\"\n");
    const engine::Body& body = scene.model.bodies[0];
    EXPECT_NEAR((body.X_WB.q * engine::Vec3::UnitZ()).x(), 0.1 / std::sqrt(1.01), 1e-9);
    EXPECT_NEAR(stands_at(scene, 0), 0, 1e-6) << heading;
    EXPECT_NEAR(body.V_WB.v.norm(), 10, 1e-9);
    EXPECT_NEAR(body.V_WB.v.dot(engine::Vec3(0.1, 0, 1)), 0, 1e-9) << "along the ground";
  }
  // what the scene says of its attitude stands; the foremost wheels are on the ground then, and none below
  const Scene level = folder.load(ground + kSedan + "attitude = \"0 0 0 deg\"\n");
  double least = 1e300;
  for (const engine::Wheel& wheel : level.model.vehicles[0].wheels) {
    const engine::Vec3 below = level.model.bodies[0].X_WB * engine::Vec3(wheel.hub_B.x(), wheel.hub_B.y(), 0);
    least = std::min(least, below.z() - (2 - 0.1 * below.x()));
  }
  EXPECT_NEAR(least, folder.load(kSedan).model.bodies[0].X_WB.p.z(), 1e-6);
}

TEST(ModelWheels, ThatAreNoWheelsAreRefused) {
  for (const std::string value : {"3", "[3]", "{ front_left = 3 }"})
    EXPECT_FALSE(scenes::testing::folder().errors(kSedan + "wheel = " + value + "\n").empty()) << value;
  EXPECT_TRUE(scenes::testing::folder().load(kSedan + "wheel = []\n").model.vehicles.at(0).wheels.empty());
}

TEST(ModelWheels, OfOtherNamesAreRefused) {
  EXPECT_THAT(scenes::testing::folder().errors(kSedan + "[[vehicle.wheel]]\nname = \"left_front\"\nfriction = 0.31\n"),
              ::testing::Contains(::testing::HasSubstr("at is missing")));
}

}  // namespace
}  // namespace scenes
