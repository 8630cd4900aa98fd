// The shipped study pages are of today's engine: what each says of the scene as it stands is the run that `simulate` makes now.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "engine/simulate.h"
#include "scenes/scene.h"

namespace {

namespace fs = std::filesystem;

class ShippedPage : public testing::TestWithParam<const char*> {};

TEST_P(ShippedPage, IsOfTodaysRun) {
  const fs::path root = CRASHREEL_SOURCE_DIR;
  std::ifstream file(root / "cli/study/pages" / fmt::format("{}.json", GetParam()));
  const auto page = nlohmann::json::parse(file);
  const scenes::Scene scene = scenes::load(root / page["scene"]["path"].get<std::string>());
  EXPECT_EQ(page["scene"]["sha256"], scene.sha256);
  EXPECT_EQ(page["recording"], fmt::format("{:016x}", engine::hash(engine::simulate(scene.model))))
      << "cli/study/pages/draw makes it anew";
}

INSTANTIATE_TEST_SUITE_P(Pages, ShippedPage, testing::Values("flagship", "intersection", "thrown_body"),
                         [](const auto& page) { return std::string(page.param); });

}  // namespace
