// What a collision changes of a library vehicle's velocity, against momentum alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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

  explicit Crash(const std::string& vehicles, const std::string& duration = "1.2 s")
      : scene(scenes::testing::folder().load("[simulation]\nduration = \"" + duration + "\"\n" + vehicles)),
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

struct Obstacle {
  std::string half;  // [m] half widths
  double exponent, y;
};

/// A sedan that runs into something fixed under the compliant law.
Crash pressed_in(double speed, const Obstacle& o) {
  return Crash("contact_law = \"compliant\"\n" + vehicle("a", "sedan", 0, 0, 0, speed) +
                   "[[body]]\nname = \"wall\"\nfixed = true\naxes = \"" + o.half +
                   " m\"\nexponent = " + std::to_string(o.exponent) + "\nposition = \"3.2 " + std::to_string(o.y) + " 1 m\"\n",
               "0.3 s");
}

/// All its energy goes into a spring: v sqrt(m / S), whether the wall is thicker than that or not, stands square before it, with
/// its end before a half of it, or is a pole. A front deeper than half of the wall was held no more, and drove on.
TEST(VehicleDeltaV, OfACarThatAWallPressesInIsItsSpeedHoweverThinTheWall) {
  for (const double speed : {20.0, 50.0})
    for (const Obstacle& o : {Obstacle{"0.5 3 1", 30, 0}, Obstacle{"0.1 3 1", 30, 0}, Obstacle{"0.05 3 1", 30, 3.2},
                              Obstacle{"0.15 0.15 3", 30, 0}, Obstacle{"0.15 0.15 3", 2, 0}}) {
      const Crash run = pressed_in(speed, o);
      const double v = speed / 3.6, mass = run.scene.model.bodies[static_cast<std::size_t>(run.scene.model.vehicles[0].body)].mass;
      constexpr double kInSeries = 200e3;  // [N/m] 400 kN/m of the car and of the wall
      // points share the stiffness by their depths: those less deep bear some of it, and it goes in a little deeper. Those that
      // face different ways, about a pole, do not share it
      EXPECT_NEAR(run.recording.diagnostics.max_compression, v * std::sqrt(mass / kInSeries),
                  0.08 * v * std::sqrt(mass / kInSeries))
          << speed << " km/h, " << o.half;
      // what lies off its centre line turns it a little
      EXPECT_NEAR(run.value("delta_v_mps", "a"), v, 0.02 * v) << speed << " km/h, " << o.half;
      EXPECT_TRUE(passages(run.scene.model, run.recording).empty());
    }
}

/// Deeper than its centre of mass no vehicle is pressed in: no delta-v is told.
TEST(VehicleDeltaV, OfACarThatWentThroughAWallIsNotTold) {
  const Crash run = pressed_in(110, {"0.5 3 1", 30, 0});
  ASSERT_TRUE(went_through(run.scene.model, run.recording, 0));
  EXPECT_EQ(passages(run.scene.model, run.recording).size(), 1u);
  for (const Metric& m : measure(run.scene.model, run.recording)) EXPECT_NE(m.key, "delta_v_mps");
}

/// A pole at the side of its front is held, or it is told that it is not.
TEST(VehicleDeltaV, OfACarThatAPoleAtTheSideWentThroughIsNotTold) {
  for (const double y : {0.4, 0.5, 0.7}) {
    const Crash run = pressed_in(50, {"0.15 0.15 3", 2, y});
    const bool held = run.recording.diagnostics.max_compression > 1;  // [m] v sqrt(m / S) is 1.2
    EXPECT_TRUE(held || went_through(run.scene.model, run.recording, 0)) << y;
  }
}

/// What stands close before a car at the start is met from the car's front, not from within through its rear: a pole half a metre
/// ahead drove a standing sedan off.
TEST(VehicleDeltaV, OfACarThatStandsNearAPoleIsNone) {
  const Crash run = pressed_in(0, {"0.15 0.15 3", 20, 0.4});
  EXPECT_EQ(run.recording.diagnostics.max_compression, 0);
  EXPECT_LT(run.recording.snapshots.back().bodies[0].V_WB.v.norm(), 1e-3);
}

/// So is one through a thin mesh, or another vehicle: whose points are farther in than 15 cm are dropped.
TEST(VehicleDeltaV, OfACarThatWentThroughAMeshIsNotTold) {
  const auto told = [](const Crash& run, int v) {
    const std::vector<Metric> all = measure(run.scene.model, run.recording);
    return std::any_of(all.begin(), all.end(), [&](const Metric& m) {
      return m.key == "delta_v_mps" && m.object == run.scene.model.vehicles[static_cast<std::size_t>(v)].name;
    });
  };
  const std::string law = "contact_law = \"compliant\"\n";
  const std::string kind = "collision = \"default_auto\"\n";
  const Crash pair(law + vehicle("a", "sedan", 0, 0, 0, 80) + kind + vehicle("b", "sedan", 6, 0, 180, 80) + kind);
  for (const int v : {0, 1}) {
    EXPECT_TRUE(went_through(pair.scene.model, pair.recording, v));
    EXPECT_FALSE(told(pair, v));
  }
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
