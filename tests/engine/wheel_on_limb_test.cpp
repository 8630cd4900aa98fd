// A wheel that stands on somebody: what it carries, what the limb gives way by, against statics.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/engine/experiment.h"

namespace engine::test {
namespace {

constexpr double kCarMass = 1200, kLimbHeight = 0.12;    // [kg], [m]
constexpr double kHalfBase = 1.3, kHalfTrack = 0.75;     // [m]
constexpr double kOnLimb = kCarMass * kGravity / 4;      // [N] static load of a wheel
constexpr double kTissue = 400e3 * 1e9 / (400e3 + 1e9);  // [N/m] limb and road in series

/// A car at rest on as many limbs, under its first wheels, each a person of one part; its wheels just touch road or limbs.
Model car_on_limbs(int limbs, double limb_mass, double restitution, double step) {
  Model model = on_ground(1.5, step);
  model.settings.contact_law = ContactLaw::persons_yield;
  Body car = inert(kCarMass, {400, 1800, 2000}, {0, 0, 0.55 + kLimbHeight});
  car.name = "car";
  car.vehicle = 0;
  Vehicle vehicle;
  vehicle.body = 0;
  vehicle.brake = limbs == 4 ? 0.0 : 1.0;  // a car that leans would roll off
  model.bodies = {car};
  for (const double x : {kHalfBase, -kHalfBase})
    for (const double y : {kHalfTrack, -kHalfTrack}) {
      Wheel wheel;
      wheel.hub_B = {x, y, -0.25};
      vehicle.wheels.push_back(wheel);
      if (static_cast<int>(model.bodies.size()) > limbs) continue;
      Body limb = solid({{0.2, 0.3, 0.5 * kLimbHeight}, 2}, limb_mass, {x, y, 0.5 * kLimbHeight});
      limb.person = static_cast<int>(model.persons.size());
      limb.surface.restitution_ground = restitution;
      Person person;
      person.bodies = {static_cast<int>(model.bodies.size())};
      person.head = person.bodies.front();
      person.zero_condition = false;
      model.bodies.push_back(limb);
      model.persons.push_back(person);
    }
  model.vehicles = {vehicle};
  return model;
}

/// What carries and what gives way at the end, of one limb.
struct Pressed {
  double by_wheel = 0, by_road = 0;  // [N]
  double depth = 0;                  // [m] in the road
};

Pressed pressed_at_last(const Recording& run, int limb) {
  Pressed out;
  for (const ContactRecord& c : run.snapshots.back().contacts) {
    if (c.body_a != limb) continue;
    (c.body_b == 0 ? out.by_wheel : out.by_road) += c.normal_force;
    if (c.body_b < 0) out.depth = std::max(out.depth, c.depth);
  }
  return out;
}

class WheelOnLimb : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Steps, WheelOnLimb, testing::Values(2e-3, 1e-3, 5e-4));

/// A wheel's spring is over a step stiffer than a foot is heavy. While the wheel displaced the foot by its whole impulse and the
/// road by half of its own, the foot sank by half of N h / m each second: 1.5 m/s at 1 ms.
TEST_P(WheelOnLimb, CarriesItsLoadThereAndPressesItInByTheLaw) {
  for (const double mass : {1.0, 3.0}) {
    for (const double restitution : {0.0, 1.0}) {
      const Recording run = simulate(car_on_limbs(4, mass, restitution, GetParam()));
      ASSERT_FALSE(run.failure);
      const double load = kOnLimb + mass * kGravity, stiff = load / kTissue;
      for (int limb = 1; limb <= 4; ++limb) {
        const Pressed it = pressed_at_last(run, limb);
        // what is left of the car's swing on its dampers after 1.5 s: below a thousandth
        EXPECT_NEAR(it.by_wheel, kOnLimb, 2e-3 * kOnLimb) << mass << " kg, e = " << restitution;
        EXPECT_NEAR(it.by_road, load, 2e-3 * load) << mass << " kg, e = " << restitution;
        // e = 1: F = S depth. At rest e = 0 stands between S and S/2 (laws/compliant_contact.h)
        EXPECT_GT(it.depth, 0.98 * stiff) << mass << " kg, e = " << restitution;
        EXPECT_LT(it.depth, (restitution > 0 ? 1.02 : 2.02) * stiff) << mass << " kg, e = " << restitution;
      }
      EXPECT_LT(run.diagnostics.max_unexplained, 1e-3 * run.diagnostics.energy_turned_over);
    }
  }
}

/// One wheel stands higher than the others by d. Of that the car's lift, pitch and roll take up three quarters; the rest warps its
/// four springs by d/4 each. The car leans by d/2 over its track and base, and its weight shifts away from that wheel.
TEST_P(WheelOnLimb, TakesMoreOfTheCarsLoadByTheWarpOfItsSprings) {
  Model model = car_on_limbs(1, 1, 1, GetParam());
  model.bodies[1].surface.friction_ground = 0.3;
  const Recording run = simulate(model);
  ASSERT_FALSE(run.failure);
  const Wheel& wheel = model.vehicles[0].wheels[0];
  const Pressed it = pressed_at_last(run, 1);
  const double d = kLimbHeight - it.depth, track = 2 * kHalfTrack, base = 2 * kHalfBase;
  const double roll = d / 2 / track, pitch = d / 2 / base;
  // the centre of mass over the wheels' points: beneath the hubs, and by the roll out on the tyres' shoulders
  const double over_hub = -wheel.hub_B.z(), over_shoulder = over_hub + wheel.radius - crown_radius(wheel);
  const double shift = kCarMass * kGravity / 2 * (over_shoulder * roll / track + over_hub * pitch / base);
  const double load = kOnLimb + wheel.spring * d / 4 - shift;
  EXPECT_NEAR(it.by_wheel, load, 0.01 * load) << "a lean of 2 degrees, of which the square is left out, and the brakes' friction";
  EXPECT_NEAR(it.depth, (it.by_wheel + kGravity) / kTissue, 0.02 * it.depth);
}

bool run_over_told(const Recording& run) {
  return std::any_of(run.events.begin(), run.events.end(), [](const Event& e) { return e.kind == "run_over"; });
}

/// A ball that nothing moves, beneath the tyre's shoulder: it bears the wheel with a normal half a right angle off the upright.
TEST(Wheel, ThatBearsItsLoadOnWhatIsRoundHasRunOverIt) {
  constexpr double kBall = 0.1;  // [m]
  Model model = car_on_limbs(1, 5, 0, 1e-3);
  model.bodies[1] = solid({{kBall, kBall, kBall}, 2}, 5, {kHalfBase, kHalfTrack + 0.17, kBall});
  model.bodies[1].person = 0;
  model.bodies[1].fixed = true;
  const Recording run = simulate(model);
  double most = 0, steepest = 0;  // [N] upright, [-]
  for (const Snapshot& s : run.snapshots)
    for (const ContactRecord& c : s.contacts)
      if (c.body_a == 1 && c.body_b == 0) {
        most = std::max(most, -c.normal.z() * c.normal_force);
        if (c.normal_force > 0) steepest = std::max(steepest, -c.normal.z());
      }
  ASSERT_GT(most, 0.5 * kOnLimb);
  ASSERT_LT(steepest, 0.9);
  EXPECT_TRUE(run_over_told(run));
}

/// A ball as heavy as a head that flies against the side of a tyre, above the middle of its wall.
TEST(Wheel, ThatIsTouchedFromTheSideHasRunOverNobody) {
  Model model = car_on_limbs(1, 5, 0, 1e-3);
  model.bodies[0].X_WB.p.z() = 0.55;
  model.bodies[1] = solid({{0.1, 0.1, 0.1}, 2}, 5, {kHalfBase, kHalfTrack + 0.4, 0.25});
  model.bodies[1].person = 0;
  model.bodies[1].V_WB.v = {0, -5, 0};
  const Recording run = simulate(model);
  double most = 0;  // [N]
  for (const Snapshot& s : run.snapshots)
    for (const ContactRecord& c : s.contacts)
      if (c.body_a == 1 && c.body_b == 0) most = std::max(most, c.normal_force);
  ASSERT_GT(most, 0.5 * kOnLimb);
  EXPECT_FALSE(run_over_told(run));
}

/// A flat limb of 30 kg on ice. A car's left front wheel stands on it and goes along it at 4 m/s, rolling or locked, for 50 ms.
struct Pass {
  double gained = 0;   // [m/s] by the limb
  double pressed = 0;  // [N s] by the wheel
};
constexpr double kFlatMass = 30, kOnFlat = 0.5;  // [kg], [-] friction

Pass pass_over_flat_limb(double brake) {
  constexpr double kSpeed = 4, kHeight = 0.04;  // [m/s], [m]
  Model model = car_on_limbs(1, kFlatMass, 0, 1e-3);
  model.settings.duration = 0.05;
  model.settings.record_interval = model.settings.step;
  model.ground.surface.friction_ground = 0.0;
  model.vehicles[0].brake = brake;
  Body &car = model.bodies[0], &limb = model.bodies[1];
  car.X_WB.p = {-kHalfBase - 0.2, 0, 0.55 + kHeight};
  car.V_WB.v.x() = kSpeed;
  limb = solid({{0.8, 0.3, 0.5 * kHeight}, 8}, kFlatMass, {0, kHalfTrack, 0.5 * kHeight});
  limb.person = 0;
  limb.surface.friction_ground = kOnFlat;  // clothes hold rubber as they hold a road
  const Recording run = simulate(model);
  Pass out;
  out.gained = run.snapshots.back().bodies[1].V_WB.v.x();
  for (const Snapshot& s : run.snapshots)
    for (const ContactRecord& c : s.contacts)
      if (c.body_a == 1 && c.body_b == 0) out.pressed += c.normal_force * model.settings.record_interval;
  return out;
}

/// Beneath, a wheel that rolls freely stands still where it touches: it has no inertia against turning, and gives no friction along
/// its way. Locked it slides over what lies there and drags it.
TEST(Wheel, DragsWhatItStandsOnWhereItIsLockedAndNotWhereItRolls) {
  const Pass locked = pass_over_flat_limb(1), rolling = pass_over_flat_limb(0);
  ASSERT_GT(locked.pressed, 100) << "50 ms of some 3 kN";
  ASSERT_GT(rolling.pressed, 100);
  const auto dragged = [](const Pass& pass) { return kOnFlat * pass.pressed / kFlatMass; };
  // the limb sinks and tips by a hundredth beneath the wheel, and by as much the load has a share along the way
  EXPECT_NEAR(locked.gained, dragged(locked), 0.03 * dragged(locked));
  EXPECT_LT(std::abs(rolling.gained), 0.03 * dragged(rolling));
}

}  // namespace
}  // namespace engine::test
