// Wheels of a library vehicle that a scene changes one by one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
