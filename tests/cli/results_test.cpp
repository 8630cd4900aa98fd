// What the program writes: names and columns other people's scripts rely on, and figures that must add up.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>

#include "cli/build_id.h"
#include "cli/output/recording_file.h"
#include "cli/output/summary.h"
#include "engine/simulate.h"
#include "tests/cli/program.h"

using namespace cli_tests;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Json = nlohmann::json;

namespace {

constexpr double kGravity = 9.81;  // [m/s^2]

using CsvRow = std::map<std::string, std::string>;

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> out;
  std::istringstream fields(line);
  for (std::string field; std::getline(fields, field, ',');) out.push_back(field);
  return out;
}

std::vector<CsvRow> rows_of(const std::string& csv) {
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  const std::vector<std::string> columns = split(line);
  std::vector<CsvRow> rows;
  while (std::getline(lines, line)) {
    const std::vector<std::string> fields = split(line);
    EXPECT_EQ(fields.size(), columns.size()) << line;
    CsvRow row;
    for (std::size_t i = 0; i < fields.size() && i < columns.size(); ++i) row[columns[i]] = fields[i];
    rows.push_back(row);
  }
  return rows;
}

/// The number a script would read; a comma or anything else behind it is a failure.
double number(const std::string& text) {
  double value = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  EXPECT_TRUE(problem == std::errc() && end == text.data() + text.size()) << "\"" << text << "\" is no number";
  return value;
}

double sum(const std::vector<CsvRow>& rows, const std::string& column) {
  double total = 0;
  for (const CsvRow& row : rows) total += number(row.at(column));
  return total;
}

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

std::string gallery(const std::string& name) {
  return std::string(CRASHREEL_SOURCE_DIR) + "/scenes/gallery/" + name;
}

std::string cases(const std::string& name) {
  return std::string(CRASHREEL_SOURCE_DIR) + "/scenes/cases/" + name;
}

TEST(Explain, EveryMeasureOfTheReadmeIsAsTheProgramDefinesIt) {
  const Folder folder;
  const Result all = run(folder, {"explain", "all"});
  ASSERT_EQ(all.code, 0) << all.err;
  EXPECT_NE(contents(std::string(CRASHREEL_SOURCE_DIR) + "/cli/README.md").find(all.out), std::string::npos)
      << "put the output of `crashreel explain all` into cli/README.md";
  const Result one = run(folder, {"explain", "delta_v_mps", "--json"});
  ASSERT_EQ(one.code, 0) << one.err;
  EXPECT_EQ(Json::parse(one.out).at("unit"), "m/s");
  EXPECT_EQ(run(folder, {"explain", "delta_v"}).out, run(folder, {"explain", "delta_v_mps"}).out) << "the unit may be left out";
  const Result none = run(folder, {"explain", "delta_w_mps"});
  EXPECT_EQ(none.code, 2);
  EXPECT_THAT(none.err, HasSubstr("delta_v_mps")) << "the nearest is named";
}

TEST(Simulate, ImpactsAreTheSameInTableAndSummary) {
  const Folder folder;
  const std::string scene = std::string(CRASHREEL_SOURCE_DIR) + "/scenes/cases/intersection_ks.toml";
  const Result result = run(folder, {"simulate", scene, "-q", "-o", "out", "--set", "simulation.duration=1 s"});
  ASSERT_EQ(result.code, 0) << result.err;
  const Json summary = Json::parse(contents(folder / "out/summary.json"));
  const std::vector<CsvRow> rows = rows_of(contents(folder / "out/impacts.csv"));
  ASSERT_FALSE(rows.empty());
  ASSERT_EQ(rows.size(), summary.at("impacts").size());
  const Json& first = summary.at("impacts").at(0);
  EXPECT_EQ(rows[0].at("law"), "kudlich_slibar");
  for (const char* key :
       {"time_s", "closing_speed_mps", "delta_v_a_mps", "delta_v_b_mps", "pdof_a_deg", "ees_a_mps", "energy_lost_J"})
    EXPECT_EQ(number(rows[0].at(key)), first.at(key).get<double>()) << key;
  // what the table says of the hardest impact is what the measures say
  for (const char* side : {"a", "b"}) {
    const std::string name = rows[0].at(std::string("body_") + side);
    EXPECT_EQ(summary.at("metrics").at("delta_v_mps").at(name).get<double>(),
              number(rows[0].at(std::string("delta_v_") + side + "_mps")));
  }
  // momentum: what one loses the other gets, but for the ground
  const double red = first.at("impulse_Ns").at(0).get<double>();
  EXPECT_NE(red, 0);
}

