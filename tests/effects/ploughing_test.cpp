// A part that ploughs through a panel, against closed forms, areas counted on a grid, and a run.
#include "engine/contact/ploughing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/math/types.h"
#include "engine/simulate.h"
#include "scenes/scene.h"

using namespace engine;

namespace {

const Vec3 kUp = Vec3::UnitZ();

/// Tangential over normal force of a part that lies `d` deep, by the areas it shows to an even pressure: from in front the half of
/// its section ahead, along the slip (x) its widest section below the panel.
double by_areas(const HyperEllipsoid& part, double d) {
  constexpr int kCells = 1000;
  const Vec3 s = part.semi_axes;
  const double level = -s.z() + d, cell = 2.0 / kCells, layer = d / kCells;
  int in_front = 0, along = 0;
  for (int i = 0; i < kCells; ++i)
    for (int j = 0; j < kCells; ++j) {
      const double a = -1 + (i + 0.5) * cell, b = -1 + (j + 0.5) * cell;
      in_front += a > 0 && gauge(part, {a * s.x(), b * s.y(), level}) < 1;
      along += gauge(part, {0, a * s.y(), level - (j + 0.5) * layer}) < 1;
    }
  return along * cell * s.y() * layer / (in_front * cell * s.x() * cell * s.y());
}

TEST(Ploughing, OfASphereIsThatOfBowdenAndTabor) {
  const double R = 0.1, d = 0.001;
  const HyperEllipsoid sphere{{R, R, R}, 2};
  // their contact radius is that of the parabola, 2 R d for 2 R d - d^2: a quarter of d / R in the ratio
  const double a = std::sqrt(2 * R * d);
  EXPECT_NEAR(ploughing(sphere, kUp, Vec3::UnitX(), d), 4 * a / (3 * std::numbers::pi * R),
              0.26 * d / R * 4 * a / (3 * std::numbers::pi * R));
}

TEST(Ploughing, IsTheRatioOfTheAreasThatAPartShows) {
  // the section along the slip, a segment of an ellipse of half height c, is taken for one of a parabola: (4/3) (1 - cos t) sin t
  // for t - sin t cos t with cos t = 1 - d/c; a grid of thousandths adds 0.3 %
  for (const double d : {0.005, 0.02, 0.04}) {
    const HyperEllipsoid head{{0.0975, 0.0775, 0.12}, 2};
    const double t = std::acos(1 - d / 0.12);
    const double parabola = 4.0 / 3 * (1 - std::cos(t)) * std::sin(t) / (t - std::sin(t) * std::cos(t));
    EXPECT_NEAR(ploughing(head, kUp, Vec3::UnitX(), d) / by_areas(head, d), parabola, 0.003 * parabola) << d;
  }
}

TEST(Ploughing, OfALeaningEllipsoidIsThatOfItsSection) {
  // a forearm on its tip, all but buried: its section is the ellipse through the centre, smaller by the root of 1 - (1 - d/h)^2
  const HyperEllipsoid forearm{{0.04, 0.042, 0.205}, 2};
  const Vec3 inward = Vec3(0.5, -0.3, 0.9).normalized(), slip = inward.cross(Vec3(0.2, 1, 0.1)).normalized();
  const double h = support_value(forearm, inward);
  for (const double d : {0.1 * h, 0.5 * h, 0.9 * h}) {
    const double L = std::sqrt(1 - (1 - d / h) * (1 - d / h)) / slip.cwiseQuotient(forearm.semi_axes).norm();
    EXPECT_NEAR(ploughing(forearm, inward, slip, d), 8 / (3 * std::numbers::pi) * d / L, 1e-5 * d / L) << d;
  }
}

TEST(Ploughing, IsLessAlongALongPartAndMoreTheDeeper) {
  const HyperEllipsoid thigh{{0.09, 0.088, 0.26}, 2.5};
  const Vec3 out = Vec3::UnitX();
  EXPECT_LT(ploughing(thigh, out, Vec3::UnitZ(), 0.02), 0.5 * ploughing(thigh, out, Vec3::UnitY(), 0.02));
  double last = 0;
  for (const double d : {0.0, 0.01, 0.02, 0.05, 0.08}) {
    const double now = ploughing(thigh, out, Vec3::UnitY(), d);
    EXPECT_TRUE(d == 0 ? now == 0 : now > last) << d;
    last = now;
  }
  EXPECT_TRUE(std::isfinite(ploughing(thigh, out, Vec3::UnitY(), 1.0)));
}

/// [N s] along the surface and across it, of all contacts of the person with the car whose surfaces have no friction.
struct Impulses {
  double normal = 0, tangential = 0;
};
Impulses on_a_smooth_car(const std::string& law, const std::string& friction) {
  const scenes::Scene scene =
      scenes::load(std::string(CRASHREEL_SOURCE_DIR) + "/scenes/cases/sedan_pedestrian_40kmh.toml",
                   {"simulation.duration=0.3 s", "simulation.contact_law=" + law, "person.pedestrian.friction_body=" + friction});
  Impulses out;
  for (const Snapshot& s : simulate(scene.model).snapshots)
    for (const ContactRecord& c : s.contacts) {
      if (!c.shapes.on_vehicle()) continue;
      out.normal += c.normal_impulse;
      out.tangential += c.tangential_impulse;
    }
  return out;
}

TEST(Ploughing, HoldsAPersonOnAPanelWithoutFriction) {
  const Impulses yields = on_a_smooth_car("persons_yield", "0");
  // limbs of 5 to 12 cm pressed 1 to 5 cm into panels: 0.1 to 0.5 by the closed forms above
  EXPECT_GT(yields.tangential, 0.05 * yields.normal);
  EXPECT_LT(yields.tangential, 0.5 * yields.normal);
  EXPECT_EQ(on_a_smooth_car("default_auto", "0").tangential, 0);
}

TEST(Ploughing, AddsToFrictionThatChangesWithTime) {
  const Impulses table = on_a_smooth_car("persons_yield", R"([["0 s", 0], ["9 s", 0]])");
  const Impulses number = on_a_smooth_car("persons_yield", "0");
  EXPECT_NEAR(table.tangential, number.tangential, 1e-6 * number.normal);
}

}  // namespace
