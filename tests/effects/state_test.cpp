// The state is all of the state: a run that is stopped, copied, saved, loaded and gone on with, in a new World, is the run that was
// never stopped, to the last bit of everything that a later step could depend on.
#include "engine/state.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "engine/plan.h"
#include "engine/simulate.h"
#include "engine/start.h"
#include "scenes/scene.h"
#include "tests/effects/scenes.h"

namespace effects_tests {

using namespace engine;

namespace {

/// [s] of a scene: the persons are struck within 0.1 s and on their way down at its middle.
constexpr double kStateWindow = 0.6;

Model load(const std::string& scene, std::vector<std::string> overrides = {}) {
  return scenes::load(std::filesystem::path(CRASHREEL_SOURCE_DIR) / scene, overrides).model;
}

State first_state(const Model& model, const Plan& plan) {
  World world(model, plan, {});
  return start(world);
}

/// Runs to the end of the model's duration, from a state where there is one.
Recording run(const Model& model, const Plan& plan, const State* from, State& end) {
  RunOptions options;
  options.from = from;
  options.end = &end;
  return simulate(model, plan, options);
}

void expect_the_same_motion(const Recording& whole, const Recording& second) {
  const std::size_t before = whole.snapshots.size() - second.snapshots.size();
  for (std::size_t k = 0; k < second.snapshots.size(); ++k) {
    const Snapshot &a = whole.snapshots[before + k], &b = second.snapshots[k];
    ASSERT_EQ(a.time, b.time);
    for (std::size_t i = 0; i < a.bodies.size(); ++i) {
      ASSERT_EQ(a.bodies[i].X_WB.p, b.bodies[i].X_WB.p) << "body " << i << " at " << a.time;
      ASSERT_EQ(a.bodies[i].X_WB.q.coeffs(), b.bodies[i].X_WB.q.coeffs()) << "body " << i << " at " << a.time;
      ASSERT_EQ(a.bodies[i].V_WB.v, b.bodies[i].V_WB.v) << "body " << i << " at " << a.time;
      ASSERT_EQ(a.bodies[i].V_WB.w, b.bodies[i].V_WB.w) << "body " << i << " at " << a.time;
    }
    EXPECT_EQ(a.energies.dissipated, b.energies.dissipated) << "at " << a.time;
    EXPECT_EQ(a.energies.residual, b.energies.residual) << "at " << a.time;
    if (k > 0) {
      EXPECT_EQ(a.contacts.size(), b.contacts.size()) << "at " << a.time;
    }
  }
}

void expect_the_same_when_stopped_halfway(Model model) {
  const Plan plan = compile(model);
  const double half = model.settings.record_interval * std::floor(0.5 * model.settings.duration / model.settings.record_interval);
  State at_end, at_half, saved_at_end, copied_at_end;
  const Recording whole = run(model, plan, nullptr, at_end);

  Model first = model;
  first.settings.duration = half;
  run(first, plan, nullptr, at_half);
  ASSERT_NEAR(at_half.time, half, 1e-9);
  const State copy = at_half;
  const std::optional<State> loaded = from_bytes(to_bytes(at_half), first_state(model, plan));
  ASSERT_TRUE(loaded.has_value());
  EXPECT_TRUE(*loaded == at_half);

  const Recording second = run(model, plan, &*loaded, saved_at_end);
  run(model, plan, &copy, copied_at_end);
  EXPECT_TRUE(saved_at_end == at_end) << "saved and loaded";
  EXPECT_TRUE(copied_at_end == at_end) << "copied";
  EXPECT_EQ(hash(saved_at_end), hash(at_end));
  EXPECT_TRUE(copy == at_half) << "a run changes no state but its own";
  ASSERT_GT(second.snapshots.size(), 1U);
  expect_the_same_motion(whole, second);
}

}  // namespace

class StateOfScene : public testing::TestWithParam<std::string> {};

TEST_P(StateOfScene, StoppedCopiedAndGoneOnWithIsTheSameToTheLastBit) {
  Model model = load(GetParam());
  model.settings.duration = std::min(kStateWindow, model.settings.duration);
  expect_the_same_when_stopped_halfway(std::move(model));
}

INSTANTIATE_TEST_SUITE_P(Scenes, StateOfScene, testing::ValuesIn(shipped_scenes()),
                         [](const auto& scene) { return test_name(scene.param); });

struct Otherwise {
  const char* name;
  const char* scene;
  std::vector<std::string> overrides;
  double window;
};

class StateOtherwise : public testing::TestWithParam<Otherwise> {};

TEST_P(StateOtherwise, StoppedCopiedAndGoneOnWithIsTheSameToTheLastBit) {
  Model model = load(GetParam().scene, GetParam().overrides);
  model.settings.duration = GetParam().window;
  expect_the_same_when_stopped_halfway(std::move(model));
}

// phases of compliant contacts, the length that the last step suggests, the look that sleep takes each second
INSTANTIATE_TEST_SUITE_P(
    Schemes, StateOtherwise,
    testing::Values(
        Otherwise{"CompliantPerson", "scenes/cases/sedan_pedestrian_40kmh.toml", {"simulation.contact_law=compliant"}, 0.24},
        Otherwise{"RungeKutta", "scenes/gallery/ball_compliant.toml", {"simulation.scheme=rk4"}, 0.9},
        Otherwise{"Adaptive", "scenes/gallery/ball_compliant.toml", {"simulation.scheme=adaptive"}, 0.9},
        Otherwise{"Asleep", "scenes/gallery/incline_stick.toml", {"simulation.sleep=true"}, 2.6}),
    [](const auto& p) { return p.param.name; });

TEST(State, OfWhichAByteIsMissingOrDamagedOrThatIsOfAnotherSceneIsRefused) {
  const Model model = load("scenes/gallery/cradle.toml"), other = load("scenes/gallery/pendulum.toml");
  const Plan plan = compile(model), other_plan = compile(other);
  const State state = first_state(model, plan);
  const Bytes bytes = to_bytes(state);
  ASSERT_TRUE(from_bytes(bytes, state).has_value());
  EXPECT_FALSE(from_bytes(bytes, first_state(other, other_plan)).has_value());
  EXPECT_FALSE(from_bytes({}, state).has_value());
  EXPECT_FALSE(from_bytes(Bytes(bytes.begin(), bytes.end() - 1), state).has_value());
  for (std::size_t i = 0; i < bytes.size(); i += 7) {
    Bytes damaged = bytes;
    damaged[i] ^= 0x10;
    EXPECT_FALSE(from_bytes(damaged, state).has_value()) << "byte " << i;
  }
}

TEST(State, SeesEveryPartThatChanges) {
  Model model = load("scenes/cases/sedan_pedestrian_40kmh.toml");
  model.settings.duration = 0.2;
  const Plan plan = compile(model);
  State state;
  run(model, plan, nullptr, state);
  std::set<std::uint64_t> seen{hash(state)};
  const auto expect_new = [&](const char* what, auto&& change) {
    State other = state;
    change(other);
    EXPECT_FALSE(other == state) << what;
    EXPECT_TRUE(seen.insert(hash(other)).second) << what;
  };
  expect_new("place", [](State& s) { s.X_WB[1].p.x() = std::nextafter(s.X_WB[1].p.x(), 1e9); });
  expect_new("contact found", [](State& s) { s.contacts.list.at(0).gap += 1e-12; });
  expect_new("clearance", [](State& s) { s.contact_memory.mesh.at(0).clearance.least += 1e-3; });
  expect_new("entered sides", [](State& s) { s.contact_memory.mesh.at(0).entered ^= 1; });
  expect_new("warm start", [](State& s) { s.warm.at(0).impulse_W.x() += 1; });
  expect_new("wheel", [](State& s) { s.wheels.at(0).compression += 1e-9; });
  expect_new("pace", [](State& s) { s.pace.next = 1e-4; });
  expect_new("swing", [](State& s) { s.pace.swing.rate += 1; });
  expect_new("ledger", [](State& s) { s.energy.dissipated.at(0) += 1; });
  expect_new("released", [](State& s) { s.released.at(0) ^= 1; });
}

}  // namespace effects_tests
