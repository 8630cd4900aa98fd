// A wheel and what lies in its way: where they touch, and what it does to both.
#include <gtest/gtest.h>

#include "engine/geometry/point_tyre.h"
#include "tests/engine/experiment.h"

namespace engine::test {
namespace {

TEST(TyrePair, TouchesASphereWhereTheTorusDoes) {
  const Tyre tyre{Vec3::Zero(), Vec3::UnitY(), 0.3, 0.1};
  const HyperEllipsoid sphere{Vec3::Constant(0.12), 2};
  for (const double x : {-0.3, 0.0, 0.1, 0.25})
    for (const double y : {0.0, 0.05, -0.15}) {
      // a circle of radius 0.2 thickened by 0.1, and a sphere of 0.12 that touches it from below: in the plane of the sphere's
      // centre and the axis of the sweep (x, z) + lift
      const auto touch = move_clear(tyre, sphere, {Vec3(x, y, -0.3)}, Vec3::UnitZ(), 0.2, -1);
      ASSERT_TRUE(touch) << x << " " << y;
      const Vec3 centre = Vec3(0, 0, touch->way) - Vec3(x, y, -0.3);
      const double in_plane = std::hypot(centre.x(), centre.z()) - 0.2;
      EXPECT_NEAR(std::hypot(in_plane, centre.y()), 0.1 + 0.12, 1e-9);
      EXPECT_NEAR((touch->point - Vec3(x, y, -0.3)).norm(), 0.12, 1e-9);
    }
}

TEST(TyrePair, IsAsFarFromASphereAsTheTorus) {
  const Tyre tyre{Vec3(0, 0, 0.3), Vec3::UnitY(), 0.3, 0.1};
  const HyperEllipsoid sphere{Vec3::Constant(0.12), 2};
  for (const double gap : {-1e-2, -1e-4, 1e-4, 1e-2}) {
    for (const double turn : {0.1, 0.8, 2.0}) {
      const Vec3 place = tyre.centre + (0.3 + 0.12 + gap) * Vec3(std::cos(turn), 0, std::sin(turn));
      const auto contact = contact_with_tyre(sphere, {place}, tyre, 0.05);
      ASSERT_TRUE(contact) << gap << " " << turn;
      EXPECT_NEAR(contact->gap, gap, 1e-9);
      EXPECT_LT((contact->normal - (place - tyre.centre).normalized()).norm(), 1e-6);
    }
  }
  EXPECT_FALSE(contact_with_tyre(sphere, {tyre.centre + Vec3(0.6, 0, 0)}, tyre, 0.05));
}

/// The way of a tyre over a long, flat or edged part against a search of the lowest tangent plane over many normals.
TEST(TyrePair, LeavesPartsOfAllFormsAsASweepOverNormalsSays) {
  const Tyre tyre{Vec3(0.1, 0.05, 0.35), Vec3(0.1, 1, 0.05).normalized(), 0.3, 0.1};
  for (const double exponent : {2.0, 2.5, 4.0, 8.0, 20.0}) {
    const HyperEllipsoid part{Vec3(0.08, 0.25, 0.06), exponent};
    const Pose X{Vec3(0.2, 0.1, 0.05), Quat(Eigen::AngleAxisd(0.4, Vec3(0.3, 0.2, 1).normalized()))};
    const auto touch = move_clear(tyre, part, X, Vec3::UnitZ(), 0.2, -1);
    ASSERT_TRUE(touch);
    double best = 1e9;
    for (int i = -400; i <= 400; ++i)
      for (int k = -400; k <= 400; ++k) {
        const Vec3 m(0.01 * i, 0.01 * k, 1);
        const Vec3 across = m - m.dot(tyre.axle) * tyre.axle;
        best = std::min(best,
                        0.2 * across.norm() + 0.1 * m.norm() + support_value(part, X.q.conjugate() * m) - m.dot(tyre.centre - X.p));
      }
    EXPECT_LT(touch->way, best + 1e-6) << exponent;
    EXPECT_GT(touch->way, best - 1e-3) << exponent;  // the grid's spacing of 0.01 over a radius of curvature of 0.3 m and less
  }
}

/// Over the edge of a wall ahead the way falls for ever, the steeper the farther: the search ends where that says no.
TEST(TyrePair, AWallTheWheelDoesNotStandOnIsNoneAtOnce) {
  const Tyre tyre{Vec3(0, 0, 0.31), Vec3::UnitY(), 0.31, 0.1};
  const HyperEllipsoid wall{Vec3(0.3, 4, 1.2), 30};
  const Vec3 up(-2.2e-7, 0, 1);  // of a car that nods
  for (int k = 0; k <= 250; ++k)
    for (const double least : {-1.0, -5e-6}) {
      const double ahead = 0.25 + 0.01 * k;  // [m] of the wall's face, from the axle
      const auto touch = move_clear(tyre, wall, {Vec3(0.3 + ahead, 0.77, 1.2)}, up, 0.2, least);
      EXPECT_TRUE(!touch || (ahead < tyre.radius && touch->way > 2)) << ahead;  // else clear of it
    }
}

// ---- a car that meets something on the road ----

constexpr double kFriction = 0.8;

/// A free-rolling car of 1200 kg without bodywork that comes from -x.
Model car_on_road(double speed, double duration) {
  Model model = on_ground(duration);
  model.settings.record_interval = 2e-3;
  model.bodies = {inert(1200, {400, 1800, 2000}, {-3, 0, 0.55})};
  model.bodies[0].name = "car";
  model.bodies[0].vehicle = 0;
  model.bodies[0].V_WB.v.x() = speed;
  Vehicle car;
  car.name = "car";
  car.body = 0;
  for (const Vec3& hub : {Vec3(1.3, 0.75, -0.25), Vec3(1.3, -0.75, -0.25), Vec3(-1.3, 0.75, -0.25), Vec3(-1.3, -0.75, -0.25)}) {
    Wheel wheel;
    wheel.hub_B = hub;
    wheel.radius = 0.3;
    wheel.friction = kFriction;
    car.wheels.push_back(wheel);
  }
  model.vehicles = {car};
  return model;
}

/// Deepest [m] of any wheel, where it is drawn, in the second body over the whole run; positive: they never met.
double least_gap(const Model& model, const Recording& run) {
  double least = 1;
  for (const Snapshot& s : run.snapshots)
    for (const WheelRecord& wheel : s.wheels) {
      const Wheel& spec = model.vehicles[0].wheels[static_cast<std::size_t>(wheel.wheel)];
      const Tyre tyre{wheel.hub, s.bodies[0].X_WB.q * Vec3::UnitY(), spec.radius, crown_radius(spec)};
      const auto contact = contact_with_tyre(std::get<HyperEllipsoid>(model.bodies[1].shape), s.bodies[1].X_WB, tyre, 0.1);
      if (contact) least = std::min(least, contact->gap);
    }
  return least;
}

TEST(Wheel, RollsOverALyingEllipsoidAndNotThroughIt) {
  Model model = car_on_road(4, 2);
  Body part = solid({{0.25, 0.5, 0.06}, 2.5}, 30, {0, 0.75, 0.06});
  part.surface.friction_ground = 1;
  model.bodies.push_back(part);
  const Recording run = simulate(model);
  EXPECT_GT(run.snapshots.back().bodies[0].X_WB.p.x() - 1.3, run.snapshots.back().bodies[1].X_WB.p.x() + 0.5)
      << "both wheels past it";
  // a wheel is drawn where it stood at the start of the last step: 4 mm ago
  EXPECT_GT(least_gap(model, run), -4e-3);
  double lifted = 0;
  int over = 0;
  for (const Snapshot& s : run.snapshots) {
    lifted = std::max(lifted, s.wheels[0].hub.z());
    for (const ContactRecord& c : s.contacts) over += c.body_a == 1 && c.body_b == 0 && c.normal_force > 0;
  }
  EXPECT_NEAR(lifted, 0.3 + 0.12, 0.02) << "as high as the part, which tips a little";
  EXPECT_GT(over, 20);
  EXPECT_LT(std::abs(run.snapshots.back().energies.residual), 1e-2 * 0.5 * 1200 * 16);
}

/// A cart of 2 kg on stiff springs that are pressed in flies up against a ceiling. Its springs, 11 kg over a step, would throw it
/// metres a second: the ceiling takes that, and the cart stays beneath it. Thrown back down it would press in the springs out of
/// nothing.
TEST(Wheel, ThatPressesALightCartToACeilingHoldsItThere) {
  constexpr double kPressed = 0.01, kGap = 0.005, kSpring = 660e3;
  Model model = on_ground(0.1, 2e-3);
  model.settings.record_interval = 2e-3;
  const double start = 0.3 + 0.6 - kPressed;
  Body cart = ball(0.1, 2, {0, 0, start});
  cart.vehicle = 0;
  cart.V_WB.v.z() = 5;
  Body ceiling = ball(1, 1, {0, 0, start + 0.1 + kGap + 1});
  ceiling.fixed = true;
  model.bodies = {cart, ceiling};
  Vehicle vehicle;
  vehicle.body = 0;
  for (const double x : {0.5, -0.5})
    for (const double y : {0.5, -0.5}) {
      Wheel wheel;
      wheel.hub_B = {x, y, -0.6};
      wheel.spring = kSpring;
      wheel.damper = 0;
      vehicle.wheels.push_back(wheel);
    }
  model.vehicles = {vehicle};
  const Recording run = simulate(model);
  for (const Snapshot& s : run.snapshots) {
    const double way = s.bodies[0].X_WB.p.z() - start;
    EXPECT_GT(way, s.time > 0 ? kGap - 1e-3 : -1e-9) << "at " << s.time;  // what a rigid contact of a step may leave
    EXPECT_LT(way, kGap + 1e-3) << "at " << s.time;
  }
  // nothing is left of its flight, and of what the springs held only that of the way it came up by
  const double left = kPressed - kGap;
  EXPECT_NEAR(run.snapshots.back().energies.kinetic, 0, 1e-6);
  EXPECT_NEAR(run.snapshots.back().wheels[0].load, kSpring * left, 0.2 * kSpring * left)
      << "that way to a millimetre, its own weight 5 N";
}

TEST(Wheel, ThatPushesALogAheadKeepsTheMomentumOfBoth) {
  Model model = car_on_road(5, 0.9);
  Body log = solid({{0.1, 0.6, 0.1}, 2}, 40, {0, 0, 0.1});
  log.X_WB.p.y() = 0.75;
  log.surface.friction_ground = 0;
  model.bodies.push_back(log);
  for (Wheel& wheel : model.vehicles[0].wheels) wheel.friction = 0;
  const Recording run = simulate(model);
  const Snapshot& end = run.snapshots.back();
  EXPECT_GT(end.bodies[1].V_WB.v.x(), 1) << "struck";
  EXPECT_NEAR(1200 * end.bodies[0].V_WB.v.x() + 40 * end.bodies[1].V_WB.v.x(), 1200 * 5, 1e-6 * 1200 * 5);
  EXPECT_GT(least_gap(model, run), -6e-3);
}

/// A post as high as the hubs stands in the way of both front wheels: an impact without restitution.
TEST(Wheel, ThatRunsIntoAPostStopsThere) {
  Model model = car_on_road(3, 1);
  Body post = solid({{0.1, 2, 0.4}, 4}, 100, {0, 0, 0.4});
  post.fixed = true;
  model.bodies.push_back(post);
  const Recording run = simulate(model);
  EXPECT_LT(run.snapshots.back().bodies[0].X_WB.p.x() + 1.3 + 0.3, -0.1 + 0.01);
  EXPECT_LT(run.snapshots.back().bodies[0].V_WB.v.x(), 0.05);
  EXPECT_GT(least_gap(model, run), -2e-3);
}

/// Rubber gives by 3 cm: what lies no farther inside a tyre touches it, and of what does only the rest is told.
TEST(Wheel, GivesAsRubberDoes) {
  for (const double overlap : {0.02, 0.05}) {
    Model model = car_on_road(0, 0.01);
    Body post = solid({{0.1, 0.1, 0.1}, 2}, 100, {-3 + 1.3 + 0.3 + 0.1 - overlap, 0.75, 0.3});
    post.fixed = true;
    model.bodies.push_back(post);
    const Recording run = simulate(model);
    double depth = -1;
    for (const ContactRecord& c : run.snapshots.at(1).contacts) depth = std::max(depth, c.depth);
    EXPECT_NEAR(depth, std::max(0.0, overlap - 0.03), 2e-3) << overlap;
  }
}

TEST(TyrePair, APointIsAsFarFromATyreAsFromTheDiscInItsCrown) {
  const Tyre tyre{Vec3(1, 2, 3), Vec3::UnitY(), 0.3, 0.1};
  const auto gap = [&](double x, double y) { return point_on_tyre(tyre.centre + Vec3(x, y, 0), tyre).gap; };
  EXPECT_NEAR(gap(0.35, 0), 0.05, 1e-12) << "before the tread";
  EXPECT_NEAR(gap(0.1, 0.12), 0.02, 1e-12) << "beside the wall";
  EXPECT_NEAR(gap(0.2 + 0.3, 0.4), 0.5 - 0.1, 1e-12) << "off the shoulder";
  EXPECT_NEAR(gap(0.28, 0), -0.02, 1e-12) << "inside";
  const SurfaceContact c = point_on_tyre(tyre.centre + Vec3(0, 0.12, -0.15), tyre);
  EXPECT_LT((c.normal - Vec3::UnitY()).norm(), 1e-12);
  EXPECT_LT((c.p_b - tyre.centre - Vec3(0, 0.1, -0.15)).norm(), 1e-12);
}

/// Two cars without bodywork whose left and right wheels stand side by side, treads 20 cm apart, gliding towards each other.
Model two_abreast(double closing) {
  Model model = car_on_road(0, 0.8);
  model.settings.effects["bodywork_contact"] = Force::on;
  Body other = model.bodies[0];
  other.name = "other";
  other.vehicle = 1;
  other.X_WB.p.y() = 2 * 0.75 + 0.2 + 0.2;
  other.V_WB.v.y() = -closing;
  model.bodies.push_back(other);
  Vehicle second = model.vehicles[0];
  second.name = "other";
  second.body = 1;
  model.vehicles.push_back(second);
  for (Vehicle& vehicle : model.vehicles)
    for (Wheel& wheel : vehicle.wheels) wheel.friction = 0;
  return model;
}

TEST(Wheel, BesideAnotherCarsWheelPushesItAwayAndKeepsTheMomentumOfBoth) {
  const Model model = two_abreast(1);
  const Recording run = simulate(model);
  const Snapshot& end = run.snapshots.back();
  EXPECT_LT(end.bodies[0].V_WB.v.y(), -0.3) << "struck";
  EXPECT_NEAR(end.bodies[0].V_WB.v.y() + end.bodies[1].V_WB.v.y(), -1, 1e-6);
  double nearest = 1;
  for (const Snapshot& s : run.snapshots) nearest = std::min(nearest, s.wheels[4 + 1].hub.y() - s.wheels[0].hub.y());
  EXPECT_NEAR(nearest, 0.2, 1e-3) << "flank on flank the crowns touch, and restitution is zero";
  EXPECT_STREQ(name_of(ShapePair{ShapeKind::tyre, ShapeKind::tyre}), "vehicle_pair");
}

/// Somebody of one part, as the second body.
void add_person(Model& model, Body part) {
  part.person = 0;
  model.bodies.push_back(part);
  Person person;
  person.bodies = {1};
  person.head = 1;
  person.zero_condition = false;
  model.persons = {person};
}

/// What the tread meets straight ahead at hub height it drives forward, and down as fast: there its rim moves by v and -v. A locked
/// wheel has no rim that moves, and one in the air nothing to pull against.
TEST(Wheel, ThatTurnsPullsDownWhatItMeetsInFront) {
  constexpr double kSpeed = 4;  // [m/s]
  enum Wheels { turn, locked, in_the_air };
  for (const Wheels wheels : {turn, locked, in_the_air}) {
    Model model = car_on_road(kSpeed, 0.1);
    model.settings.record_interval = 1e-3;
    model.vehicles[0].brake = wheels == locked ? 1.0 : 0.0;
    if (wheels == in_the_air) model.bodies[0].X_WB.p.z() += 1;
    Body part = ball(0.12, 0.5, {-3 + 1.3 + 0.3 + 0.12 + 0.05, 0.75, model.bodies[0].X_WB.p.z() - 0.25});
    part.surface.friction_ground = 5;
    part.surface.friction_body = 0;
    add_person(model, part);
    const Recording run = simulate(model);
    // pressed into the rubber until it goes as fast as the car, or is pushed off below a wheel that hangs from its strut
    const auto struck = std::find_if(run.snapshots.begin(), run.snapshots.end(),
                                     [](const Snapshot& s) { return s.bodies[1].V_WB.v.x() > 0.85 * s.bodies[0].V_WB.v.x(); });
    ASSERT_NE(struck, run.snapshots.end());
    const Twist& V = struck->bodies[1].V_WB;
    if (wheels == in_the_air) {
      EXPECT_LT(V.w.norm() * 0.12, 1e-6) << "the normal of a torus by iteration";
      continue;
    }
    // a ball that is rubbed at its side takes 2/7 of the speed it is rubbed with, and turns by the rest
    const double falls = -kGravity * struck->time, rubbed = wheels == turn ? -kSpeed : 0;
    EXPECT_NEAR(V.v.z(), falls + rubbed * 2 / 7, 0.05 * kSpeed) << wheels;
    EXPECT_NEAR(V.w.y() * 0.12, rubbed * 5 / 7, 0.05 * kSpeed) << wheels;
  }
}

/// A limb that flies into the front of a tyre at hub height presses it in as a mass does a spring: v sqrt(m / k), and nothing else
/// yields by this law. What passes in the free 3 cm is no depth, and neither is what the rubber gives.
TEST(Wheel, YieldsToALimbUnderALawByWhichNothingDoes) {
  constexpr double kSpeed = 2, kLimb = 3;  // [m/s], [kg]
  Model model = car_on_road(0, 0.05);
  model.settings.contact_law = ContactLaw::default_auto;
  Body limb = solid({{0.08, 0.5, 0.08}, 2}, kLimb, {-3 + 1.3 + 0.3 + 0.08, 0.75, 0.3});
  limb.V_WB.v.x() = -kSpeed;
  add_person(model, limb);
  const Recording run = simulate(model);
  const double reduced = kLimb * 1200 / (kLimb + 1200), pressed = kSpeed * std::sqrt(reduced / 2e5);
  EXPECT_NEAR(run.diagnostics.max_compression, pressed, 0.1 * pressed) << "a step is an eighth of the way in";
  for (const Snapshot& s : run.snapshots)
    for (const ContactRecord& c : s.contacts) EXPECT_LE(c.depth, 0) << s.time;
  EXPECT_GT(run.snapshots.back().bodies[1].V_WB.v.x(), -0.2) << "stopped";
  EXPECT_LT(run.diagnostics.max_energy_rise, 0.05);
}

}  // namespace
}  // namespace engine::test
