// A head that slides from a pane onto the pillar beside it: the pillar takes over the force and adds to it as it is pressed in.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/engine/experiment.h"

namespace engine::test {
namespace {

/// A plate at z = 0, fixed: a windscreen up to x = 0, behind it an A-pillar.
Body pane_and_pillar() {
  const std::vector<Vec3> v{{-1, -1, 0}, {0, -1, 0}, {1, -1, 0}, {-1, 1, 0}, {0, 1, 0}, {1, 1, 0}};
  const std::vector<Triangle> t{{0, 1, 3}, {1, 4, 3}, {1, 2, 4}, {2, 5, 4}};
  MeshShape shape{std::make_shared<TriangleMesh>(v, t), Pose{}};
  shape.panels = std::make_shared<const Panels>(Panels{Panel::windscreen, Panel::windscreen, Panel::a_pillar, Panel::a_pillar});
  Body plate;
  plate.name = "plate";
  plate.fixed = true;
  plate.shape = shape;
  return plate;
}

/// [N] on a head 7 cm deep in the pane that moves at `along` and inwards [m/s], from the pane's last 2 cm on; per millisecond.
std::vector<double> forces(double along, double inward, double step) {
  Model model = free_space(0.012, step);
  model.settings.contact_law = ContactLaw::persons_yield;
  model.settings.record_interval = 1e-3;
  Body head = ball(0.12, 4.1, {-0.02, 0, 0.05});
  head.person = 0;
  head.V_WB.v = {along, 0, -inward};
  model.bodies = {head, pane_and_pillar()};
  model.persons = {of_one_part(0)};
  std::vector<double> out;
  for (const Snapshot& s : simulate(model).snapshots) {
    double sum = 0;
    for (const ContactRecord& c : s.contacts) sum += c.normal_impulse;
    if (s.time > 0) out.push_back(sum / model.settings.record_interval);
  }
  return out;
}

TEST(PanelChange, APillarTakesOverTheForceThatThePaneGave) {
  // the pillar, 400 kN/m and the head's 1 MN/m in series, resists as far as the head goes into it: all of the depth were 25 kN
  const double along = 10, inward = 8, pane = 3500, pillar = 286e3;
  const std::vector<double> F = forces(along, inward, 1e-3);
  EXPECT_NEAR(F[0], pane, 0.02 * pane);
  for (std::size_t k = 1; k < F.size(); ++k) EXPECT_LT(F[k] - F[k - 1], pillar * std::hypot(along, inward) * 1e-3) << k;
  EXPECT_GT(*std::max_element(F.begin(), F.end()), 2 * pane);
}

/// What the pillar adds goes with the way: it is off by no more than that of one step on the pane, 35 mrad of its spring.
TEST(PanelChange, HangsOnTheStepByNoMoreThanTheWayOfOne) {
  const double along = 10, inward = 8, pillar = 286e3, pane = 52e3, mass = 4.1;
  const double step = 0.035 * std::sqrt(mass / pane);
  const std::vector<double> coarse = forces(along, inward, 1e-3), fine = forces(along, inward, 1e-4);
  for (std::size_t k = 0; k < fine.size(); ++k) EXPECT_NEAR(coarse[k], fine[k], pillar * std::hypot(along, inward) * step) << k;
}

}  // namespace
}  // namespace engine::test
