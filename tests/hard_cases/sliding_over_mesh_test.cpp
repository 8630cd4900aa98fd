// The edges inside a flat mesh must not be felt, also where the mesh is spoilt.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "scenes/scene.h"
#include "tests/hard_cases/hard_case.h"
#include "tests/hard_cases/meshes.h"

namespace hard_cases {
namespace {

/// The scene beside the mesh it slides over, in a folder of its own.
class SlidingOverMesh : public testing::TestWithParam<std::tuple<bool, Setting>> {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("crashreel-sheet-" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
    const Sheet sheet = flat_sheet(0, 12.5, -0.8, 0.8, 250, 40);
    EXPECT_EQ(sheet.triangles.size(), 20000u);
    write_obj(folder_ / "sheet.obj", std::get<0>(GetParam()) ? spoilt(sheet) : sheet);
    std::filesystem::copy_file(CRASHREEL_SOURCE_DIR "/tests/hard_cases/sliding_over_mesh.toml", folder_ / "scene.toml",
                               std::filesystem::copy_options::overwrite_existing);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  Outcome slide(const std::string& friction, const std::string& duration) {
    const auto& [step, scheme] = std::get<1>(GetParam());
    return run(
        scenes::load(folder_ / "scene.toml", {std::string("simulation.step=") + step, std::string("simulation.scheme=") + scheme,
                                              "simulation.duration=" + duration, "body.segment.friction=" + friction})
            .model,
        std::string(step) + " " + scheme);
  }

  std::filesystem::path folder_;
};
INSTANTIATE_TEST_SUITE_P(Meshes, SlidingOverMesh, testing::Combine(testing::Bool(), testing::ValuesIn(kSettings)),
                         [](const auto& tuple) {
                           return std::string(std::get<0>(tuple.param) ? "spoilt" : "clean") + std::to_string(tuple.index);
                         });

TEST_P(SlidingOverMesh, WithoutFrictionNothingIsFelt) {
  const Outcome it = slide("0", "0.5 s");
  double vertical = 0, lateral = 0;
  for (const engine::Snapshot& s : it.recording.snapshots) {
    vertical = std::max(vertical, std::abs(s.bodies[0].V_WB.v.z()));
    lateral = std::max(lateral, std::abs(s.bodies[0].V_WB.v.y()));
  }
  const double change = std::abs(it.last(0).V_WB.v.x() - 10);
  row("sliding over mesh, mu 0", it, "%s: after %.2f m vertical %.1e, lateral %.1e, along %.1e m/s",
      std::get<0>(GetParam()) ? "spoilt" : "clean", it.last(0).X_WB.p.x() - 0.4, vertical, lateral, change);
  EXPECT_GT(it.last(0).X_WB.p.x(), 5.39);
  EXPECT_LT(vertical, 1e-6);
  EXPECT_LT(lateral, 1e-3);
  EXPECT_LT(change, 1e-3);
}

TEST_P(SlidingOverMesh, WithFrictionItStopsWhereCoulombSays) {
  const Outcome it = slide("0.6", "2 s");
  const double distance = it.last(0).X_WB.p.x() - 0.4, expected = 100 / (2 * 0.6 * engine::kGravity);
  row("sliding over mesh, mu 0.6", it, "%s: stops after %.4f m, %+.3f %%", std::get<0>(GetParam()) ? "spoilt" : "clean", distance,
      100 * (distance / expected - 1));
  EXPECT_NEAR(distance, expected, 1e-3 * expected);
}

}  // namespace
}  // namespace hard_cases