TEST(Simulate, ContactRowsHaveTheirTangentialVector) {
  const Folder folder;
  const Result result = run(folder, {"simulate", gallery("puck_slide.toml"), "-o", "out"});
  ASSERT_EQ(result.code, 0) << result.err;
  for (const CsvRow& row : rows_of(contents(folder / "out/contacts.csv"))) {
    const double x = number(row.at("tangential_x_Ns")), y = number(row.at("tangential_y_Ns")),
                 z = number(row.at("tangential_z_Ns"));
    // a sum of vectors is no longer than the sum of their lengths; on a level road it is level
    EXPECT_LE(std::hypot(x, y, z), number(row.at("tangential_impulse_Ns")) + 1e-9);
    EXPECT_NEAR(z, 0, 1e-9);
    if (row.at("state") == "slide") {
      EXPECT_LT(x, 0) << "friction brakes";
    }
  }
}

}  // namespace

TEST(Simulate, WritesItsFilesWithTheColumnsOfTheContract) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  const Result result = run(folder, {"simulate", "ball.toml", "-o", "out"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(first_line(contents(folder / "out/trajectory.csv")),
            "time_s,body,x_m,y_m,z_m,qw,qx,qy,qz,vx_mps,vy_mps,vz_mps,wx_radps,wy_radps,wz_radps,speed_mps,distance_m,"
            "acceleration_mps2");
  EXPECT_EQ(first_line(contents(folder / "out/contacts.csv")),
            "time_s,kind,body_a,body_b,x_m,y_m,z_m,nx,ny,nz,depth_m,normal_force_N,tangential_force_N,normal_impulse_Ns,"
            "tangential_impulse_Ns,slip_mps,state,tangential_x_Ns,tangential_y_Ns,tangential_z_Ns");
  EXPECT_THAT(first_line(contents(folder / "out/impacts.csv")),
              testing::StartsWith("phase,time_s,duration_s,body_a,body_b,law,x_m,y_m,z_m,nx,ny,nz,closing_speed_mps,impulse_x_Ns,"
                                  "impulse_y_Ns,impulse_z_Ns,friction_used,friction_limit,delta_v_a_mps,delta_v_b_mps,pdof_a_deg,"
                                  "pdof_b_deg,ees_a_mps,ees_b_mps,speed_a_before_mps,speed_a_after_mps,speed_b_before_mps,"
                                  "speed_b_after_mps,yaw_rate_a_before_radps,yaw_rate_a_after_radps,yaw_rate_b_before_radps,"
                                  "yaw_rate_b_after_radps,energy_lost_J"));
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "out")) files.push_back(entry.path().filename().string());
  EXPECT_THAT(files,
              testing::UnorderedElementsAre("trajectory.csv", "contacts.csv", "impacts.csv", "recording.bin", "summary.json"));
  EXPECT_THAT(result.err, IsEmpty()) << "nothing to warn of, too short for progress";
}

