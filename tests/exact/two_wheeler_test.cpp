// Riders: joints that break at their strength, poses kept until the first touch, falling when struck.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/simulate.h"
#include "scenes/scene.h"
#include "tests/scenes/scene_file.h"

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

/// The shipped motorcycle alone on its road, with what the scene adds.
engine::Recording ridden(const std::vector<std::string>& overrides) {
  std::vector<std::string> set = {"simulation.duration=2 s", "vehicle.motorcycle.speed=60 km/h",
                                  "vehicle.motorcycle.position=-100 -20 m"};
  set.insert(set.end(), overrides.begin(), overrides.end());
  return engine::simulate(scenes::load(std::string(CRASHREEL_SOURCE_DIR) + "/scenes/cases/motorcycle.toml", set).model);
}

int body_of(const engine::Recording& run, const std::string& name) {
  return static_cast<int>(std::find(run.body_names.begin(), run.body_names.end(), name) - run.body_names.begin());
}

TEST(RiddenMount, BrakesBeforeTheFirstTouchWithItsRider) {
  const engine::Recording run = ridden({"vehicle.motorcycle.brake.from=0 s", "vehicle.motorcycle.brake.build_up=0 s",
                                        "vehicle.motorcycle.brake.deceleration=4 m/s^2"});
  const auto& end = run.snapshots.back();
  const int mount = body_of(run, "motorcycle"), head = body_of(run, "rider/head");
  const double a = 4, v = 60 / 3.6;
  EXPECT_NEAR(end.bodies[mount].V_WB.v.norm(), v - 2 * a, 0.02 * 2 * a);
  EXPECT_NEAR((end.bodies[head].V_WB.v - end.bodies[mount].V_WB.v).norm(), 0, 1e-9) << "one pair";
  const double way = (end.bodies[mount].X_WB.p - run.snapshots.front().bodies[mount].X_WB.p).norm();
  EXPECT_NEAR(way, v * 2 - 0.5 * a * 4, 0.05 * 0.5 * a * 4);
  // what the brake took stands in the books
  EXPECT_LT(std::abs(end.energies.residual), 1e-3 * end.energies.kinetic);
}

struct Stop {
  engine::Model model;
  engine::Recording run;

  double weight() const {
    double mass = 0;
    for (const engine::Body& body : model.bodies) mass += body.mass;
    return 9.81 * mass;
  }
  /// Of rider and mount, from the rear axle's place on the road.
  engine::Vec3 centre() const {
    engine::Vec3 sum = engine::Vec3::Zero();
    for (const engine::Body& body : model.bodies) sum += 9.81 / weight() * body.mass * body.X_WB.p;
    return sum - run.snapshots.front().wheels[1].contact;
  }
};

/// A motorcycle with its rider at 60 km/h on a road that falls along the way by so many degrees.
Stop stopping(double grade, const std::string& act, const std::string& wheels = "", const std::string& road = "") {
  const scenes::testing::SceneFolder folder;
  Stop out{folder
               .load("title = \"stop\"\n[simulation]\nduration = \"6 s\"\nslope = \"" + std::to_string(grade) + " deg\"\n" + road +
                     "[[vehicle]]\nname = \"moto\"\nmodel = \"motorcycle\"\nspeed = \"60 km/h\"\n" + act + wheels +
                     "[[person]]\nname = \"rider\"\npose = \"motorcyclist\"\nrides = \"moto\"\n")
               .model,
           {}};
  out.run = engine::simulate(out.model);
  return out;
}

double slowing(const Stop& stop, double until) {
  return (60 / 3.6 - stop.run.at(until).bodies[0].V_WB.v.norm()) / until;
}

/// v^2 / (2 g (a - sin(grade))), a what is asked or, with both wheels at their limit, friction: the driver's hands follow the
/// loads.
TEST(RiddenMount, StopsInTheWayThatGradeAndGripGive) {
  const double v = 60 / 3.6, g = 9.81, mu = 0.8;
  for (const double grade : {-6.0, 0.0, 6.0})
    for (const double asked : {0.5, 0.7, 2.0}) {
      const Stop stop = stopping(
          grade, "[vehicle.brake]\nfrom = \"0 s\"\nbuild_up = \"0 s\"\ndeceleration = \"" + std::to_string(asked) + " g\"\n");
      const auto &first = stop.run.snapshots.front(), &last = stop.run.snapshots.back();
      const double upright = std::cos(grade * M_PI / 180), held = std::min(asked, mu * upright);
      const double formula = v * v / (2 * g * (held - std::sin(grade * M_PI / 180)));
      const double way = (last.bodies[0].X_WB.p - first.bodies[0].X_WB.p).norm();
      EXPECT_NEAR(way, formula, 0.005 * formula) << asked << " g at " << grade;
      EXPECT_LT(std::abs(last.energies.residual), 1e-6 * first.energies.kinetic) << "brakes and gravity stand in the books";
      const auto wheels = stop.run.at(0.5).wheels;
      EXPECT_NEAR(wheels[0].load + wheels[1].load, stop.weight() * upright, 1);
      EXPECT_EQ(wheels[1].slip > 0, asked > 1) << "with its load, a mark is drawn of it";
    }
}

