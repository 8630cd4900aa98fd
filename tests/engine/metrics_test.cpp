// What is measured of the throw of persons.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "engine/measure/phases.h"
#include "tests/engine/hand_made_runs.h"

namespace engine {
namespace {

constexpr int kMount = 3;

/// Person and car with a bicycle, which has its rider's number.
Model rider_and_car() {
  Model model = person_and_car();
  model.bodies.emplace_back();
  model.bodies[kMount].name = "bicycle";
  model.bodies[kMount].person = 0;
  model.bodies[kMount].vehicle = 1;
  model.bodies[kMount].mass = 15;
  Vehicle bicycle;
  bicycle.name = "bicycle";
  bicycle.body = kMount;
  model.vehicles.push_back(bicycle);
  model.persons[0].mount = kMount;
  return model;
}

TEST(ThrowMetrics, DistancesAreThoseOfTheCentreOfMass) {
  const Model model = person_and_car();
  std::vector<Metric> out;
  measure_throw(model, struck_along_y(), 0, out);
  // centre of mass: (0.25, 0) when struck, (1.5, 16) at rest
  EXPECT_NEAR(value_of(out, "throw_distance_m").value(), std::hypot(1.25, 16), kAlmost);
  EXPECT_NEAR(value_of(out, "throw_along_m").value(), 16, kAlmost);
  EXPECT_NEAR(value_of(out, "throw_across_m").value(), -1.25, kAlmost);
  EXPECT_EQ(value_of(out, "rest_s"), 6.0);
  EXPECT_EQ(value_of(out, "landing_s"), 4.0);
  EXPECT_EQ(value_of(out, "first_ground_contact_s"), value_of(out, "landing_s")) << "one value for one thing";
}

TEST(ThrowMetrics, PhasesFollowEachOtherAndAddUpToTheThrow) {
  const Model model = person_and_car();
  const auto thrown = throw_of_person(model, struck_along_y(), 0);
  ASSERT_TRUE(thrown);
  const std::vector<std::pair<std::string, double>> expected{{"contact", 1}, {"carried", 2}, {"flight", 3},
                                                             {"landing", 4}, {"slide", 5},   {"rest", 6}};
  ASSERT_EQ(thrown->phases.size(), expected.size());
  double sum = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(thrown->phases[i].name, expected[i].first);
    EXPECT_NEAR(thrown->phases[i].from, expected[i].second, kAlmost) << expected[i].first;
    if (i > 0) {
      EXPECT_EQ(thrown->phases[i].from, thrown->phases[i - 1].to);
    }
    sum += thrown->phases[i].distance;
  }
  EXPECT_NEAR(sum, thrown->thrown.norm(), kAlmost);
  // (0.25, 5) m of the flight along (1.25, 16)
  EXPECT_NEAR(thrown->phases[2].distance, (0.25 * 1.25 + 5 * 16) / std::hypot(1.25, 16), kAlmost);
}

TEST(ThrowMetrics, AFootOnTheGroundIsNoLandingAndAWalkNoFlight) {
  const Model model = person_and_car();
  Recording run = struck_along_y();
  std::erase_if(run.events, [](const Event& e) { return e.kind == "ground_contact"; });
  std::vector<Metric> out;
  measure_throw(model, run, 0, out);
  EXPECT_FALSE(value_of(out, "landing_s"));
  EXPECT_FALSE(value_of(out, "airborne_m"));
  EXPECT_FALSE(value_of(out, "slide_m"));
  // down while the car still pushes: no flight, whatever was on the ground before
  run.events.push_back({3, "ground_contact", kHips, -1, Vec3::Zero(), 0});
  out.clear();
  measure_throw(model, run, 0, out);
  EXPECT_EQ(value_of(out, "landing_s"), 3.0);
  EXPECT_FALSE(value_of(out, "airborne_m"));
  EXPECT_TRUE(value_of(out, "slide_m"));
}

TEST(ThrowMetrics, WhoComesDownWithinAMomentFallsAndTheLandingBeginsOnTheGround) {
  const Model model = person_and_car();
  Recording run = struck_along_y();
  run.events[1].time = 3.04;  // 40 ms after the last push
  const auto thrown = throw_of_person(model, run, 0);
  ASSERT_TRUE(thrown);
  std::string names;
  for (const ThrowPhase& p : thrown->phases) names += std::string(p.name) + " ";
  EXPECT_EQ(names, "contact carried fall landing slide rest ");
  EXPECT_EQ(thrown->phases[2].from, 3.0);
  EXPECT_EQ(thrown->phases[3].from, 3.04) << "what comes before the touch of the ground is no landing";
  std::vector<Metric> out;
  measure_throw(model, run, 0, out);
  EXPECT_EQ(value_of(out, "fall_m"), thrown->phases[2].distance);
  EXPECT_FALSE(value_of(out, "airborne_m"));
}

TEST(ThrowMetrics, NoPhaseIsWithoutLengthAndRestLastsToTheEnd) {
  const Model model = person_and_car();
  Recording run = struck_along_y();
  for (const int i : {4, 5}) run.snapshots[i].contacts.clear();  // no bounce
  run.snapshots.push_back(run.snapshots.back());
  run.snapshots.back().time = 7;
  const auto thrown = throw_of_person(model, run, 0);
  ASSERT_TRUE(thrown);
  for (const ThrowPhase& p : thrown->phases) {
    EXPECT_GT(p.to, p.from) << p.name;
    EXPECT_STRNE(p.name, "landing");
  }
  EXPECT_EQ(thrown->phases.back().to, 7.0);
  EXPECT_EQ(thrown->phases.back().distance, 0.0);
  std::vector<Metric> out;
  measure_throw(model, run, 0, out);
  EXPECT_EQ(value_of(out, "landing_m"), 0.0) << "a figure, for who counts bounces over many runs";
}

TEST(ThrowMetrics, ACarThatBacksThrowsTheWayItGoes) {
  const Model model = person_and_car();
  Recording run = struck_along_y();
  const Quat backwards(Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitZ()));
  for (Snapshot& s : run.snapshots) s.bodies.own()[kCar].X_WB.q = backwards;
  std::vector<Metric> out;
  measure_throw(model, run, 0, out);
  EXPECT_NEAR(value_of(out, "throw_along_m").value(), 16, kAlmost);
  EXPECT_NEAR(value_of(out, "throw_across_m").value(), -1.25, kAlmost);
  EXPECT_TRUE(value_of(out, "carried_m")) << "as fast as the car, though against its axis";
}

