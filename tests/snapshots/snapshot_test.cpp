// The gallery and the cases, tested as a user tests a folder of scenes: by the command itself.
// After a wanted change: look at the report, then build/crashreel snapshot scenes/gallery --update NAMES.
#include <gtest/gtest.h>

#include "tests/cli/program.h"

using namespace cli_tests;

namespace {

class Shipped : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Scenes, Shipped, testing::Values("gallery", "cases"), [](const auto& folder) { return folder.param; });

TEST_P(Shipped, LookAndMeasureAsTheirBaselinesSay) {
  const Folder folder;
  const std::filesystem::path scenes = std::filesystem::path(CRASHREEL_SOURCE_DIR) / "scenes" / GetParam();
  // the report stays for whoever has to look at it
  const std::filesystem::path report = std::filesystem::current_path() / (std::string("snapshots_") + GetParam());
  const Result result = run(folder, {"snapshot", scenes.string(), "--report", report.string()});
  EXPECT_EQ(result.code, 0) << result.out << result.err;
}

}  // namespace
