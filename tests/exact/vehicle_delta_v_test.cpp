// What a collision changes of a library vehicle's velocity, against momentum alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "engine/measure/impacts.h"
#include "engine/measure/metrics.h"
#include "engine/measure/passage.h"
#include "engine/simulate.h"
#include "tests/scenes/scene_file.h"

namespace engine {
namespace {

std::string vehicle(const std::string& name, const std::string& model, double x, double y, int heading, double speed) {
  return "[[vehicle]]\nname = \"" + name + "\"\nmodel = \"" + model + "\"\nposition = \"" + std::to_string(x) + " " +
         std::to_string(y) + " m\"\nheading = \"" + std::to_string(heading) + " deg\"\nspeed = \"" + std::to_string(speed) +
         " km/h\"\n";
}

struct Crash {
  scenes::Scene scene;
  Recording recording;

  explicit Crash(const std::string& vehicles)
      : scene(scenes::testing::folder().load("[simulation]\nduration = \"1.2 s\"\n" + vehicles)),
        recording(simulate(scene.model)) {}
  double value(const std::string& key, const std::string& object) const {
    for (const Metric& m : measure(scene.model, recording))
      if (m.key == key && m.object == object) return m.value;
    ADD_FAILURE() << object << " has no " << key;
    return 0;
  }
};

/// Two of one mass that stay together share the speed, at whatever speed: what they exchange later, lying against each other, is no
/// part of it. It was up to 22 km/h, and 21 km/h gave more than 22.
TEST(VehicleDeltaV, OfABrakedCarStruckFromBehindIsHalfTheSpeed) {
  for (const double speed : {10.0, 15.0, 21.0, 22.0, 50.0}) {
    const Crash run(vehicle("a", "sedan", 0, 0, 0, speed) + vehicle("b", "sedan", 4.9, 0, 0, 0) +
                    "[vehicle.brake]\nfrom = \"0 s\"\ndeceleration = \"0.75 g\"\n");
    const double shared = 0.5 * speed / 3.6;
    for (const char* car : {"a", "b"}) {
      EXPECT_NEAR(run.value("delta_v_mps", car), shared, 0.005 * shared) << speed;
      EXPECT_NEAR(run.value("ees_mps", car), shared, 0.005 * shared) << speed;  // half of what is lost is each one's
    }
  }
}

/// Struck in its flank and shoved along sideways, against its tyres. Those held it, and what they did was told as delta-v: a car
/// had more of it than the speed of what struck it. Struck off its centre it takes less than the shared speed.
TEST(VehicleDeltaV, OfAShovedCarIsNoMoreThanTheSharedSpeed) {
  const auto shoved = [](const char* by, const char* car, double x) {
    const Crash run(vehicle("a", by, 0, 0, 0, 40) + vehicle("b", car, x, 0, 90, 0));
    const auto mass = [&](int v) { return run.scene.model.bodies[run.scene.model.vehicles[v].body].mass; };
    const double shared = mass(0) / (mass(0) + mass(1)) * 40 / 3.6;
    EXPECT_LT(run.value("delta_v_mps", "b"), 1.005 * shared) << by;
    EXPECT_GT(run.value("delta_v_mps", "b"), 0.85 * shared) << by;
  };
  shoved("truck", "small_car", 7);
  shoved("bus", "sedan", 10);
  shoved("sedan", "sedan", 4.5);
}

/// Under the compliant law a front that a wall has swallowed is held no more. Where a car went through, no delta-v is told.
TEST(VehicleDeltaV, OfACarThatWentThroughAWallIsNotTold) {
  const std::string wall =
      "[[body]]\nname = \"wall\"\nfixed = true\naxes = \"0.5 3 1 m\"\nexponent = 30\nposition = \"5.5 0 1 m\"\n";
  const auto crash = [&](const std::string& law) {
    return Crash("contact_law = \"" + law + "\"\n" + vehicle("a", "sedan", 0, 0, 0, 60) + wall);
  };
  const Crash rigid = crash("default_auto"), yielding = crash("compliant");
  EXPECT_NEAR(rigid.value("delta_v_mps", "a"), 60 / 3.6, 0.005 * 60 / 3.6);
  EXPECT_FALSE(went_through(rigid.scene.model, rigid.recording, 0));
  ASSERT_TRUE(went_through(yielding.scene.model, yielding.recording, 0)) << "it holds by now";
  EXPECT_EQ(passages(yielding.scene.model, yielding.recording).size(), 1u);
  for (const Metric& m : measure(yielding.scene.model, yielding.recording)) EXPECT_NE(m.key, "delta_v_mps");
}

/// Its trailer jackknifes into it later: a larger impulse, which the coupling takes back.
TEST(VehicleDeltaV, OfWhatTowsIsThatOfTheBlow) {
  const Crash run(vehicle("a", "sedan", 0, 0, 0, 50) + vehicle("b", "suv", 5.5, 1, 90, 0) +
                  "[[vehicle]]\nname = \"c\"\nmodel = \"car_trailer\"\ntowed_by = \"b\"\n");
  const std::vector<Impact> impacts = impacts_of(run.scene.model, run.recording);
  const auto blow =
      std::find_if(impacts.begin(), impacts.end(), [](const Impact& i) { return i.a.name == "a" && i.b.name == "b"; });
  ASSERT_NE(blow, impacts.end());
  EXPECT_NEAR(run.value("delta_v_mps", "b"), blow->b.delta_v.norm(), 0.01 * blow->b.delta_v.norm());
  EXPECT_TRUE(std::any_of(impacts.begin(), impacts.end(), [](const Impact& i) { return i.a.name == "b" && i.b.name == "c"; }))
      << "the case is for one that does";
}

}  // namespace
}  // namespace engine