/// A rider at 8 m/s along x and a car at 6 m/s along y touch between two recorded instants; the blow turns the mount round. The
/// throw goes along the way the faster of the two came, and not along a mean of its ways before and after.
TEST(ThrowMetrics, TheWayOfAThrowIsThatBeforeTheTouchWhereverItFallsBetweenTwoInstants) {
  const Model model = rider_and_car();
  for (const double touch : {1.0, 1.2, 1.5, 1.9}) {
    Recording run = struck_along_y();
    for (Snapshot& s : run.snapshots) {
      auto& bodies = s.bodies.own();
      bodies.emplace_back();
      bodies[kCar].V_WB.v = {0, 6, 0};
      bodies[kMount].V_WB.v = s.time <= 1 ? Vec3(8, 0, 0) : Vec3(-1, 5, 0);
    }
    run.snapshots[1].contacts.clear();
    run.events.front().time = touch;
    std::vector<Metric> out;
    measure_throw(model, run, 0, out);
    const Throw thrown = throw_of_person(model, run, 0).value();
    EXPECT_NEAR(thrown.along.x(), 1, kAlmost) << touch;
    EXPECT_NEAR(value_of(out, "throw_across_m").value(), thrown.thrown.y(), kAlmost) << touch;
  }
}

/// A pavement, a wall: bodies that are fixed.
TEST(ThrowMetrics, WhatIsFixedStrikesNobodyOnFootAndBearsWhoComesDownOnIt) {
  Model model = person_and_car();
  model.bodies.emplace_back();
  model.bodies[3].fixed = true;
  Recording run = struck_along_y();
  for (Snapshot& s : run.snapshots) s.bodies.own().emplace_back();
  for (const int i : {0, 1, 4, 5}) {
    run.snapshots[i].contacts.push_back(push(kHips, 3, kOnVehicle, {0, 0, 9}));
    run.snapshots[i].contacts.back().normal = Vec3::UnitZ();
  }
  for (const int i : {4, 5}) run.snapshots[i].contacts.erase(run.snapshots[i].contacts.begin());
  const auto thrown = throw_of_person(model, run, 0);
  ASSERT_TRUE(thrown);
  EXPECT_EQ(thrown->hit, 1.0) << "it stood on the pavement before";
  std::string names;
  for (const ThrowPhase& p : thrown->phases) names += std::string(p.name) + " ";
  EXPECT_EQ(names, "contact carried flight landing slide rest ");
  EXPECT_EQ(thrown->separated, 3.0);
  run.snapshots[0].contacts[0].normal = Vec3::UnitY();
  run.events.erase(run.events.begin());
  EXPECT_EQ(throw_of_person(model, run, 0)->vehicle, kCar) << "nor does one that leans at a wall begin its throw there";
}

