// What the plan leaves out changes nothing: a run with every effect forced on is the run with the plan, bit for bit. And what is
// not in the plan is neither called nor recorded.
#include <gtest/gtest.h>

#include <map>

#include "engine/plan.h"
#include "engine/simulate.h"
#include "scenes/scene.h"
#include "tests/effects/scenes.h"

namespace effects_tests {

using namespace engine;

namespace {

/// [s] of a scene that are compared: long enough for the first touch of every case and what comes of it (the persons are struck
/// within 0.1 s and land within 1 s). The whole runs agree as well, and take ten times as long.
constexpr double kWindow = 1.2;

Model with_everything_forced_on(Model model) {
  for (const PlanLine& line : compile(model).lines) model.settings.effects[line.effect] = Force::on;
  return model;
}

/// Effects that make contacts of a name.
const std::map<std::string, std::vector<std::string>> kMakers = {{"ground", {"ground_contact", "bodywork_contact"}},
                                                                 {"terrain", {"terrain_contact", "bodywork_contact"}},
                                                                 {"vehicle", {"mesh_contact"}},
                                                                 {"self", {"self_contact"}},
                                                                 {"person", {"body_contact"}},
                                                                 {"vehicle_pair", {"bodywork_contact", "kudlich_slibar"}}};

void expect_nothing_outside_the_plan(const Recording& run) {
  std::map<std::string, long> calls;
  for (const EffectCost& cost : run.costs) calls[cost.effect] = cost.calls;
  std::map<std::string, bool> active;
  for (const PlanLine& line : run.plan) {
    active[line.effect] = line.active;
    if (!line.active) {
      EXPECT_EQ(calls[line.effect], 0) << line.effect;
    }
  }
  for (const Snapshot& snapshot : run.snapshots) {
    EXPECT_TRUE(snapshot.wheels.empty() || active["tyres"]);
    for (const ContactRecord& contact : snapshot.contacts) {
      const std::vector<std::string>& makers = kMakers.at(name_of(contact.shapes));
      EXPECT_TRUE(std::any_of(makers.begin(), makers.end(), [&](const std::string& maker) { return active[maker]; }))
          << name_of(contact.shapes);
    }
  }
}

}  // namespace

/// Bodies on a joint never meet each other, and the plan says which they are: in the gallery a sleeve on its rod, three sliders on
/// fixed rails, a pendulum's two parts.
TEST(BodyContact, TellsThePairsThatAJointHolds) {
  const auto line_of = [](const char* scene) {
    const Model model = scenes::load(std::filesystem::path(CRASHREEL_SOURCE_DIR) / "scenes/gallery" / scene).model;
    for (const PlanLine& line : compile(model).lines)
      if (line.effect == "body_contact") return line;
    return PlanLine{};
  };
  EXPECT_EQ(line_of("cylindrical.toml").reason, "no two that no joint holds: 1 free body and 1 fixed one");
  EXPECT_EQ(line_of("cylindrical.toml").left_out, "1 pair that a joint holds");
  EXPECT_EQ(line_of("babyboot.toml").reason, "no two that no joint holds: 2 free bodies");
  const PlanLine rails = line_of("prismatic.toml");
  EXPECT_EQ(rails.reason, "9 pairs of segments or free bodies that are not one person's: 3 free bodies and 3 fixed ones");
  EXPECT_EQ(rails.left_out, "only pairs farther apart than a step can bring them together, and 3 pairs that a joint holds");
  EXPECT_EQ(line_of("ball_compliant.toml").reason, "no second one to meet: 1 free body");
}

class ShippedScene : public testing::TestWithParam<std::string> {};

TEST_P(ShippedScene, RunsBitForBitTheSameWithEveryEffectForcedOnAndCallsNoneOutsideThePlan) {
  Model model = scenes::load(std::filesystem::path(CRASHREEL_SOURCE_DIR) / GetParam()).model;
  model.settings.duration = std::min(kWindow, model.settings.duration);
  const Model everything = with_everything_forced_on(model);
  for (const PlanLine& line : compile(everything).lines) EXPECT_TRUE(line.active) << line.effect;
  const Recording planned = simulate(model), forced = simulate(everything);
  EXPECT_EQ(hash(planned), hash(forced));
  EXPECT_EQ(planned.events.size(), forced.events.size());
  EXPECT_EQ(planned.diagnostics.contact_sweeps, forced.diagnostics.contact_sweeps);
  expect_nothing_outside_the_plan(planned);
}

INSTANTIATE_TEST_SUITE_P(Scenes, ShippedScene, testing::ValuesIn(shipped_scenes()),
                         [](const auto& scene) { return test_name(scene.param); });

namespace {

Model struck() {
  Model model = scenes::load(std::filesystem::path(CRASHREEL_SOURCE_DIR) / "scenes/cases/sedan_pedestrian_40kmh.toml").model;
  model.settings.duration = 0.5;
  return model;
}

}  // namespace

TEST(ForcedOff, JointsLetTheBodiesComeApart) {
  Model model = struck();
  model.settings.effects["joints"] = Force::off;
  model.persons[0].zero_condition = false;
  model.settings.duration = 0.15;
  const Recording run = simulate(model);
  double apart = 0;  // [m] how far the two halves of a joint have parted
  for (const Joint& joint : model.joints) {
    const auto& bodies = run.snapshots.back().bodies;
    apart = std::max(apart, (bodies[joint.parent].X_WB * joint.X_PF.p - bodies[joint.child].X_WB * joint.X_CF.p).norm());
  }
  EXPECT_GT(apart, 0.05);
}

TEST(ForcedOff, TheZeroConditionLeavesNobodyHanging) {
  Model model = struck();
  model.settings.effects["zero_condition"] = Force::off;
  model.bodies[model.vehicles[0].body].X_WB.p.x() -= 50;  // nothing touches, gravity alone
  const Recording run = simulate(model);
  const int head = model.persons[0].head;
  EXPECT_LT(run.snapshots.back().bodies[head].X_WB.p.z(), run.snapshots.front().bodies[head].X_WB.p.z() - 0.05);
}

TEST(ForcedOff, TheDriverLetsTheCarRoll) {
  Model model = struck();
  for (const char* off : {"driver", "air_drag"}) model.settings.effects[off] = Force::off;
  const int car = model.vehicles[0].body;
  model.bodies[car].X_WB.p.y() -= 10;  // past the person
  const double v0 = model.bodies[car].V_WB.v.norm();
  // tyres without slip angle, brake and drive give no force along the road; the suspension swings a little
  EXPECT_NEAR(simulate(model).snapshots.back().bodies[car].V_WB.v.norm(), v0, 1e-3 * v0);
}

}  // namespace effects_tests