TEST(Simulate, TellsSpeedDistanceAndAccelerationOfABrakingCar) {
  const Folder folder;
  folder.write(
      "car.toml",
      "[simulation]\nduration = \"1.5 s\"\n[air]\ndensity = 0\n[[vehicle]]\nname = \"car\"\nmodel = \"sedan\"\nspeed = \"20 m/s\"\n"
      "[[vehicle.driver]]\nfrom = \"0.5 s\"\nbuild_up = \"0 s\"\nlevel = \"5 m/s^2\"\n");
  ASSERT_EQ(run(folder, {"simulate", "car.toml", "-o", "out", "--quiet"}).code, 0);
  const std::vector<CsvRow> rows = rows_of(contents(folder / "out/trajectory.csv"));
  const CsvRow& last = rows.back();
  // pitching moves the centre of mass by some millimetres and swings it by some per cent of the deceleration
  EXPECT_NEAR(number(last.at("speed_mps")), 20 - 5, 0.02);
  EXPECT_NEAR(number(last.at("distance_m")), 20 * 1.5 - 0.5 * 5, 0.02);
  EXPECT_NEAR(number(last.at("acceleration_mps2")), -5, 0.25);
  EXPECT_NEAR(number(rows[rows.size() / 5].at("acceleration_mps2")), 0, 1e-6);
}

TEST(Simulate, TrajectoryHoldsEveryInstantFromTheSceneToItsEnd) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  ASSERT_EQ(run(folder, {"simulate", "ball.toml", "-o", "out"}).code, 0);
  const std::vector<CsvRow> rows = rows_of(contents(folder / "out/trajectory.csv"));
  // 0.4 s, one instant every 5 ms, both ends
  ASSERT_EQ(rows.size(), 81U);
  EXPECT_EQ(rows.front().at("body"), "ball");
  EXPECT_EQ(number(rows.front().at("z_m")), 0.3);
  EXPECT_EQ(number(rows.front().at("vx_mps")), 1);
  EXPECT_EQ(number(rows.front().at("qw")), 1);
  // the last time is 400 steps of 1 ms added up, each rounded
  EXPECT_NEAR(number(rows.back().at("time_s")), 0.4, 1e-12);
}

TEST(Simulate, SummaryHasEveryKeyOfTheContract) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  const Result result = run(folder, {"simulate", "ball.toml", "-o", "out", "--json", "--set", "body.ball.mass=3 kg"});
  ASSERT_EQ(result.code, 0) << result.err;
  const Json summary = Json::parse(contents(folder / "out/summary.json"));
  EXPECT_EQ(Json::parse(result.out), summary);
  EXPECT_EQ(summary.at("schema"), 1);
  EXPECT_EQ(summary.at("scene").at("title"), "Ball");
  EXPECT_EQ(summary.at("scene").at("path"), "ball.toml");
  EXPECT_EQ(summary.at("scene").at("sha256").get<std::string>().size(), 64U);
  EXPECT_EQ(summary.at("scene").at("overrides"), Json::array({"body.ball.mass=3 kg"}));
  EXPECT_EQ(summary.at("settings").at("step_s"), 0.001);
  EXPECT_EQ(summary.at("settings").at("integrator"), "stepping");
  EXPECT_EQ(summary.at("settings").at("contact_model"), "default_auto");
  for (const char* key : {"effect", "active", "reason"}) EXPECT_TRUE(summary.at("plan").at(0).contains(key)) << key;
  EXPECT_TRUE(summary.at("events").is_array());
  EXPECT_TRUE(summary.at("metrics").is_object());
  // half of m v^2 and m g h from the ground
  EXPECT_NEAR(summary.at("energy").at("initial_J").get<double>(), 0.5 * 3 + 3 * kGravity * 0.3, 1e-9);
  for (const char* key : {"final_J", "dissipated_J", "residual_J"}) EXPECT_TRUE(summary.at("energy").contains(key)) << key;
  for (const char* key : {"max_joint_gap_m", "max_joint_angle_error_rad", "max_penetration_m", "max_solver_residual", "warnings",
                          "energy_turned_over_J", "max_unexplained_J", "max_effect_gain_J"}) {
    EXPECT_TRUE(summary.at("diagnostics").contains(key)) << key;
  }
  EXPECT_EQ(summary.at("cost").at("steps"), 400);
  for (const char* key : {"wall_s", "steps_per_s", "realtime_factor", "effects"})
    EXPECT_TRUE(summary.at("cost").contains(key)) << key;
  // one of the steps took the longest, and no longer than the run
  const auto& longest = summary.at("cost").at("longest_step");
  EXPECT_GT(longest.at("processor_s").get<double>(), 0);
  EXPECT_LE(longest.at("processor_s").get<double>(), summary.at("cost").at("wall_s").get<double>());
  EXPECT_GT(longest.at("time_s").get<double>(), 0);
  EXPECT_FALSE(longest.at("bodies").empty());
}