TEST(ThrowMetrics, AVehicleOverWhoLiesIsToldWithoutAWheel) {
  Model model = person_and_car();
  model.persons[0].hips = kHips;
  Recording run = struck_along_y();  // down at 4 s
  for (Snapshot& s : run.snapshots) s.bodies.own()[kHips].X_WB.p = {0, 12, 0.1};
  for (const int i : {3, 5, 6}) run.snapshots[i].bodies.own()[kCar].X_WB.p = {0, 13, 0.5};
  std::vector<Metric> out;
  measure_throw(model, run, 0, out);
  EXPECT_EQ(value_of(out, "passed_over_s"), 5.0) << "not at 3 s, before it came down";
  for (Snapshot& s : run.snapshots) s.bodies.own()[kHips].X_WB.p.z() = 1.1;  // on the roof
  out.clear();
  measure_throw(model, run, 0, out);
  EXPECT_FALSE(value_of(out, "passed_over_s"));
}

TEST(ThrowMetrics, WhoIsPushedAgainAfterComingDownDoesNotSlideByItself) {
  const Model model = person_and_car();
  Recording run = struck_along_y();  // down at 4 s, at rest at 6 s
  EXPECT_FALSE(throw_of_person(model, run, 0)->dragged);
  const double separated = *throw_of_person(model, run, 0)->separated;
  run.snapshots[6].contacts.push_back(push(kHips, kCar, kOnVehicle, {0, 1, 0}));
  const auto again = throw_of_person(model, run, 0);
  EXPECT_TRUE(again->dragged);
  EXPECT_EQ(*again->separated, separated) << "the flight began where it did";
}

