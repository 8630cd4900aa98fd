// Rest places of a sample: their regions, their drawing; and samples computed in parts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "../program.h"
#include "cli/inference/rest.h"
#include "cli/inference/sequence.h"

namespace cli_tests {
namespace {

using namespace cli::inference;
using render::Point2;
using ::testing::HasSubstr;

const std::string kPuck = std::string(CRASHREEL_SOURCE_DIR) + "/scenes/gallery/sample_puck.toml";

/// Normal places with deviations of 3 and 1 m, turned by 30 degrees.
std::vector<Point2> cloud(std::uint64_t from, std::uint64_t count) {
  std::vector<Point2> out;
  const double c = std::cos(M_PI / 6), s = std::sin(M_PI / 6);
  for (const auto& u : scrambled_points(2, from, count, 3)) {
    const double x = 3 * normal_score(u[0]), y = normal_score(u[1]);
    out.emplace_back(10 + c * x - s * y, -4 + s * x + c * y);
  }
  return out;
}

TEST(RestRegion, HoldsItsShareOfPlacesThatDidNotMakeIt) {
  const std::vector<Point2> places = cloud(0, 1024), others = cloud(1024, 1024);
  for (const double share : {0.5, 0.95}) {
    const render::RestRegion region = region_of(places, share);
    double inside = 0;
    for (const Point2& p : others) inside += holds(region, p) / 1024.0;
    // the kernel widens a normal cloud by h^2/2 = n^(-1/3)/2 = 5 % of each deviation, and the level is that of the sample: 3 %
    EXPECT_NEAR(inside, share, 0.03);
  }
}

TEST(RestRegion, OfTwoHeapsIsTwoIslands) {
  std::vector<Point2> places = cloud(0, 256);
  for (const Point2& p : cloud(256, 256)) places.emplace_back(p.x() + 40, p.y());
  const render::RestRegion region = region_of(places, 0.95);
  EXPECT_TRUE(holds(region, {10, -4}));
  EXPECT_TRUE(holds(region, {50, -4}));
  EXPECT_FALSE(holds(region, {30, -4}));  // nobody lies between
}

TEST(RestRegion, OfAHandfulIsNotGiven) {
  EXPECT_TRUE(region_of(cloud(0, kFewestPlaces - 1), 0.5).edge.empty());
}

TEST(Sample, DrawsWhereRunsEnd) {
  const Folder folder;
  const Result result = run(folder, {"sample", kPuck, "-o", "out", "-n", "32", "--quiet"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("rest_cloud.pdf, rest_cloud.svg, rest_ghosts.png; finished runs in out/runs\n"));
  EXPECT_GT(contents(folder / "out/rest_cloud.svg").size(), 5000u);
  EXPECT_THAT(contents(folder / "out/rest_ghosts.png"), testing::StartsWith("\x89PNG"));
}

/// Speeds that somebody chose have no densest half, however many, and none of them is a percentile.
TEST(RestClouds, OfChosenValuesHaveNoRegions) {
  for (const bool chosen : {true, false}) {
    Table table;
    table.grid_keys = {"body.puck.speed"};
    for (const Point2& place : cloud(0, 2 * kFewestPlaces)) {
      Row row;
      row.grid = {"5 m/s"};
      if (!chosen) row.values = {0.4};
      row.answer.rests["puck"] = {place.x(), place.y()};
      table.rows.push_back(row);
    }
    EXPECT_EQ(clouds_of(table).front().regions.size(), chosen ? 0u : 2u);
    table.rows.resize(kFewestPlaces - 1);
    EXPECT_TRUE(clouds_of(table).front().regions.empty());
  }
}

TEST(Sample, InPartsHasTheSameNumbers) {
  const Folder folder;
  ASSERT_EQ(run(folder, {"sample", kPuck, "-o", "whole", "-n", "10", "--quiet"}).code, 0);
  for (const char* part : {"3/3", "1/3", "2/3"}) {
    const Result result = run(folder, {"sample", kPuck, "-o", "parts", "-n", "10", "--part", part});
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr(part[0] == '1' ? "4 of 10 runs are done" : "3 of 10 runs are done"));
    EXPECT_FALSE(std::filesystem::exists(folder / "parts/runs.csv"));
  }
  std::size_t lines = 0;
  const auto count = [&] {
    lines = 0;
    for (const auto& journal : std::filesystem::directory_iterator(folder / "parts/runs")) {
      const std::string text = contents(journal.path());
      lines += static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
    }
    return lines;
  };
  EXPECT_EQ(count(), 10u);
  ASSERT_EQ(run(folder, {"sample", kPuck, "-o", "parts", "-n", "10", "--quiet"}).code, 0);
  EXPECT_EQ(count(), 10u);  // joined, none run again
  EXPECT_EQ(contents(folder / "parts/runs.csv"), contents(folder / "whole/runs.csv"));
  EXPECT_EQ(contents(folder / "parts/sample.json"), contents(folder / "whole/sample.json"));
}

TEST(Sample, RefusesPartsThatAreNone) {
  const Folder folder;
  const auto refused = [&](const std::string& part) { return run(folder, {"sample", kPuck, "-o", "out", "--part", part}); };
  EXPECT_EQ(refused("3").code, 2);
  EXPECT_THAT(refused("3").err, HasSubstr("--part is \"3\": must be K/N, like 3/8 for the third of eight jobs"));
  EXPECT_EQ(refused("4/3").code, 2);
  EXPECT_EQ(refused("0/3").code, 2);
}

TEST(Fit, AKnownTruthLiesInTheInterval) {
  const Folder folder;
  const std::string scene = std::string(CRASHREEL_SOURCE_DIR) + "/scenes/gallery/fit_thrown_body.toml";
  ASSERT_EQ(run(folder, {"fit", scene, "-o", "out", "-n", "800", "--quiet"}).code, 0);
  const auto all = nlohmann::json::parse(contents(folder / "out/fit.json"));
  EXPECT_TRUE(all["single_number"].get<bool>()) << all["reasons"].dump();
  // thrown at 6.5 m/s with 0.42, each evidence within half a tolerance of that run's
  EXPECT_LE(all["inputs"]["variables.speed"]["p2_5"].get<double>(), 6.5);
  EXPECT_GE(all["inputs"]["variables.speed"]["p97_5"].get<double>(), 6.5);
  EXPECT_LE(all["inputs"]["variables.friction"]["p2_5"].get<double>(), 0.42);
  EXPECT_GE(all["inputs"]["variables.friction"]["p97_5"].get<double>(), 0.42);
  // the landing alone tells the speed to its tolerance over the time of flight, 0.1 m in 0.7 s: 4 sd of that, and no wider
  EXPECT_LT(all["inputs"]["variables.speed"]["p97_5"].get<double>() - all["inputs"]["variables.speed"]["p2_5"].get<double>(), 0.57);
}

TEST(Fit, WhatTheEvidenceSaysNothingOfIsToldAsAssumed) {
  const Folder folder;
  std::string scene = contents(std::string(CRASHREEL_SOURCE_DIR) + "/scenes/gallery/fit_thrown_body.toml");
  const std::string friction = "\nfriction = 0.4\n";
  ASSERT_NE(scene.find(friction), std::string::npos);
  scene.insert(scene.find(friction) + friction.size(), "idle = \"1 m\"\n");
  folder.write("idle.toml", scene + "\n[[uncertain]]\nkey = \"variables.idle\"\nuniform = \"1 2 m\"\n");
  const Result result = run(folder, {"fit", "idle.toml", "-o", "out", "-n", "800", "--quiet"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("variables.idle 1.0 to 2.0 m (95 %), as probably above as below 1.5 m; so it was assumed, the "
                                    "evidence hardly narrows it.\n"));
  // half and a tenth as wide as beforehand
  EXPECT_THAT(result.out, testing::ContainsRegex("variables\\.friction [^\n]* as below 0\\.4[0-9]\\.\n"));
  EXPECT_THAT(result.out, testing::ContainsRegex("variables\\.speed [^\n]* as below 6\\.5 m/s\\.\n"));
}

}  // namespace
}  // namespace cli_tests