TEST(BuildId, IsWhatTheLinkerWrote) {
  FILE* readelf = popen(("readelf -n /proc/" + std::to_string(getpid()) + "/exe").c_str(), "r");
  ASSERT_NE(readelf, nullptr);
  std::string notes;
  for (char piece[256]; std::fgets(piece, sizeof piece, readelf);) notes += piece;
  pclose(readelf);
  EXPECT_THAT(notes, HasSubstr("Build ID: " + cli::build_id() + "\n"));
}

TEST(RecordingFile, HoldsWhatTheRunSawOfEachEffect) {
  const Folder folder;
  const scenes::Scene scene = scenes::load(gallery("ball_default_auto.toml"));
  const engine::Recording run = engine::simulate(scene.model);
  folder.write("recording.bin", cli::recording_bytes(scene, run));
  const std::optional<engine::Recording> kept = cli::read_recording(folder / "recording.bin", scene);
  ASSERT_TRUE(kept);
  ASSERT_EQ(kept->plan.size(), run.plan.size());
  int acted = 0;
  for (std::size_t i = 0; i < run.plan.size(); ++i) {
    const engine::PlanLine &was = run.plan[i], &is = kept->plan[i];
    EXPECT_EQ(is.not_before, was.not_before) << was.effect;
    EXPECT_EQ(is.acted.told, was.acted.told) << was.effect;
    EXPECT_EQ(is.acted.in_reach, was.acted.in_reach) << was.effect;
    EXPECT_EQ(is.acted.first, was.acted.first) << was.effect;
    EXPECT_EQ(is.acted.last, was.acted.last) << was.effect;
    acted += was.acted.first > 0;
  }
  EXPECT_GT(acted, 0);  // the ball fell on the ground
}

TEST(SlowStep, IsToldFromASecondOfProcessorTimeOn) {
  engine::Recording run;
  EXPECT_EQ(cli::slow_step(run), "");
  run.longest_step = engine::LongestStep{0.99, 0.5, {"head"}};
  EXPECT_EQ(cli::slow_step(run), "");
  run.longest_step = engine::LongestStep{2.5, 0.512, {"head", "car"}};
  EXPECT_EQ(cli::slow_step(run), "the step to 0.512 s took 2.5 s of processor time: head, car");
}

