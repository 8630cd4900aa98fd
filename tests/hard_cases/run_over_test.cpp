// A wheel over the limbs of somebody who lies there. Over a step its spring is stiffer than a foot is heavy. While it displaced the
// foot by all of its impulse and the road by half, the foot sank: 147 mm at 2 ms, 38 mm at 1 ms, 6 mm at 0.5 ms.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/hard_cases/hard_case.h"

namespace hard_cases {
namespace {

using engine::Vec3;

/// Deepest [m] of any part of the person in the road.
double deepest_in_road(const Outcome& it) {
  double deepest = 0;
  for (const engine::Snapshot& s : it.recording.snapshots)
    for (const engine::ContactRecord& c : s.contacts)
      if (c.body_b < 0 && it.model.bodies[static_cast<std::size_t>(c.body_a)].person == 0) deepest = std::max(deepest, c.depth);
  return deepest;
}

constexpr double kOverLeg = 1.43, kOverTrunk = -1.2;  // [m] where the car drives, aside of the hips: trunk, and the arm beside it

class RunOverLying : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(At, RunOverLying, testing::Values(kOverLeg, kOverTrunk));

TEST_P(RunOverLying, IsPressedInAsFarAsTheLawSaysAtAnyStep) {
  std::vector<Vec3> places;
  for (const char* step : {"2 ms", "1 ms", "0.5 ms"}) {
    const Outcome it = run("run_over", {step, "stepping"}, {"vehicle.car.front=\"-1.0 " + std::to_string(GetParam()) + " m\""},
                           [](engine::Model& model) { model.settings.record_interval = model.settings.step; });
    const auto& d = it.diagnostics();
    const double deepest = deepest_in_road(it);
    row("run over lying", it, "%.1f mm in the road, %.2f J of %.0f J unexplained, residual %.1e m/s", 1e3 * deepest,
        d.max_unexplained, d.energy_turned_over, d.max_solver_residual);
    // by the law what rests is in by no more than 2 F/S: of a front wheel's 4 kN and, where it comes down on the trunk, twice that,
    // on 400 kN/m
    EXPECT_LT(deepest, GetParam() == kOverLeg ? 0.020 : 0.040);
    // the friction of a rim that pulls and of a limb beneath it is of a step's order: 1.5 J at 2 ms, 0.3 J at 0.5 ms
    EXPECT_LT(d.max_unexplained, 2e-4 * d.energy_turned_over);
    EXPECT_LT(d.max_solver_residual, 1e-4);
    for (const std::string& warning : d.warnings) ADD_FAILURE() << warning;
    double touched = 2;  // [s] the end
    for (const engine::Event& e : it.recording.events) {
      if (e.kind == "first_contact") touched = e.time;
      // it lies there, though nobody solves its contacts until the car comes: 50 ms off the road are the least to land again
      if (e.kind == "ground_contact") {
        EXPECT_GT(e.time, touched + 0.05);
      }
    }
    EXPECT_LT(touched, 2.0);
    places.push_back(it.last(1).X_WB.p);
  }
  // limbs that slide aside make a decimetre of it
  for (const Vec3& place : places) EXPECT_LT((place - places.back()).head<2>().norm(), 0.1);
}

/// Between rigid surfaces, by each vehicle's wheel first. Rubber that gives before it presses never touched who waited: they lay
/// there as a stone would, and the wheels drove over.
TEST(RunOverRigid, SetsWhoLiesThereFree) {
  for (const char* model : {"small_car", "van", "truck"}) {
    const Outcome it = run("run_over", {"1 ms", "stepping"},
                           {"simulation.contact_law=\"default_auto\"", "vehicle.car.model=\"" + std::string(model) + "\"",
                            "vehicle.car.front=\"-1.0 " + std::to_string(kOverTrunk) + " m\""});
    const auto& events = it.recording.events;
    EXPECT_TRUE(std::any_of(events.begin(), events.end(), [](const engine::Event& e) { return e.kind == "release"; })) << model;
    double way = 0;
    for (std::size_t b = 0; b < it.model.bodies.size(); ++b)
      if (it.model.bodies[b].person == 0)
        way = std::max(way, (it.last(static_cast<int>(b)).X_WB.p - it.recording.snapshots.front().bodies[b].X_WB.p).norm());
    EXPECT_GT(way, 0.05) << model;
  }
}

/// A child under an SUV that brakes: between its floor, the trunk and the road limbs of 0.5 kg are squeezed. While their contacts
/// displaced by unequal shares, an arm lay 53 mm deep in the road at 2 ms, under 55 N.
class RunOverChild : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Steps, RunOverChild, testing::Values("2 ms", "1 ms", "0.5 ms"));

TEST_P(RunOverChild, LiesNoDeeperInTheRoadThanItsForcesPressedIt) {
  const Outcome it = run("scenes/cases/suv_child_fit", {GetParam(), "stepping"}, {"simulation.duration=\"2.5 s\""},
                         [](engine::Model& model) { model.settings.record_interval = model.settings.step; });
  std::vector<double> hardest(it.model.bodies.size(), 0);  // [N] so far
  double deepest = 0, most = 0;                            // [m], [m] beyond what a force pressed in
  for (const engine::Snapshot& s : it.recording.snapshots)
    for (const engine::ContactRecord& c : s.contacts) {
      const auto b = static_cast<std::size_t>(c.body_a);
      if (c.body_b >= 0 || it.model.bodies[b].person < 0) continue;
      hardest[b] = std::max(hardest[b], c.normal_force);
      deepest = std::max(deepest, c.depth);
      // closing, F = S depth; at rest no less than half of it
      most = std::max(most, c.depth - 2 * hardest[b] / it.model.bodies[b].surface.stiffness.at(s.time));
    }
  row("run over child", it, "%.1f mm in the road, %.2f mm more than 2 F/S", 1e3 * deepest, 1e3 * most);
  EXPECT_GT(deepest, 5e-3) << "it was run over";
  // a force is the mean of a step, in which a limb goes on by a metre a second
  EXPECT_LT(most, 1.0 * it.model.settings.step);
}

}  // namespace
}  // namespace hard_cases
