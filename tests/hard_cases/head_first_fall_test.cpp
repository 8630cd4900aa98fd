// A person who falls on the crown of the head. The neck goes on pressing while the head's contact turns: where that had hardly a
// force for the step in which the head came up, the neck threw it down again, and HIC15 was of that knock: 226 to 525 by the step.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "engine/measure/metrics.h"
#include "engine/simulate.h"
#include "tests/scenes/scene_file.h"

namespace hard_cases {
namespace {

struct Blow {
  double hic15 = 0, peak = 0;  // [-], [m/s^2] of the head
};

Blow fall(double height, const std::string& step) {
  const scenes::testing::SceneFolder folder;
  folder.write("poses/headdown.toml", "pitch = \"180 deg\"\n");
  const scenes::Scene scene = folder.load("[simulation]\nduration = \"" + std::to_string(0.35 + 0.45 * height) + " s\"\nstep = \"" +
                                          step + "\"\nrecord_interval = \"" + step + "\"\n[[person]]\nname = \"p\"\nheight = \"" +
                                          std::to_string(height) + " m\"\nzero_condition = false\npose = \"headdown\"\n");
  const engine::Recording run = engine::simulate(scene.model);
  Blow out;
  for (const engine::Metric& m : engine::measure(scene.model, run)) {
    if (m.key == "hic15_ground") out.hic15 = m.value;
    if (m.key == "peak_acceleration_mps2" && m.object == "p/head") out.peak = m.value;
  }
  return out;
}

/// Of a step's means the shorter ones reach nearer to a peak: 934 to 966 m/s^2 from 1 m.
TEST(HeadFirstFall, HasTheSameCriterionAtEveryStep) {
  for (const double height : {0.3, 1.0, 2.0}) {
    const Blow coarse = fall(height, "1 ms");
    EXPECT_GT(coarse.hic15, 20) << height;
    for (const char* step : {"0.5 ms", "0.25 ms", "0.125 ms"}) {
      const Blow fine = fall(height, step);
      EXPECT_NEAR(fine.hic15, coarse.hic15, 0.02 * coarse.hic15) << height << " m at " << step;
      EXPECT_NEAR(fine.peak, coarse.peak, 0.05 * coarse.peak) << height << " m at " << step;
    }
  }
}

TEST(HeadFirstFall, HurtsMoreFromHigher) {
  EXPECT_LT(2 * fall(0.3, "1 ms").hic15, fall(1, "1 ms").hic15);
  EXPECT_LT(2 * fall(1, "1 ms").hic15, fall(2, "1 ms").hic15);
}

}  // namespace
}  // namespace hard_cases