/// A car that has stopped lets go of who slides off it. A tenth of a second later a foot is down, and then the trunk:
/// a fall. Later the car rolls against who lies there.
TEST(ThrowMetrics, WhoSlidesOffAStandingCarFallsLandsAndIsTouchedAgain) {
  Model model = person_and_car();
  model.bodies.resize(4);  // the last is a part of somebody else
  Recording run;
  run.interval = 0.02;
  for (int i = 0; i <= 200; ++i) {  // the centre goes at 2 m/s until 1 s, then slows down to rest at 3 s
    Snapshot s = still(0.02 * i);
    const double t = std::min(s.time, 3.0), after = std::max(0.0, t - 1);
    const double speed = t < 1 ? 2 : 2 - after, way = 2 * std::min(t, 1.0) + 2 * after - 0.5 * after * after;
    for (const int b : {kHead, kHips}) {
      s.bodies.own()[b].X_WB.p = {way, 0, 1};
      s.bodies.own()[b].V_WB.v = {speed, 0, 0};
    }
    s.bodies.own()[kCar].V_WB.v = {s.time < 0.59 ? 3.0 : s.time > 1.99 ? 0.1 : 0.0, 0, 0};
    run.snapshots.push_back(s);
  }
  const auto push_at = [&](std::size_t i, int other, const ShapePair& shapes) {
    run.snapshots[i].contacts.push_back(push(kHips, other, shapes, {0, 0, 5}));
  };
  for (std::size_t i = 10; i <= 45; ++i) push_at(i, kCar, kOnVehicle);  // until 0.9 s
  for (std::size_t i = 46; i <= 150; ++i) push_at(i, -1, kOnGround);    // a foot, from 1.3 s on the trunk
  for (std::size_t i = 100; i <= 125; ++i) push_at(i, kCar, kOnVehicle);
  run.events = {{0.2, "first_contact", kHips, kCar, Vec3::Zero(), 0},
                {1.3, "ground_contact", kHips, -1, Vec3::Zero(), 0},
                {3, "rest", kHips, -1, Vec3::Zero(), 0}};
  const auto thrown = throw_of_person(model, run, 0);
  ASSERT_TRUE(thrown);
  EXPECT_NEAR(thrown->separated.value(), 0.9, kAlmost) << "not the push at 2 s, when it lay";
  EXPECT_TRUE(thrown->dragged);
  Recording stands = run;  // against a foot that slips along it
  for (Snapshot& s : stands.snapshots)
    if (s.time > 1.99) s.bodies.own()[kCar].V_WB.v.setZero();
  EXPECT_FALSE(throw_of_person(model, stands, 0)->dragged);
  std::vector<Metric> out;
  measure_throw(model, run, 0, out);
  // from 0.2 to 0.6 s it is slower than the car, then rides on it as it stops
  EXPECT_NEAR(value_of(out, "contact_m").value(), 2 * 0.4, kAlmost);
  EXPECT_NEAR(value_of(out, "carried_m").value(), 2 * 0.3, kAlmost);
  EXPECT_FALSE(value_of(out, "airborne_m"));
  EXPECT_NEAR(value_of(out, "fall_m").value(), 2 * 0.1 + 2 * 0.3 - 0.045, 1e-9);
  EXPECT_NEAR(value_of(out, "slide_m").value(), 2 * 1.7 - 0.5 * (4 - 0.09), 1e-9);
  double sum = 0;
  for (const ThrowPhase& phase : thrown->phases) sum += phase.distance;
  EXPECT_NEAR(sum, value_of(out, "throw_distance_m").value(), 1e-9);
  // free of car and ground for long enough it flew; the same run without the foot
  for (std::size_t i = 46; i <= 64; ++i) run.snapshots[i].contacts.clear();
  out.clear();
  measure_throw(model, run, 0, out);
  EXPECT_FALSE(value_of(out, "fall_m"));
  EXPECT_NEAR(value_of(out, "airborne_m").value(), 2 * 0.1 + 2 * 0.3 - 0.045, 1e-9);
  // and did not where somebody else touched it meanwhile
  for (std::size_t i = 46; i <= 64; i += 2)
    run.snapshots[i].contacts = {push(kHips, 3, {ShapeKind::round, ShapeKind::round}, {0, 0, 5})};
  EXPECT_FALSE(throw_of_person(model, run, 0)->flew);
}

