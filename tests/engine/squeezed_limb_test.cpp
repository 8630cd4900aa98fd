// A light limb between a heavy part and the road, against statics and the balance of energy.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/engine/experiment.h"

namespace engine::test {
namespace {

constexpr double kTrunkMass = 30, kHalfHeight = 0.08;        // [kg], [m]
constexpr double kBothParts = 400e3 / 2;                     // [N/m] limb and trunk in series
constexpr double kPartOnRoad = 400e3 * 1e9 / (400e3 + 1e9);  // [N/m]

/// Limb and trunk of two persons, one above the other from `drop` on.
Model trunk_over_limb(double limb_mass, double restitution, double drop, double step) {
  Model model = on_ground(2.5, step);
  model.settings.contact_law = ContactLaw::persons_yield;
  model.settings.record_interval = step;
  const HyperEllipsoid flat{{0.25, 0.3, kHalfHeight}, 2};  // lies well: its top is round by 0.8 m and more
  model.bodies = {solid(flat, limb_mass, {0, 0, kHalfHeight}), solid(flat, kTrunkMass, {0, 0, 3 * kHalfHeight + drop})};
  for (int b = 0; b < 2; ++b) {
    Body& body = model.bodies[static_cast<std::size_t>(b)];
    body.person = b;
    body.surface.restitution_body = body.surface.restitution_ground = restitution;
    Person person;
    person.bodies = {b};
    person.zero_condition = false;
    model.persons.push_back(person);
  }
  return model;
}

struct Squeeze {
  double by_trunk = 0, by_road = 0;  // [N] at the end of the run
  double in_trunk = 0, in_road = 0;  // [m]
  double deepest_in_road = 0;        // [m] in the run
};

Squeeze squeeze_of(const Recording& run) {
  Squeeze out;
  for (const Snapshot& s : run.snapshots)
    for (const ContactRecord& c : s.contacts)
      if (c.body_b < 0) out.deepest_in_road = std::max(out.deepest_in_road, c.depth);
  for (const ContactRecord& c : run.snapshots.back().contacts) {
    (c.body_b < 0 ? out.by_road : out.by_trunk) += c.normal_force;
    (c.body_b < 0 ? out.in_road : out.in_trunk) = c.depth;
  }
  return out;
}

/// So light that a step does not follow the spring of the road and follows the softer one of the trunk: h^2 S / m is 1.4 and 0.7.
double between_both(double step) {
  return step * step * kPartOnRoad / 1.4;
}

class SqueezedLimb : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Steps, SqueezedLimb, testing::Values(2e-3, 1e-3, 5e-4));

/// While one spring displaced the limb by its whole impulse and the other by half, it went F h / 2m each second without a velocity:
/// 0.24, 0.21 and 0.16 mm deep in the road at 2, 1 and 0.5 ms instead of 0.76.
TEST_P(SqueezedLimb, LiesAsDeepAsItsLoadOverTheSpring) {
  const double h = GetParam(), mass = between_both(h);
  const Squeeze it = squeeze_of(simulate(trunk_over_limb(mass, 1, 0, h)));
  const double load = kTrunkMass * kGravity;
  // with e = 1 it still swings a little after it was set down
  EXPECT_NEAR(it.by_trunk, load, 0.08 * load);
  EXPECT_NEAR(it.by_road, load + mass * kGravity, 0.08 * load);
  // impulses that displace by their whole lift by g h^2 a step, of which the fall takes half
  const double lifted = kGravity * h * h / 2;
  EXPECT_NEAR(it.in_road, it.by_road / kPartOnRoad, 1.05 * lifted);
  EXPECT_NEAR(it.in_trunk, it.by_trunk / kBothParts, 1.05 * lifted);
}

/// Dropped on it, the trunk went through the limb, which lay up to 13 mm deep. In a scene of an SUV over a child a forearm went 53
/// mm into the road.
TEST_P(SqueezedLimb, IsPressedInByABlowsEnergyAndComesOutAgain) {
  constexpr double kDrop = 0.2;  // [m]
  const double h = GetParam(), mass = between_both(h);
  const Recording run = simulate(trunk_over_limb(mass, 0, kDrop, h));
  const Squeeze it = squeeze_of(run);
  // both springs in series take m g (drop + x) = S x^2 / 2
  const double load = kTrunkMass * kGravity, S = kBothParts * kPartOnRoad / (kBothParts + kPartOnRoad);
  const double deepest = (load + std::sqrt(load * load + 2 * S * load * kDrop)) / kPartOnRoad;
  // springs at the end of the step lose the share w^2 h^2 / 2 of a swing in each, over a quarter of its period
  const double kept = std::exp(-std::numbers::pi / 4 * std::sqrt(S / kTrunkMass) * h);
  EXPECT_NEAR(it.deepest_in_road, kept * deepest, 0.015 * deepest) << "the limb's own mass, up to 4 % of the trunk's, left out";
  // at rest e = 0 stands between S and S/2 (laws/compliant_contact.h); it comes up by no more than g h or 1 mm/s
  const double on_road = load + mass * kGravity;
  EXPECT_NEAR(it.by_trunk, load, 1e-3 * load);
  EXPECT_NEAR(it.by_road, on_road, 1e-3 * load);
  EXPECT_GT(it.in_road, 0.98 * on_road / kPartOnRoad);
  EXPECT_LT(it.in_road, 2.5 * on_road / kPartOnRoad);
  EXPECT_LT(run.diagnostics.max_unexplained, 1e-6 * run.diagnostics.energy_turned_over);
}

}  // namespace
}  // namespace engine::test
