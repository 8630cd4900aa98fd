// What no step of any worthwhile length can follow: the run ends at once with a message that names it, and never takes for ever.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/hard_cases/hard_case.h"

namespace hard_cases {
namespace {

using testing::HasSubstr;

engine::Recording simulated(const char* scene, std::vector<std::string> overrides) {
  return engine::simulate(model_of(scene, std::move(overrides)));
}

void expect_stop(const engine::Recording& run, const char* body, const char* effect, const char* limit, const char* remedy) {
  ASSERT_TRUE(run.failure.has_value());
  EXPECT_EQ(run.failure->body, body);
  EXPECT_EQ(run.failure->effect, effect);
  EXPECT_THAT(run.failure->message, HasSubstr(limit));
  EXPECT_THAT(run.failure->message, HasSubstr(remedy));
  // what can be drawn: up to the step that was not taken
  EXPECT_LE(run.end_time(), run.failure->time);
  EXPECT_GE(run.end_time(), run.failure->time - run.interval);
  for (const engine::BodyState& b : run.at(run.failure->time).bodies)
    EXPECT_TRUE(b.X_WB.p.allFinite() && b.X_WB.q.coeffs().allFinite() && b.V_WB.v.allFinite() && b.V_WB.w.allFinite());
}

const char* const kChain = "scenes/gallery/spinning_chain";

TEST(TautChainBeyondMeasure, StopsWithItsLinkAndTheRemedy) {
  const std::string duration = "simulation.duration='0.01 s'", weight = "body.11.mass=";
  expect_stop(simulated(kChain, {duration, weight + "'1e-12 kg'"}), "link_11", "joints", "more than 1000 parts", "more mass");
  // 9.5 kN on a lever of 5 cm: 0.95 parts of 1 ms at 1 kg, so that 1000 are passed at 0.9 mg
  expect_stop(simulated(kChain, {duration, weight + "'8e-7 kg'"}), "link_11", "joints", "more than 1000 parts", "smaller step");
  // either remedy helps, and what is followed is followed well: turning at 10 rad/s changes no energy and no length
  for (const char* remedy : {"body.11.mass='1e-6 kg'", "simulation.step='0.5 ms'"}) {
    const engine::Recording run = simulated(kChain, {duration, weight + "'8e-7 kg'", remedy});
    EXPECT_FALSE(run.failure.has_value()) << remedy;
    EXPECT_NEAR(energy(run.snapshots.back()), energy(run.snapshots.front()), 1e-9 * energy(run.snapshots.front())) << remedy;
    const auto& bodies = run.snapshots.back().bodies;
    EXPECT_NEAR((bodies[bodies.size() - 1].X_WB.p - bodies[0].X_WB.p).norm(), 1.9, 1e-9) << remedy;
  }
}

TEST(ContactBeyondMeasure, StopsWithItsBodyAndTheRemedy) {
  const std::vector<std::string> ball = {"simulation.duration='0.6 s'", "body.0.mass='1e-9 kg'"};
  const engine::Recording run = simulated("scenes/gallery/ball_compliant", ball);
  expect_stop(run, "ball", "ground_contact", "more than 5000 parts", "lower stiffness");
  // it has fallen a metre; the step that touches is ended at the touch
  EXPECT_NEAR(run.failure->time, std::sqrt(2 / 9.81), 2e-3);
}

TEST(ToleranceBelowRounding, EndsAllTheSame) {
  // no step, however short, has an error below 1e-18 m: steps come to a thousandth and stay there
  const engine::Recording run =
      simulated("scenes/gallery/heavy_top",
                {"simulation.duration='0.02 s'", "simulation.scheme='adaptive'", "simulation.adaptive_tolerance='1e-18 m'"});
  EXPECT_FALSE(run.failure.has_value());
  EXPECT_EQ(run.steps, std::lround(0.02 / model_of("scenes/gallery/heavy_top", {}).settings.step));
}

}  // namespace
}  // namespace hard_cases