TEST(Simulate, ImpulseColumnsAddUpToTheMomentumThatWasExchanged) {
  const Folder folder;
  const Result result =
      run(folder, {"simulate", gallery("puck_slide.toml"), "-o", "out", "--set", "simulation.stop_at_rest=false"});
  ASSERT_EQ(result.code, 0) << result.err;
  const std::vector<CsvRow> contacts = rows_of(contents(folder / "out/contacts.csv"));
  const double duration = number(rows_of(contents(folder / "out/trajectory.csv")).back().at("time_s"));
  constexpr double kMass = 10;        // [kg] of the scene
  constexpr double kSpeed = 13.4112;  // [m/s] of the scene
  constexpr double kStep = 1e-3;      // [s]
  constexpr double kInterval = 5e-3;  // [s] between rows
  constexpr double kFriction = 0.6;   // [-] of the scene
  // the ground carries the weight the whole time; the first and the last step may each be off by their own weight
  EXPECT_NEAR(sum(contacts, "normal_impulse_Ns"), kMass * kGravity * duration, 2 * kMass * kGravity * kStep);
  // While it slides, friction takes the whole momentum. At rest the points of the face hold against each other, which moves
  // nothing; the row in which the puck stops counts as rest, so what friction does in one interval may be missing.
  std::vector<CsvRow> sliding;
  std::copy_if(contacts.begin(), contacts.end(), std::back_inserter(sliding),
               [](const CsvRow& row) { return row.at("state") == "slide"; });
  EXPECT_NEAR(sum(sliding, "tangential_impulse_Ns"), kMass * kSpeed, kFriction * kMass * kGravity * kInterval);
  for (const CsvRow& row : contacts) {
    EXPECT_EQ(row.at("kind"), "ground");
    EXPECT_EQ(row.at("body_a"), "puck");
    EXPECT_EQ(row.at("body_b"), "ground");
    EXPECT_GT(number(row.at("nz")), 0.999) << "the normal points from the ground to the puck";
  }
}

TEST(Simulate, EventsNameTheirBodies) {
  const Folder folder;
  const Result result = run(folder, {"simulate", gallery("puck_slide.toml"), "-o", "out", "--json"});
  ASSERT_EQ(result.code, 0) << result.err;
  const Json events = Json::parse(result.out).at("events");
  const auto rest = std::find_if(events.begin(), events.end(), [](const Json& event) { return event.at("kind") == "rest"; });
  ASSERT_NE(rest, events.end());
  EXPECT_EQ(rest->at("a"), "puck");
  EXPECT_TRUE(rest->at("b").is_null()) << "rest has no partner";
  // v/(mu g); rest is looked for once an interval, at a speed just above zero
  EXPECT_NEAR(rest->at("time_s").get<double>(), 13.4112 / (0.6 * kGravity), 0.02);
}

TEST(Simulate, ARiderRunningIntoACarTellsTheCollisionWithItsUnit) {
  const Folder folder;
  const Result result =
      run(folder, {"simulate", cases("motorcycle.toml"), "--set", "simulation.duration=0.4 s", "-o", "out", "--json"});
  ASSERT_EQ(result.code, 0) << result.err;
  const Json events = Json::parse(result.out).at("events");
  const auto hit = std::find_if(events.begin(), events.end(), [](const Json& event) { return event.at("kind") == "collision"; });
  ASSERT_NE(hit, events.end());
  EXPECT_EQ(hit->at("a"), "sedan");
  EXPECT_EQ(hit->at("b"), "motorcycle");
  EXPECT_EQ(hit->at("unit"), "m/s");
  // 50 km/h square on a flank that moves along itself
  EXPECT_NEAR(hit->at("value").get<double>(), 50 / 3.6, 0.1);
  for (const Json& event : events)
    if (event.at("kind") == "joint_broken") {
      EXPECT_EQ(event.at("unit"), "N");
    } else if (event.at("kind") == "release") {
      EXPECT_TRUE(event.at("unit").is_null());
    }
}

