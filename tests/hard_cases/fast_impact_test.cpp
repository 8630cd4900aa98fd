// A head at 40 m/s against a sheet of 2 mm and against the ground, with steps in which it travels up to 40 cm.
#include <gtest/gtest.h>

#include <random>

#include "tests/hard_cases/hard_case.h"
#include "tests/hard_cases/meshes.h"

namespace hard_cases {
namespace {

using engine::Vec3;

class FastImpact : public testing::TestWithParam<std::tuple<double, bool>> {};
INSTANTIATE_TEST_SUITE_P(At, FastImpact, testing::Combine(testing::Values(10e-3, 2e-3, 1e-3, 0.5e-3), testing::Bool()));

TEST_P(FastImpact, IsNeverOnTheWrongSide) {
  const auto [step, sheet] = GetParam();
  constexpr int kTrials = 1000;
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  int wrong = 0;
  double deepest = 0;
  engine::Model model;
  model.settings.step = step;
  model.settings.record_interval = step;
  model.settings.duration = 0.08;
  model.settings.stop_at_rest = false;
  model.ground.plane = !sheet;
  model.bodies.resize(1);
  engine::Body& head = model.bodies[0];
  head.name = "head";
  head.mass = 4.5;
  const engine::HyperEllipsoid shape{{0.1, 0.08, 0.12}, 2.5};
  head.shape = shape;
  head.inertia_B = principal_inertia(shape, head.mass).asDiagonal();
  if (sheet) {
    engine::Body plate;  // its upper side at z = 0
    plate.name = "sheet";
    plate.fixed = true;
    plate.shape = engine::MeshShape{box_mesh({4, 4, 1e-3}), {}};
    plate.X_WB.p = {0, 0, -1e-3};
    model.bodies.push_back(plate);
  }
  for (int trial = 0; trial < kTrials; ++trial) {
    engine::Body& flung = model.bodies[0];
    flung.X_WB.q = engine::Quat(unit(random), unit(random), unit(random), unit(random)).normalized();
    flung.X_WB.p = {0.5 * unit(random), 0.5 * unit(random), 0.6 + 0.4 * unit(random)};
    const Vec3 down = Vec3(0.7 * unit(random), 0.7 * unit(random), -1).normalized();
    flung.V_WB.v = 40 * down;
    flung.V_WB.w = 30 * Vec3(unit(random), unit(random), unit(random));
    flung.surface.restitution_body = flung.surface.restitution_ground = 0.5 + 0.5 * unit(random);
    const engine::Recording it = engine::simulate(model);
    ASSERT_FALSE(it.failure);
    bool through = false;
    for (const engine::Snapshot& s : it.snapshots) through = through || s.bodies[0].X_WB.p.z() < 0;
    wrong += through;
    deepest = std::max(deepest, it.diagnostics.max_penetration);
  }
  char setting[32];
  std::snprintf(setting, sizeof setting, "%g ms stepping", step * 1e3);
  row("head at 40 m/s", setting, "against %s: %d of %d on the wrong side, penetration at most %.2f mm",
      sheet ? "a 2 mm sheet" : "the ground", wrong, kTrials, deepest * 1e3);
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace hard_cases