/// A rider whose mount is pushed over and whom nobody touches himself comes down with it: all of the way to the ground is flight,
/// from where the mount lets go of it.
TEST(ThrowMetrics, WhoFallsOffAStruckMountHasNoContactOfItsOwn) {
  Model model = rider_and_car();
  Recording run;
  run.interval = 0.02;
  for (int i = 0; i <= 100; ++i) {  // at 1 m/s from 0.5 s to 1.5 s
    Snapshot s = still(0.02 * i);
    s.bodies.own().resize(4);
    const bool moves = s.time > 0.49 && s.time < 1.49;
    for (const int b : {kHead, kHips, 3}) {
      s.bodies.own()[b].X_WB.p = {0, std::clamp(s.time - 0.5, 0.0, 1.0), 1};
      s.bodies.own()[b].V_WB.v = {0, moves ? 1.0 : 0.0, 0};
    }
    run.snapshots.push_back(s);
  }
  run.snapshots[26].contacts.push_back(push(kCar, 3, kVehicles, {0, -5, 0}));
  run.snapshots[26].contacts.back().begun = 0.5;
  run.events = {{1.1, "ground_contact", kHips, -1, Vec3::Zero(), 0}, {1.5, "rest", kHips, -1, Vec3::Zero(), 0}};
  for (std::size_t i = 56; i <= 75; ++i) run.snapshots[i].contacts.push_back(push(kHips, -1, kOnGround, {0, 0, 5}));
  std::vector<Metric> out;
  measure_throw(model, run, 0, out);
  const auto of_rider = [&](const std::string& key) {
    for (const Metric& m : out)
      if (m.key == key && m.object == "pedestrian") return m.value;
    return std::nan("");
  };
  EXPECT_NEAR(of_rider("airborne_m"), 0.6, 1e-9) << "nothing touches it until it lands";
  EXPECT_NEAR(of_rider("slide_m"), 0.4, 1e-9);
  EXPECT_NEAR(of_rider("throw_distance_m"), 1.0, 1e-9);
  EXPECT_TRUE(std::isnan(of_rider("contact_m")) && std::isnan(of_rider("carried_m")));
  for (const int part : {kHead, kHips}) {  // hands and seat
    Joint joint;
    joint.parent = kMount;
    joint.child = part;
    model.joints.push_back(joint);
  }
  run.events.insert(run.events.begin(),
                    {{0.6, "joint_broken", kHips, kMount, Vec3::Zero(), 0}, {0.9, "joint_broken", kHead, kMount, Vec3::Zero(), 0}});
  EXPECT_EQ(throw_of_person(model, run, 0)->separated, 0.9) << "the last that lets go";
  EXPECT_TRUE(throw_of_person(model, run, 0)->flew);
  run.events.erase(run.events.begin());
  EXPECT_EQ(throw_of_person(model, run, 0)->separated, 1.1) << "one holds until it is down";
  EXPECT_FALSE(throw_of_person(model, run, 0)->flew);
}

/// Lies on the road, is pushed by a car from 0.2 to 0.6 s, and slides on to rest at 1.4 s without having been off the ground: the
/// recorder tells no landing.
TEST(ThrowMetrics, WhoLayThereDoesNotLandAndSlidesFromTheLastPush) {
  Model model = person_and_car();
  model.persons[0].hips = kHips;
  Recording run;
  run.interval = 0.02;
  for (int i = 0; i <= 100; ++i) {  // 2 m/s while it is pushed, then 2.5 m/s^2
    Snapshot s = still(0.02 * i);
    const double pushed = std::clamp(s.time - 0.2, 0.0, 0.4), free = std::clamp(s.time - 0.6, 0.0, 0.8);
    for (const int b : {kHead, kHips}) {
      s.bodies.own()[b].X_WB.p = {2 * pushed + 2 * free - 1.25 * free * free, 0, 0.1};
      s.bodies.own()[b].V_WB.v = {pushed > 0 ? 2 - 2.5 * free : 0, 0, 0};
    }
    s.bodies.own()[kCar].V_WB.v = {3, 0, 0};
    if (i >= 10) s.contacts.push_back(push(kHips, -1, kOnGround, {0, 0, 8}));
    if (i >= 11 && i <= 30) s.contacts.push_back(push(kHips, kCar, kOnVehicle, {9, 0, 0}));
    run.snapshots.push_back(s);
  }
  run.events = {{0.2, "first_contact", kHips, kCar, Vec3::Zero(), 3}, {1.4, "rest", kHips, -1, Vec3::Zero(), 0}};
  std::vector<Metric> out;
  measure_throw(model, run, 0, out);
  EXPECT_FALSE(value_of(out, "landing_s") || value_of(out, "first_ground_contact_s") || value_of(out, "landing_m"));
  EXPECT_NEAR(value_of(out, "contact_m").value(), 0.8, kAlmost);
  EXPECT_NEAR(value_of(out, "slide_m").value(), 0.8, kAlmost);
  EXPECT_NEAR(value_of(out, "throw_distance_m").value(), 1.6, kAlmost);
  EXPECT_FALSE(throw_of_person(model, run, 0)->dragged) << "free from the last push on: friction follows from that slide";
  const auto reason = [&](const char* key) {
    for (const AbsentMetric& a : absent_metrics(model, run, out))
      if (a.key == key && a.object == "pedestrian") return a.reason;
    return std::string();
  };
  EXPECT_EQ(reason("landing_s"), "it lay on the ground when it was struck");
  EXPECT_EQ(reason("fall_m"), "it lay on the ground when it was struck");
}

