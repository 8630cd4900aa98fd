// Resistance of the air and wind against closed forms, and the bound of leaving them out against runs that have them.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>

#include "engine/plan.h"
#include "scenes/scene.h"
#include "tests/engine/experiment.h"

namespace effects_tests {

using namespace engine;

namespace {

constexpr double kDensity = 1.2;  // [kg/m^3]

void add_air(Model& model, const Vec3& wind) {
  model.inputs["air.density"] = {kDensity, 0, 0};
  model.inputs["air.wind"] = wind;
  model.inputs["air.drag"] = {1, 0, 0};
  model.inputs["air.vehicle_drag"] = {0.3, 0.8, 1};
}

/// k = rho A/(2 m) [1/m] of a ball with a coefficient of one.
double drag_of_ball(double radius, double mass) {
  return kDensity * std::numbers::pi * radius * radius / (2 * mass);
}

PlanLine air_line(const std::vector<PlanLine>& lines) {
  for (const PlanLine& line : lines)
    if (line.effect == "air_drag") return line;
  return {};
}

Model in_air(double duration) {
  Model model = test::free_space(duration);
  model.settings.effects.erase("air_drag");
  return model;
}

Model shipped(const std::string& name) {
  return scenes::load(std::filesystem::path(CRASHREEL_SOURCE_DIR) / "scenes" / name).model;
}

}  // namespace

TEST(AirDrag, SlowsABallAsTheReciprocalOfTime) {
  Model model = in_air(2.0);
  model.bodies = {test::ball(0.1, 0.2, {0, 0, 0})};
  model.bodies[0].V_WB.v = {30, 0, 0};
  add_air(model, {0, 0, 0});
  const Recording run = simulate(model);
  const double k = drag_of_ball(0.1, 0.2), s = 1 + k * 30 * 2.0;
  // RK4 at 1 ms leaves 1e-12 of a motion as smooth as this
  EXPECT_NEAR(run.snapshots.back().bodies[0].V_WB.v.x(), 30 / s, 1e-9);
  EXPECT_NEAR(run.snapshots.back().bodies[0].X_WB.p.x(), std::log(s) / k, 1e-9);
  // the work of the air is booked by the trapezoidal rule, whose error is h^2/12 times the change of the power k m v^3
  const double unexplained = 1e-6 / 12 * 3 * k * k * 0.2 * std::pow(30, 4);
  EXPECT_NEAR(run.snapshots.back().energies.residual, unexplained, 0.01 * unexplained);
}

TEST(AirDrag, LetsABallFallNoFasterThanItsTerminalSpeed) {
  Model model = in_air(5.0);
  model.settings.gravity = {0, 0, -kGravity};
  model.bodies = {test::ball(0.1, 0.2, {0, 0, 0})};
  add_air(model, {0, 0, 0});
  const Recording run = simulate(model);
  const double terminal = std::sqrt(kGravity / drag_of_ball(0.1, 0.2)), t = 5.0;
  EXPECT_NEAR(run.snapshots.back().bodies[0].V_WB.v.z(), -terminal * std::tanh(kGravity * t / terminal), 1e-9);
  EXPECT_NEAR(run.snapshots.back().bodies[0].X_WB.p.z(),
              -terminal * terminal / kGravity * std::log(std::cosh(kGravity * t / terminal)), 1e-8);
}

TEST(AirDrag, IsOfTheSpeedThroughTheAirSoThatWindBlowsABallAlong) {
  Model model = in_air(3.0);
  model.bodies = {test::ball(0.1, 0.2, {0, 0, 0})};
  const Vec3 wind(3, 12, -4);  // 13 m/s
  add_air(model, wind);
  const Recording run = simulate(model);
  const double k = drag_of_ball(0.1, 0.2), way = 13 * 3.0 - std::log(1 + k * 13 * 3.0) / k;
  EXPECT_LT((run.snapshots.back().bodies[0].X_WB.p - way * wind / 13).norm(), 1e-9);
}

TEST(AirDrag, OfAStandingAdultIsThatOfItsFront) {
  Model model = shipped("cases/sedan_pedestrian_40kmh.toml");
  const Person person = model.persons[0];
  const double v = 10;
  const Vec3 forward = model.bodies[person.torso].X_WB.q * Vec3::UnitX();
  for (Body& body : model.bodies) body.V_WB = {v * forward, Vec3::Zero()};
  model.persons[0].zero_condition = false;
  model.ground.plane = false;
  model.settings.gravity.setZero();
  model.settings.duration = 5e-3;
  for (const char* off : {"joint_resistance", "mesh_contact", "joint_limits"}) model.settings.effects[off] = Force::off;
  add_air(model, {0, 0, 0});
  const Recording run = simulate(model);
  double lost = 0;
  for (const int b : person.bodies) lost += model.bodies[b].mass * (v - run.snapshots.back().bodies[b].V_WB.v.dot(forward));
  const double area = lost / model.settings.duration / (0.5 * kDensity * v * v);
  RecordProperty("drag_area_m2", std::to_string(area));
  // a front of 1.75 m by 0.3 to 0.45 m, with gaps between arms, legs and trunk, times a coefficient of one
  EXPECT_GT(area, 1.75 * 0.30);
  EXPECT_LT(area, 1.75 * 0.45);
}

TEST(AirDrag, IsLeftOutOfFreeBodiesWithAWarning) {
  Model model = in_air(1.0);
  model.bodies = {test::ball(0.1, 0.2, {0, 0, 0})};
  model.bodies[0].V_WB.v = {30, 0, 0};
  EXPECT_FALSE(air_line(compile(model).lines).active);
  const Recording without = simulate(model);
  EXPECT_EQ(without.snapshots.back().bodies[0].V_WB.v.x(), 30);
  // coefficients are assumed, and what a touch makes of the difference is not bounded: no fact
  const auto told = testing::AllOf(testing::HasSubstr("an estimate with usual drag coefficients"),
                                   testing::HasSubstr("can change more"), testing::HasSubstr("[air] has it computed"));
  EXPECT_THAT(without.diagnostics.warnings, testing::ElementsAre(told));

  // without a section there is no air to switch on, which is told
  model.settings.effects["air_drag"] = Force::on;
  const Recording with = simulate(model);
  EXPECT_EQ(with.snapshots.back().bodies[0].V_WB.v.x(), 30);
  EXPECT_THAT(with.diagnostics.warnings, testing::Contains(testing::HasSubstr("with nothing to do: the scene has no [air]")));
}

/// Vehicles and persons have the usual air where it is worth a hundredth of a speed: the same bits as with a section that says so.
TEST(AirDrag, IsThereRoundPersonsAndVehiclesWithoutASection) {
  Model model = shipped("cases/sedan_pedestrian_40kmh.toml");
  model.settings.duration = 0.4;
  const PlanLine line = air_line(compile(model).lines);
  EXPECT_TRUE(line.active);
  EXPECT_EQ(line.reason, "still air of 1.2 kg/m^3, the usual, around vehicles and persons");
  const Recording usual = simulate(model);
  add_air(model, {0, 0, 0});
  model.inputs["air.drag"] = {1.2, 0, 0};
  const Recording said = simulate(model);
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    EXPECT_EQ(usual.snapshots.back().bodies[b].X_WB.p, said.snapshots.back().bodies[b].X_WB.p) << model.bodies[b].name;
}

/// What the plan says drag takes at most is at least the speed that the air takes along a run.
TEST(AirDrag, TakesNoMoreThanThePlanSays) {
  for (const auto& [v, w] :
       {std::pair{Vec3(0.3, 0, 0), Vec3(0, 0, 0)}, {Vec3(5, 0, 3), Vec3(0, 0, 0)}, {Vec3(0.1, 0, 0), Vec3(0, 9, 0)}}) {
    Model model = in_air(0.5);
    model.ground.plane = true;
    model.settings.gravity = {0, 0, -kGravity};
    model.bodies = {test::ball(0.1, 5, {0, 0, 0.3})};
    model.bodies[0].V_WB = {v, w};
    double most = 0;
    const std::string text = air_line(compile(model).lines).left_out;
    ASSERT_EQ(std::sscanf(text.c_str(), "drag takes at most %lf m/s", &most), 1) << text;
    EXPECT_THAT(text, testing::HasSubstr("an estimate with usual drag coefficients"));
    const double k = 1.2 * drag_of_ball(0.1, 5);
    double taken = 0;
    const Recording run = simulate(model);
    for (const Snapshot& s : run.snapshots) taken += k * s.bodies[0].V_WB.v.squaredNorm() * model.settings.record_interval;
    EXPECT_GT(most, taken);
    EXPECT_LT(most, 100 * std::max(taken, 1e-3)) << "of use";
  }
}

/// A body on a hinge falls no farther than twice its length: the plan bounded this one's speed at 325 m/s, for falling freely.
TEST(AirDrag, BoundsTheSpeedOfWhatHangsOnJoints) {
  const Model model = shipped("gallery/babyboot.toml");
  double bound = 0, fastest = 0;
  const std::string text = air_line(compile(model).lines).left_out;
  const char* words = "drag takes at most all of the speed of pendulum, which energy bounds at %lf m/s";
  ASSERT_EQ(std::sscanf(text.c_str(), words, &bound), 1) << text;
  Model first_second = model;
  first_second.settings.duration = 1;
  for (const Snapshot& s : simulate(first_second).snapshots) fastest = std::max(fastest, s.bodies[0].V_WB.v.norm());
  EXPECT_GT(fastest, 0);
  EXPECT_GT(bound, fastest);
  // of all the energy: 100 g from 0.2 m below the hinge to 0.2 m above it, and 10 g, in the 10 g
  EXPECT_LT(bound, std::sqrt(2 * kGravity * (0.1 * 0.41 + 0.01 * 0.16) / 0.01));
}

/// What stands on the ground has no height to fall from, and what turns by itself in free space has no speed.
TEST(AirDrag, TakesNothingFromWhatStandsOrTurnsByItself) {
  for (const char* scene : {"gallery/materials.toml", "gallery/free_body.toml"}) {
    const Model model = shipped(scene);
    EXPECT_EQ(air_line(compile(model).lines).reason, "no speed for drag to take") << scene;
    for (const Snapshot& s : simulate(model).snapshots)
      for (const BodyState& body : s.bodies) EXPECT_LT(body.V_WB.v.norm(), 1e-9) << scene;
  }
}

TEST(AirDrag, TellsWhatPushesThoseWhoWait) {
  Model model = shipped("cases/sedan_pedestrian_40kmh.toml");
  model.settings.duration = 0.05;
  add_air(model, {-60, 0, 0});
  EXPECT_THAT(air_line(compile(model).lines).left_out, testing::HasSubstr("N on pedestrian"));
  EXPECT_THAT(simulate(model).diagnostics.warnings, testing::Contains(testing::HasSubstr("zero_condition = false")));
  add_air(model, {-3, 0, 0});
  EXPECT_THAT(simulate(model).diagnostics.warnings, testing::Not(testing::Contains(testing::HasSubstr("zero_condition = false"))));
}

/// The effect is the pattern for new ones: its scene keys included, the program knows it from one file and its line in the table.
TEST(AirDrag, StandsInOneFileAndOneLineOfTheTable) {
  const std::filesystem::path root = CRASHREEL_SOURCE_DIR;
  std::map<std::string, int> lines;
  for (const char* room : {"engine", "scenes/loader", "render", "cli"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / room)) {
      if (entry.path().extension() != ".cpp" && entry.path().extension() != ".h") continue;
      std::ifstream file(entry.path());
      for (std::string line; std::getline(file, line);)
        if (line.find("AirDrag") != std::string::npos || line.find("\"air.") != std::string::npos ||
            line.find("air_drag") != std::string::npos)
          ++lines[entry.path().filename().string()];
    }
  EXPECT_GT(lines.at("air_drag.cpp"), 1);
  EXPECT_EQ(lines.at("table.cpp"), 1);
  EXPECT_EQ(lines.size(), 2U);
}

TEST(AirDrag, IsReadFromTheScene) {
  const Model model = shipped("gallery/wind.toml");
  const PlanLine line = air_line(compile(model).lines);
  EXPECT_TRUE(line.active);
  EXPECT_EQ(line.reason, "air of 1.2 kg/m^3, wind of 20 m/s");
  const Recording run = simulate(model);
  for (std::size_t b = 0; b < 2; ++b) {
    const double k = 0.47 * kDensity * std::numbers::pi * 0.04 / (2 * model.bodies[b].mass), w = 20, t = 2;
    EXPECT_NEAR(run.snapshots.back().bodies[b].X_WB.p.x(), w * t - std::log(1 + k * w * t) / k, 1e-8);
  }
}

namespace {

/// A library vehicle by itself, or with somebody on it.
Model alone(const std::string& vehicle, const std::string& rider = "") {
  const auto file = std::filesystem::temp_directory_path() / fmt::format("{}_alone_{}.toml", vehicle, getpid());
  std::ofstream(file) << "[[vehicle]]\nname = \"it\"\nmodel = \"" << vehicle << "\"\n" << rider;
  Model model = scenes::load(file).model;
  std::filesystem::remove(file);
  return model;
}

/// [m^2] in front, of a two-wheeler and who rides it: what the air takes over some steps at 20 m/s.
double ridden_drag_area(const std::string& vehicle, const std::string& pose) {
  constexpr double kSpeed = 20;
  Model model = alone(vehicle, "[[person]]\nname = \"rider\"\nrides = \"it\"\nzero_condition = false\npose = \"" + pose + "\"\n");
  for (Body& body : model.bodies) body.V_WB.v = {kSpeed, 0, 0};
  model.ground.plane = false;
  model.settings.gravity.setZero();
  model.settings.duration = 4e-3;
  const Recording run = simulate(model);
  const auto effect = std::find(run.effect_names.begin(), run.effect_names.end(), "air_drag") - run.effect_names.begin();
  const double taken = run.snapshots.back().energies.dissipated[static_cast<std::size_t>(effect)];
  return taken / (0.5 * kDensity * kSpeed * kSpeed * kSpeed * run.end_time());
}

}  // namespace

/// Published coefficients (Heisler, chapter 14) times width and height of the class.
TEST(AirDrag, OfAVehicleIsThatOfItsClass) {
  const std::map<std::string, std::pair<double, double>> range = {{"sedan", {0.5, 0.95}}, {"small_car", {0.5, 0.95}},
                                                                  {"suv", {0.7, 1.3}},    {"van", {1.2, 2.5}},
                                                                  {"bus", {2.8, 6}},      {"truck", {4, 7}}};
  for (const auto& [name, bounds] : range) {
    const Model model = alone(name);
    const Aabb box = std::get<MeshShape>(model.bodies[0].shape).mesh->bounds();
    const Vec3 side = box.upper - box.lower;
    const double area = model.vehicles[0].drag.x() * side.y() * side.z();
    EXPECT_GT(area, bounds.first) << name;
    EXPECT_LT(area, bounds.second) << name;
  }
  EXPECT_GT(alone("bus").vehicles[0].drag.x(), 1.5 * alone("sedan").vehicles[0].drag.x());
}

/// Zeros given for all meshes are no drag; left out, the vehicle has its own.
TEST(AirDrag, OfAVehicleIsNoneWhereTheSceneGivesZeros) {
  const auto taken = [](const std::string& key) {
    Model model = alone("sedan", "[air]\n" + key);
    model.bodies[0].V_WB.v = {20, 0, 0};
    model.settings.duration = 4e-3;
    const Recording run = simulate(model);
    const auto effect = std::find(run.effect_names.begin(), run.effect_names.end(), "air_drag") - run.effect_names.begin();
    return run.snapshots.back().energies.dissipated.at(static_cast<std::size_t>(effect));
  };
  EXPECT_EQ(taken("vehicle_drag = [0, 0, 0]\n"), 0);
  EXPECT_GT(taken(""), 0);
}

/// Wilson: 0.4 m^2 in touring position to 0.63 m^2 upright; Cossalter: 0.18 to 0.7 m^2.
TEST(AirDrag, OfARiderAndATwoWheelerIsThatMeasured) {
  const double bicycle = ridden_drag_area("bicycle", "cyclist"), motorcycle = ridden_drag_area("motorcycle", "motorcyclist");
  EXPECT_GT(bicycle, 0.4);
  EXPECT_LT(bicycle, 0.7);
  EXPECT_GT(motorcycle, 0.3);
  EXPECT_LT(motorcycle, 0.75);
}

}  // namespace effects_tests
