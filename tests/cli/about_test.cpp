// What the program says about itself: its version, its library, the schema of scenes, its help.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/program.h"

using namespace cli_tests;
using testing::HasSubstr;
using testing::IsEmpty;
using Json = nlohmann::json;

TEST(Version, NamesWhatAReportNeedsToBeRepeatable) {
  const Folder folder;
  const Result result = run(folder, {"version", "--json"});
  ASSERT_EQ(result.code, 0) << result.err;
  const Json version = Json::parse(result.out);
  EXPECT_THAT(version.at("build").get<std::string>(), HasSubstr("Release"));
  EXPECT_THAT(version.at("libraries").get<std::string>(),
              testing::MatchesRegex("Eigen [0-9.]+, assimp [0-9.]+, libpng [0-9.]+, .*"));
  EXPECT_THAT(version.at("gl").get<std::string>(), HasSubstr("llvmpipe"));
  if (!sanitized_program()) {
    EXPECT_EQ(version.at("hardening"), "fortify 3, stack protector strong, PIE, full RELRO");
  }
}

TEST(Library, ListsThePersonTheFlagshipUses) {
  const Folder folder;
  const Result result = run(folder, {"library", "--json"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(Json::parse(result.out).at("persons").get<std::vector<std::string>>(), testing::Contains("person-14"));
}

TEST(Library, SaysWhatEachEntryIs) {
  const Folder folder;
  const Result result = run(folder, {"library"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("\n  van              Van, 2500 kg\n"));
  // none without a title
  EXPECT_THAT(result.out, testing::Not(testing::ContainsRegex(" +\n")));
}

TEST(Schema, IsTheJsonSchemaOfScenes) {
  const Folder folder;
  const Result result = run(folder, {"schema"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(Json::parse(result.out).at("$schema").get<std::string>(), HasSubstr("2020-12"));
}

TEST(Help, GoesToStandardOutputAndIsNoError) {
  const Folder folder;
  const Result all = run(folder, {"--help"});
  EXPECT_EQ(all.code, 0);
  EXPECT_THAT(all.out, HasSubstr("render"));
  EXPECT_THAT(all.err, IsEmpty());
  const Result one = run(folder, {"render", "--help"});
  EXPECT_EQ(one.code, 0);
  EXPECT_THAT(one.out, HasSubstr("--camera"));
}