/// The front brake alone: the load that slowing brings to its wheel lets it hold more, a = g mu s / (1 - mu h / base).
TEST(RiddenMount, HoldsMoreInFrontAsItSlows) {
  const double mu = 0.8, base = 1.44;
  const Stop stop = stopping(0, "[[vehicle.driver]]\nfrom = \"0 s\"\nbuild_up = \"0 s\"\nlevel = \"1.25 g\"\nwheels = [1, 0]\n");
  const engine::Vec3 centre = stop.centre();
  const double formula = 9.81 * mu * centre.x() / base / (1 - mu * centre.z() / base);
  EXPECT_NEAR(slowing(stop, 0.5), formula, 0.005 * formula);
}

/// On rubber that holds more than its lever the rear wheel would leave the road: a = g (base - s) / h, and no more.
TEST(RiddenMount, HoldsBackWhereItWouldPitchOver) {
  const auto wheel = [](const std::string& name, const std::string& x, const std::string& more) {
    return "[[vehicle.wheel]]\nname = \"" + name + "\"\nat = \"" + x + " 0 0.31 m\"\nradius = \"0.31 m\"\nwidth = \"0.12 m\"\n" +
           "spring = \"20 kN/m\"\ndamper = \"0.8 kN s/m\"\ntravel = \"0.05 m\"\nfriction = 1.5\n" + more;
  };
  const Stop stop = stopping(0, "[[vehicle.driver]]\nfrom = \"0 s\"\nbuild_up = \"0 s\"\nlevel = \"1.25 g\"\nwheels = [1, 0]\n",
                             wheel("front", "0.72", "steered = true\n") + wheel("rear", "-0.72", ""), "[ground]\nfriction = 1.5\n");
  const engine::Vec3 centre = stop.centre();
  EXPECT_NEAR(slowing(stop, 0.5), 9.81 * (1.44 - centre.x()) / centre.z(), 0.05);
  EXPECT_NEAR(stop.run.at(0.5).wheels[1].load, 0, 1e-6 * stop.weight());
}

TEST(RiddenMount, GoesRoundTheCircleOfItsWheelAngle) {
  const engine::Recording run = ridden({"vehicle.motorcycle.steer=[[\"0 s\", \"2 deg\"]]"});
  const auto& end = run.snapshots.back().bodies[static_cast<std::size_t>(body_of(run, "motorcycle"))];
  const double v = 60 / 3.6, rate = v * std::tan(2 * M_PI / 180) / 1.44;
  EXPECT_NEAR(end.V_WB.w.z(), rate, 0.02 * rate);
  EXPECT_NEAR(end.V_WB.v.norm(), v, 0.01 * v);
  // upright in its plane
  EXPECT_NEAR((end.X_WB.q * engine::Vec3::UnitZ()).z(), 1, 1e-9);
}

TEST(RiddenMount, ThatStrikesAPersonReleasesAllThree) {
  const scenes::testing::SceneFolder folder;
  const scenes::Scene scene = folder.load(R"(title = "bicycle at 20 km/h into a standing pedestrian"
[simulation]
duration = "1 s"
[[vehicle]]
name = "bike"
model = "bicycle"
front = "-1 0 m"
speed = "20 km/h"
[[person]]
name = "rider"
pose = "cyclist"
rides = "bike"
[[person]]
name = "ped"
position = "0.1 0 m"
heading = "90 deg"
)");
  const engine::Recording run = engine::simulate(scene.model);
  ASSERT_FALSE(run.failure);
  double first = 10, last = 0;
  int released = 0;
  for (const engine::Event& e : run.events)
    if (e.kind == "release") first = std::min(first, e.time), last = std::max(last, e.time), ++released;
  EXPECT_EQ(released, 2) << "rider with mount, and pedestrian";
  EXPECT_LT(last - first, 1e-9) << "at the same instant";
  EXPECT_LT(run.diagnostics.max_penetration, 0.02);
}

}  // namespace
