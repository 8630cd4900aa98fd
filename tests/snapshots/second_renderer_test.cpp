// Our rasteriser against OpenGL by OSMesa: the same things from the same cameras must cover the same pixels. Shapes and cameras are
// common to both; what is held against each other is how triangles become pixels and which of them are seen.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "engine/simulate.h"
#include "render/arrange.h"
#include "render/renderer.h"
#include "scenes/scene.h"
#include "tests/benchmark/plain_renderer.h"

namespace {

using namespace render;

constexpr int kWidth = 640, kHeight = 360;

/// All things in one matt red, and nothing but things.
DrawList silhouettes(const scenes::Scene& scene, const engine::Recording& run, const Moment& moment) {
  DrawList list = arrange(scene.stage, run, moment, static_cast<double>(kWidth) / kHeight, Layer::scene);
  list.lines.clear(), list.arrows.clear(), list.markers.clear(), list.labels.clear(), list.charts.clear(), list.strips.clear();
  Material red;
  red.colour = {0.9f, 0.01f, 0.01f};
  red.roughness = 1;
  for (EllipsoidItem& item : list.ellipsoids) item.material = red;
  for (MeshItem& item : list.meshes) std::fill(item.materials.begin(), item.materials.end(), red);
  for (SkinItem& item : list.skins) item.materials.assign(item.topology->materials.size(), red);
  return list;
}

/// Per pixel: whether it is red, which neither road, verge nor sky is.
std::vector<char> red_of(const Image& image) {
  std::vector<char> out;
  for (std::size_t at = 0; at < image.rgba.size(); at += 4)
    out.push_back(image.rgba[at] > image.rgba[at + 1] + 30 && image.rgba[at] > image.rgba[at + 2] + 30);
  return out;
}

/// Pixels that one has and the other has not within a pixel.
long strays(const std::vector<char>& one, const std::vector<char>& other) {
  long count = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      if (!one[static_cast<std::size_t>(y * kWidth + x)]) continue;
      bool near = false;
      for (int v = std::max(0, y - 1); v <= std::min(kHeight - 1, y + 1); ++v)
        for (int u = std::max(0, x - 1); u <= std::min(kWidth - 1, x + 1); ++u)
          near = near || other[static_cast<std::size_t>(v * kWidth + u)];
      count += !near;
    }
  return count;
}

TEST(SecondRenderer, CoversTheSamePixels) {
  const scenes::Scene scene = scenes::load(CRASHREEL_SOURCE_DIR "/scenes/cases/sedan_pedestrian_40kmh.toml", {});
  const engine::Recording run = engine::simulate(scene.model);
  benchmark::PlainRenderer opengl(kWidth, kHeight);
  Renderer ours(kWidth, kHeight, Quality::standard);
  for (const char* camera : {"follow", "witness", "top"})
    for (const double time : {0.0, 0.3, 0.9}) {
      SCOPED_TRACE(std::string(camera) + " " + std::to_string(time));
      const DrawList list = silhouettes(scene, run, {time, camera});
      Image a, b;
      ours.draw(list, a);
      opengl.draw(list, b);
      const std::vector<char> here = red_of(a), there = red_of(b);
      const long area = std::count(there.begin(), there.end(), 1);
      ASSERT_GT(area, 500);
      // Samples lie elsewhere in a pixel: an edge may take the next one, and what is thinner than a pixel may be missed by either
      // (14 pixels of 24,500 were). Edges are some 1000 of the 10,000 to 25,000 pixels: of each tenth of them may differ.
      EXPECT_LE(strays(here, there) + strays(there, here), area / 1000);
      EXPECT_NEAR(static_cast<double>(std::count(here.begin(), here.end(), 1)), static_cast<double>(area),
                  0.01 * static_cast<double>(area));
    }
}

}  // namespace