/// Struck upright and thrown: what lies later did not lie then, whether the recorder has told a landing or not.
TEST(ThrowMetrics, WhoIsStruckUprightIsNotSaidToHaveLain) {
  Model model = person_and_car();
  model.persons[0].hips = kHips;
  Recording run = struck_along_y();  // on the ground from 4 s on
  std::erase_if(run.events, [](const Event& e) { return e.kind == "ground_contact"; });
  const auto thrown = throw_of_person(model, run, 0);
  ASSERT_TRUE(thrown);
  EXPECT_FALSE(thrown->lay);
  for (const ThrowPhase& phase : thrown->phases) EXPECT_STRNE(phase.name, "slide") << "a flight is none";
}

/// A pavement of either shape: who comes down on it lands, as on the road, and it strikes nobody.
TEST(ThrowMetrics, TheRecorderTellsALandingOnWhatIsFixedWhateverItsShape) {
  HyperEllipsoid slab, ball;
  slab.semi_axes = {5, 5, 0.5};
  slab.exponent = 60;
  ball.semi_axes = {0.1, 0.1, 0.1};
  for (const Shape& pavement : {Shape(slab), Shape(MeshShape{box({-5, -5, -0.5}, {5, 5, 0.5}), Pose{}})}) {
    Model model = person_and_car();
    model.ground.plane = false;
    model.settings.contact_law = ContactLaw::persons_yield;
    model.settings.duration = 0.3;
    model.vehicles.clear();
    model.bodies[kCar].vehicle = -1;
    model.bodies[kCar].fixed = true;
    model.bodies[kCar].shape = pavement;
    model.bodies[kCar].X_WB.p = {0, 0, -0.5};
    for (const int b : {kHead, kHips}) model.bodies[b].shape = ball;
    model.bodies[kHips].X_WB.p = {0, 0, 0.2};  // falls by 0.1 m
    model.bodies[kHead].X_WB.p = {1, 0, 5};
    model.persons[0].hips = kHips;
    model.persons[0].zero_condition = false;
    const Recording run = simulate(model);
    const auto landing =
        std::find_if(run.events.begin(), run.events.end(), [](const Event& e) { return e.kind == "ground_contact"; });
    ASSERT_NE(landing, run.events.end()) << pavement.index();
    EXPECT_EQ(landing->body_a, kHips);
    EXPECT_EQ(landing->body_b, kCar);
    EXPECT_NEAR(landing->time, std::sqrt(2 * 0.1 / 9.81), 2e-3);
    EXPECT_TRUE(std::none_of(run.events.begin(), run.events.end(), [](const Event& e) { return e.kind == "first_contact"; }));
  }
}