/// Rider and mount are one until something touches them, and have a rest where they halt.
TEST(Simulate, ARiddenTwoWheelerThatBrakesToAHaltRests) {
  const Folder folder;
  const auto absent_and_metrics = [&folder](const std::string& speed, const std::string& duration) {
    folder.write("a.toml", "[simulation]\nduration = \"" + duration +
                               "\"\n[[vehicle]]\nname = \"bike\"\nmodel = \"bicycle\"\nspeed = \"" + speed +
                               "\"\n[vehicle.brake]\nfrom = \"0.3 s\"\nbuild_up = \"0 s\"\ndeceleration = \"4 m/s^2\"\n" +
                               "[[person]]\nname = \"r\"\npose = \"cyclist\"\nrides = \"bike\"\n");
    EXPECT_EQ(run(folder, {"simulate", "a.toml", "-o", "out", "--overwrite"}).code, 0);
    const Json summary = Json::parse(contents(folder / "out/summary.json"));
    return std::pair(summary.at("absent"), summary.at("metrics"));
  };
  const auto [none, halted] = absent_and_metrics("5 m/s", "5 s");
  EXPECT_FALSE(none.contains("rest_s"));
  for (const char* who : {"bike", "r"}) EXPECT_NEAR(halted.at("rest_s").at(who).get<double>(), 1.55, 0.01) << who;
  // from where its centre of mass starts: 1.5 m until the brake, 3.125 m with it
  EXPECT_NEAR(halted.at("rest_x_m").get<double>(), -0.13 + 4.625, 0.01);
  const auto [too_short, until] = absent_and_metrics("5 m/s", "1.65 s");
  EXPECT_FALSE(until.contains("rest_s"));
  for (const char* who : {"bike", "r"})
    EXPECT_EQ(too_short.at("rest_s").at(who), "still for less than 0.25 s when the run ends") << who;
  const auto [stands, parked] = absent_and_metrics("0 m/s", "1 s");
  EXPECT_EQ(stands.at("rest_s").at("r"), "nothing touched it: it stands as it stood") << "of the rider";
  EXPECT_EQ(parked.at("rest_s"), 0.0) << "of the bicycle, as of a car that is parked";
}

TEST(Simulate, TheSameRunHasTheSameHashEveryTime) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  std::vector<std::string> hashes;
  for (const char* out : {"first", "second"}) {
    const Result result = run(folder, {"simulate", "ball.toml", "-o", out, "--json"});
    ASSERT_EQ(result.code, 0) << result.err;
    hashes.push_back(Json::parse(result.out).at("recording").at("hash"));
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(contents(folder / "first/trajectory.csv"), contents(folder / "second/trajectory.csv"));
  EXPECT_EQ(contents(folder / "first/contacts.csv"), contents(folder / "second/contacts.csv"));
  const Result other =
      run(folder, {"simulate", "ball.toml", "-o", "third", "--json", "--set", "body.ball.velocity=1.000001 0 0 m/s"});
  EXPECT_NE(Json::parse(other.out).at("recording").at("hash"), hashes[0]) << "a hash that never changes proves nothing";
}

TEST(Simulate, NumbersHaveAPointWhereTheUserWritesAComma) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  // a locale made here, so that the test does not depend on the machine's
  const std::string make = "localedef -i de_DE -f UTF-8 '" + (folder / "de_DE.UTF-8").string() + "' >/dev/null 2>&1";
  ASSERT_EQ(std::system(make.c_str()), 0) << "package locales is missing";
  const std::vector<std::string> german = {"LOCPATH=" + folder.path().string(), "LC_ALL=de_DE.UTF-8", "LANG=de_DE.UTF-8"};
  ASSERT_EQ(run(folder, {"simulate", "ball.toml", "-o", "plain"}).code, 0);
  ASSERT_EQ(run(folder, {"simulate", "ball.toml", "-o", "german", "--set", "body.ball.mass=2.0 kg"}, german).code, 0);
  EXPECT_EQ(contents(folder / "plain/trajectory.csv"), contents(folder / "german/trajectory.csv"));
  EXPECT_EQ(contents(folder / "plain/contacts.csv"), contents(folder / "german/contacts.csv"));
}

TEST(Simulate, ADivergedRunIsKeptAndEndsWithExitCode4) {
  const Folder folder;
  // no road is that fast
  folder.write("ball.toml", ball_with("velocity = \"1 0 0 m/s\"", "velocity = \"1e7 0 0 m/s\""));
  const Result result = run(folder, {"simulate", "ball.toml", "-o", "out"});
  EXPECT_EQ(result.code, 4);
  EXPECT_THAT(result.err, testing::StartsWith("crashreel: the model diverged at 0.00"));
  EXPECT_THAT(result.err, HasSubstr("body ball"));
  EXPECT_EQ(Json::parse(contents(folder / "out/summary.json")).at("failure").at("body"), "ball");
  EXPECT_FALSE(rows_of(contents(folder / "out/trajectory.csv")).empty()) << "the recording up to there can be drawn";
}

