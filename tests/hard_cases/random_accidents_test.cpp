// Accidents nobody thought of: a vehicle and a person or two, some against a second vehicle, on a bicycle, lying or sitting on the
// road, at 5 to 100 km/h and one of three steps. Whatever happens, the run's own figures must say that it is right.
// CRASHREEL_ACCIDENTS=400 tries as many; the number printed with what fails repeats one alone (CRASHREEL_ACCIDENT=17).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "tests/hard_cases/accident.h"
#include "tests/hard_cases/hard_case.h"
#include "tests/scenes/scene_file.h"

namespace hard_cases {
namespace {

constexpr int kGroups = 8;
constexpr int kInGroup = 2;

/// How far [m] anything stands in anything at a snapshot: of one vehicle in another, whose sheets would crumple there, or of the
/// rest.
double deepest(const engine::Recording& recording, bool of_vehicles) {
  double depth = 0;
  for (const engine::Snapshot& s : recording.snapshots)
    for (const engine::ContactRecord& c : s.contacts)
      if (c.shapes.between_vehicles() == of_vehicles) depth = std::max(depth, c.depth);
  return depth;
}

/// How deep a run may leave anything. Where nothing yields: as asked of a struck person. Where persons do: an adult's trunk is 23
/// to 25 cm from front to back, and what is pressed in further has gone through it. Each part that goes beyond its own thickness is
/// told, and a neck that carries what none does: both are what such a blow is.
struct Law {
  const char* name;
  double depth;  // [m]
  std::vector<std::string> may_warn;
};
// Cars that touch by their mirrors and part have no impulse of Kudlich and Slibar's: that is told, and right.
const Law kLaws[] = {
    {"default_auto", 2e-3, {"parted before kudlich_slibar"}},
    {"persons_yield", 0.25, {"parted before kudlich_slibar", "more than its thickness", "from the other side", "the neck of"}}};

/// The most of all accidents seen.
struct Seen {
  double unexplained = 0, depth = 0, crush = 0, gap = 0, residual = 0, angle = 0;
};

void expect_right(unsigned seed, const Law& law, Seen& seen) {
  const scenes::testing::SceneFolder folder;
  const scenes::Scene scene = folder.load(accident(seed, law.name));
  const engine::Recording it = engine::simulate(scene.model);
  ASSERT_FALSE(it.failure) << seed << ": " << it.failure->message << "\n" << accident(seed, law.name);
  const auto& d = it.diagnostics;
  const double share = std::abs(it.snapshots.back().energies.residual) / (1e4 + energy(it.snapshots.front()));
  const std::string which = fmt::format("accident {}:\n{}", seed, accident(seed, law.name));
  for (const std::string& warning : d.warnings)
    EXPECT_TRUE(std::any_of(law.may_warn.begin(), law.may_warn.end(),
                            [&warning](const std::string& may) { return warning.find(may) != std::string::npos; }))
        << which << warning;
  EXPECT_LT(share, 1e-3) << which;  // as of the crushed child; at a walk 10 J of what the limbs themselves carry
  EXPECT_LT(deepest(it, false), law.depth) << which;
  EXPECT_LT(d.max_joint_gap, 1e-9) << which;                  // a thousand times what rounding leaves
  EXPECT_LT(degrees(d.max_joint_angle_error), 0.5) << which;  // as asked of a struck person
  EXPECT_LT(d.max_solver_residual, 2e-5) << which;            // twice the tolerance, above which a step is taken again
  seen.unexplained = std::max(seen.unexplained, share);
  seen.depth = std::max(seen.depth, deepest(it, false));
  seen.crush = std::max(seen.crush, deepest(it, true));
  seen.gap = std::max(seen.gap, d.max_joint_gap);
  seen.angle = std::max(seen.angle, degrees(d.max_joint_angle_error));
  seen.residual = std::max(seen.residual, d.max_solver_residual);
}

class RandomAccidents : public testing::TestWithParam<std::tuple<int, Law>> {};
INSTANTIATE_TEST_SUITE_P(Group, RandomAccidents, testing::Combine(testing::Range(0, kGroups), testing::ValuesIn(kLaws)),
                         [](const auto& p) { return fmt::format("{}_{}", std::get<1>(p.param).name, std::get<0>(p.param)); });

TEST_P(RandomAccidents, SayThatTheyAreRight) {
  const auto [group, law] = GetParam();
  const char* many = std::getenv("CRASHREEL_ACCIDENTS");
  const char* alone = std::getenv("CRASHREEL_ACCIDENT");
  const int in_group = many ? (std::atoi(many) + kGroups - 1) / kGroups : kInGroup;
  Seen seen;
  for (int k = 0; k < in_group; ++k) {
    const auto seed = static_cast<unsigned>(k * kGroups + group);
    if (!alone || static_cast<int>(seed) == std::atoi(alone)) expect_right(seed, law, seen);
  }
  row("random accidents", fmt::format("{} of group {}, {}", in_group, group, law.name),
      "%.4f %% of the energy unexplained, penetration %.2f mm (of vehicles %.0f), drift %.1e m, limits %.2f deg, residual %.1e m/s",
      100 * seen.unexplained, 1e3 * seen.depth, 1e3 * seen.crush, seen.gap, seen.angle, seen.residual);
}

// Found among 10,000, each of a kind of its own: sweeps that did not push a wedged foot out, a car lifted by pushes that no book
// had, a pinched leg displaced by so much that 1.7 kJ were lost, a tyre that found itself on a limb with 18 kJ in its spring; steps
// of which the last halving was unsolved, or ran through a stop, where a longer one had mislaid some 10 J; pushes that ran a foot
// through its stop, and a bicycle into the road, which had been let go as open; trunks that wheels pressed up to 10 mm into the
// person's own forearm, by contacts at a dead centre that yielded, and a limb that turned 2 or 4 degrees beyond its stop; trunks
// inside vehicles by edges of meshes that were not found; more than 0.1 % of the energy mislaid where a forearm was pressed from
// both sides.
TEST(RandomAccident, HoldsWhereItOnceDidNot) {
  Seen seen;
  for (const unsigned seed :
       {955u, 1166u, 1779u, 2355u, 2479u, 2506u, 3977u, 4120u, 4157u, 5072u, 5088u, 5669u, 5976u, 6053u, 9098u, 9233u, 9567u})
    expect_right(seed, kLaws[0], seen);
  expect_right(179, kLaws[1], seen);
}

// That goes beyond the bounds above: a trunk in a vehicle.
TEST(RandomAccident, SaysWhereItFallsShort) {
  const struct {
    unsigned seed;
    const Law& law;
    const char* warning;
  } all[] = {{7547, kLaws[0], "one/torso stood 2.8 mm inside other"}};
  for (const auto& [seed, law, warning] : all) {
    const scenes::testing::SceneFolder folder;
    const engine::Recording it = engine::simulate(folder.load(accident(seed, law.name)).model);
    EXPECT_THAT(it.diagnostics.warnings, testing::Contains(testing::HasSubstr(warning)))
        << seed << ": if it holds by now, take it out";
  }
}

}  // namespace
}  // namespace hard_cases