/// The car lets go at 2 s; its door, hinged to it, pushes at 3 s once more.
TEST(ThrowMetrics, WhatHangsOnAVehiclePushesAsTheVehicleDoes) {
  constexpr int kDoor = 3;
  Model model = person_and_car();
  model.bodies.emplace_back().shape = HyperEllipsoid{};
  Recording run = struck_along_y();
  for (Snapshot& s : run.snapshots) s.bodies.own().emplace_back();
  run.snapshots[3].contacts = {push(kDoor, kHips, ShapePair{ShapeKind::round, ShapeKind::round}, {0, -10, 0})};
  EXPECT_EQ(throw_of_person(model, run, 0)->separated, 2.0) << "what stands about is no vehicle";
  Joint hinge;
  hinge.parent = kCar;
  hinge.child = kDoor;
  model.joints = {hinge};
  EXPECT_EQ(throw_of_person(model, run, 0)->separated, 3.0);
  run.events.push_back({2.5, "joint_broken", kDoor, kCar, Vec3::Zero(), 0});
  EXPECT_EQ(throw_of_person(model, run, 0)->separated, 2.0);
}

TEST(ThrowMetrics, WhoIsRunOverIsToldByTheFirstWheelThatStandsOnIt) {
  Model model = person_and_car();
  model.bodies[kHips].name = "pedestrian/hips";
  model.bodies[kCar].name = "car";
  Recording run = struck_along_y();
  std::vector<Metric> out;
  measure_throw(model, run, 0, out);
  EXPECT_FALSE(value_of(out, "run_over_s"));
  const auto why_not = [&] {
    for (const AbsentMetric& absent : absent_metrics(model, run, out))
      if (absent.key == "run_over_s") return absent.reason;
    return std::string();
  };
  EXPECT_EQ(why_not(), "");
  run.snapshots[5].contacts.push_back(push(kHips, kCar, ShapePair{ShapeKind::round, ShapeKind::tyre}, {0, 10, 0}));
  EXPECT_EQ(why_not(), "a wheel touched it, and did not stand on it");
  run.events.push_back({5, "run_over", kHips, kCar, Vec3::Zero(), 0});
  run.events.push_back({5.5, "run_over", kHips, kCar, Vec3::Zero(), 0});
  out.clear();
  measure_throw(model, run, 0, out);
  EXPECT_EQ(value_of(out, "run_over_s"), 5.0);
  const auto part = std::find_if(out.begin(), out.end(), [](const Metric& m) { return m.key == "run_over_part"; });
  ASSERT_NE(part, out.end());
  EXPECT_EQ(part->text, "hips by car");
}

TEST(ThrowMetrics, RiderAndMountHaveEachTheirOwnRestAndThrow) {
  Model model = rider_and_car();
  Recording run = struck_along_y();
  for (std::size_t i = 0; i < run.snapshots.size(); ++i) {
    run.snapshots[i].bodies.own().emplace_back();
    run.snapshots[i].bodies.own()[3].X_WB.p = {0, std::min(4.0, 1.0 * static_cast<double>(i)), 0.5};
  }
  ContactRecord hit = push(kCar, 3, kVehicles, {0, -5, 0});
  hit.begun = 0.5;  // the mount is struck before the rider
  run.snapshots[1].contacts.push_back(hit);
  run.events.push_back({2, "rest", 3, -1, Vec3::Zero(), 0});
  std::vector<Metric> out;
  measure_throw(model, run, 0, out);
  const auto of = [&](const char* key, const std::string& object) {
    for (const Metric& m : out)
      if (m.key == key && m.object == object) return m.value;
    return std::nan("");
  };
  EXPECT_EQ(of("rest_s", "pedestrian"), 6.0);
  EXPECT_EQ(of("rest_s", "bicycle"), 2.0);
  EXPECT_NEAR(of("throw_distance_m", "bicycle"), 1.5, kAlmost) << "from the touch at 0.5 s to its own rest";
  // the rider's centre was at (0.125, 0) when the mount was struck
  EXPECT_NEAR(of("throw_distance_m", "pedestrian"), std::hypot(1.375, 16), kAlmost);
}

}  // namespace
}  // namespace engine