TEST(Plan, AnEffectForcedOffIsAWarningInTheResults) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  const Result result = run(folder, {"simulate", "ball.toml", "-o", "out", "--effects", "gravity=off", "--json"});
  ASSERT_EQ(result.code, 0);
  EXPECT_THAT(result.err, HasSubstr("gravity"));
  const Json summary = Json::parse(result.out);
  EXPECT_THAT(summary.at("diagnostics").at("warnings").dump(), HasSubstr("gravity"));
  for (const Json& line : summary.at("plan")) {
    EXPECT_FALSE(line.at("effect") == "gravity" && line.at("active")) << line;
  }
  // nothing pulls: the ball flies straight on
  const std::vector<CsvRow> rows = rows_of(contents(folder / "out/trajectory.csv"));
  EXPECT_EQ(number(rows.back().at("z_m")), 0.3);
}

TEST(Simulate, HeadImpactWithoutCriterionGivesTheReason) {
  const Folder folder;
  const std::string scene = std::string(CRASHREEL_SOURCE_DIR) + "/scenes/cases/sedan_pedestrian_40kmh.toml";
  const Result result = run(folder, {"simulate", scene, "-q", "-o", "out", "--set", "simulation.duration=0.8 s", "--set",
                                     "simulation.contact_law=default_auto"});
  ASSERT_EQ(result.code, 0) << result.err;
  const Json summary = Json::parse(contents(folder / "out/summary.json"));
  ASSERT_TRUE(summary.at("metrics").contains("head_impact_s")) << "40 km/h carry the head onto the car";
  std::vector<std::string> absent;
  for (const auto& [name, reason] : summary.at("absent").items()) {
    absent.push_back(name);
    EXPECT_FALSE(reason.empty()) << name;
    EXPECT_FALSE(reason.is_string() && summary.at("metrics").contains(name)) << "either a figure or a reason: " << name;
  }
  EXPECT_THAT(absent, testing::IsSupersetOf({"hic15", "hic36", "three_ms_g", "peak_acceleration_mps2"}));
  EXPECT_THAT(result.out, HasSubstr("absent "));
  EXPECT_LE(std::count(result.out.begin(), result.out.end(), '\n'), 40) << "fits a screen";

  folder.write("ball.toml", kBall);
  ASSERT_EQ(run(folder, {"simulate", "ball.toml", "-o", "ball"}).code, 0);
  EXPECT_FALSE(Json::parse(contents(folder / "ball/summary.json")).contains("absent")) << "nobody's head was struck";
}

/// Of two vehicles one alone has a delta-v: by name all the same, for a script cannot know whose a bare number is.
TEST(Results, OfSeveralVehiclesEachMeasureIsByName) {
  const Folder folder;
  folder.write(
      "two.toml",
      std::string("[simulation]\nduration = \"0.3 s\"\n[[vehicle]]\nname = \"a\"\nmodel = \"sedan\"\nspeed = \"36 km/h\"\n") +
          "[[vehicle]]\nname = \"b\"\nmodel = \"sedan\"\nposition = \"0 9 m\"\n[[body]]\nname = \"post\"\nfixed = true\n" +
          "axes = \"0.2 0.2 1 m\"\nposition = \"4 0 1 m\"\n");
  ASSERT_EQ(run(folder, {"simulate", "two.toml", "-o", "out", "--quiet"}).code, 0);
  const Json metrics = Json::parse(contents(folder / "out/summary.json")).at("metrics");
  EXPECT_TRUE(metrics.at("delta_v_mps").at("a").is_number());
  EXPECT_FALSE(metrics.at("delta_v_mps").contains("b"));
}
