// Every gallery scene that names stills is drawn and compared with its baseline beside this file.
// CRASHREEL_UPDATE_SNAPSHOTS=1 writes the baselines anew: look at them before committing.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "engine/simulate.h"
#include "render/arrange.h"
#include "render/image/png.h"
#include "render/renderer.h"
#include "scenes/scene.h"

namespace {

namespace fs = std::filesystem;
const fs::path kSource = CRASHREEL_SOURCE_DIR;
constexpr int kWidth = 320, kHeight = 180;
constexpr int kTile = 12;  // [pixels]
// A tile of a picture that only another processor drew differs by some 1/255 in a few pixels: a mean of 0.02. A line moved by a
// pixel or a missing arrow changes a tenth of a tile by a hundred: a mean of ten; another digit of the small caption, a mean
// of 1.5.
constexpr double kWorstTile = 1;  // [1/255] mean absolute difference

std::vector<fs::path> scenes_with_stills() {
  std::vector<fs::path> out;
  for (const char* folder : {"scenes/gallery", "scenes/cases"})
    for (const auto& entry : fs::directory_iterator(kSource / folder))
      if (entry.path().extension() == ".toml") out.push_back(entry.path());
  std::sort(out.begin(), out.end());
  return out;
}

/// Largest mean absolute difference of a channel over all tiles.
double worst_tile(const render::Image& a, const render::Image& b) {
  double worst = 0;
  for (int ty = 0; ty < a.height; ty += kTile)
    for (int tx = 0; tx < a.width; tx += kTile) {
      double sum = 0;
      int count = 0;
      for (int y = ty; y < std::min(ty + kTile, a.height); ++y)
        for (int x = tx; x < std::min(tx + kTile, a.width); ++x)
          for (int c = 0; c < 3; ++c, ++count) {
            const auto at = static_cast<std::size_t>(4 * (y * a.width + x) + c);
            sum += std::abs(a.rgba[at] - b.rgba[at]);
          }
      worst = std::max(worst, sum / count);
    }
  return worst;
}

class Snapshot : public testing::TestWithParam<fs::path> {};
INSTANTIATE_TEST_SUITE_P(Shipped, Snapshot, testing::ValuesIn(scenes_with_stills()),
                         [](const auto& scene) { return scene.param.stem().string(); });

TEST_P(Snapshot, LooksLikeItsBaseline) {
  scenes::Scene scene = scenes::load(GetParam());
  if (scene.output.stills.empty()) return;  // an experiment with numbers only
  scene.stage.provenance.clear();           // version and hash of the scene are no part of the picture
  const engine::Recording run = engine::simulate(scene.model);
  render::Renderer renderer(kWidth, kHeight, render::Quality::standard);
  const bool update = std::getenv("CRASHREEL_UPDATE_SNAPSHOTS") != nullptr;
  for (const auto& [time, camera] : scene.output.stills) {
    render::Image image;
    renderer.draw(render::arrange(scene.stage, run, {time, camera, 1}, static_cast<double>(kWidth) / kHeight), image);
    const std::string name = fmt::format("{}_{}_{:g}s.png", GetParam().stem().string(), camera, time);
    const fs::path baseline = kSource / "tests/snapshots" / name;
    if (update) render::write_png(baseline, image);
    ASSERT_TRUE(fs::exists(baseline)) << baseline << " is missing: look at what CRASHREEL_UPDATE_SNAPSHOTS=1 writes";
    const render::Image expected = render::read_png(baseline);
    ASSERT_EQ(expected.width, image.width);
    ASSERT_EQ(expected.height, image.height);
    const double worst = worst_tile(expected, image);
    if (worst > kWorstTile) render::write_png(fs::current_path() / ("actual_" + name), image);
    EXPECT_LE(worst, kWorstTile) << name << ": the picture drawn is " << fs::current_path() / ("actual_" + name);
  }
}

TEST(SnapshotLimit, SeesAWrongDigitAndATurnedLimb) {
  scenes::Scene scene = scenes::load(kSource / "scenes/gallery/pose_standing.toml");
  const engine::Recording run = engine::simulate(scene.model);
  render::Renderer renderer(kWidth, kHeight, render::Quality::standard);
  auto draw = [&](const engine::Recording& what, double time) {
    render::Image image;
    renderer.draw(
        render::arrange(scene.stage, what, {time, scene.stage.cameras.front().name, 1}, static_cast<double>(kWidth) / kHeight),
        image);
    return image;
  };
  const render::Image right = draw(run, 0);
  EXPECT_EQ(worst_tile(right, draw(run, 0)), 0);
  engine::Recording later = run;  // the same picture, one digit of the clock apart
  for (engine::Snapshot& s : later.snapshots) s.time += 0.008;
  EXPECT_GT(worst_tile(right, draw(later, 0.008)), kWorstTile);
  engine::Recording turned = run;  // one arm by three degrees: half a pixel at its end in so small a picture
  for (std::size_t b = 0; b < run.body_names.size(); ++b)
    if (run.body_names[b].find("left_forearm") != std::string::npos) {
      engine::Pose& X = turned.snapshots[0].bodies[b].X_WB;
      const engine::Vec3 elbow = X * engine::Vec3(0, 0, 0.2);
      const engine::Quat turn(Eigen::AngleAxisd(3 * 0.0174533, engine::Vec3::UnitY()));
      X.p = elbow + turn * (X.p - elbow);
      X.q = turn * X.q;
    }
  EXPECT_GT(worst_tile(right, draw(turned, 0)), kWorstTile);
}

}  // namespace
