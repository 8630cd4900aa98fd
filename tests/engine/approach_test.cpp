// How near two came that did not touch.
#include "engine/measure/approach.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "tests/engine/hand_made_runs.h"

namespace engine {
namespace {

TEST(NearestApproach, ARunWithoutATouchSaysHowNearItWas) {
  Model model = person_and_car();
  HyperEllipsoid ball;
  ball.semi_axes = {0.1, 0.1, 0.1};
  ball.exponent = 2;
  for (const int b : {kHead, kHips}) model.bodies[b].shape = ball;
  Recording run;
  run.interval = 0.1;
  for (int i = 0; i < 11; ++i) {
    Snapshot s = still(0.1 * i);
    s.bodies.own()[kCar].X_WB.p = {1.0 * i, 0, 0.5};
    s.bodies.own()[kHead].X_WB.p = {7, 1.4, 0.6};
    s.bodies.own()[kHips].X_WB.p = {7, 3, 0.6};
    run.snapshots.push_back(s);
  }
  const auto near = nearest_approach(model, run);
  ASSERT_TRUE(near);
  EXPECT_NEAR(near->distance, 1.4 - 0.8 - 0.1, 1e-9);
  EXPECT_EQ(near->body_a, kHead);
  Recording stands = run;  // and hums
  for (Snapshot& s : stands.snapshots) s.bodies.own()[kCar].X_WB.p = {5 + 1e-10 * s.time, 0, 0.5};
  EXPECT_EQ(nearest_approach(model, stands)->time, 0) << "the first of many instants";
  model.bodies.emplace_back();  // a wall that the car runs into is none of those it passes
  model.bodies[3].fixed = true;
  for (Snapshot& s : run.snapshots) s.bodies.own().emplace_back();
  run.snapshots[2].contacts = {push(kCar, 3, kVehicles, {1, 0, 0})};
  ASSERT_TRUE(nearest_approach(model, run));
  EXPECT_NEAR(nearest_approach(model, run)->distance, 1.4 - 0.8 - 0.1, 1e-9);
  run.snapshots[3].contacts = {push(kHips, kCar, kOnVehicle, {1, 0, 0})};
  EXPECT_FALSE(nearest_approach(model, run)) << "they touched";
}

TEST(NearestApproach, IsNotThatOfATrailerToWhatTowsIt) {
  Model model = person_and_car();
  model.persons.clear();
  model.bodies.resize(3);
  Recording run;
  run.interval = 0.1;
  run.snapshots = {still(0), still(0.1)};
  for (int k = 1; k < 4; ++k) {  // dolly and trailer behind the car, another car far off
    model.bodies.push_back(model.bodies[kCar]);
    model.bodies.back().vehicle = k;
    model.vehicles.push_back(model.vehicles[0]);
    model.vehicles.back().body = kCar + k;
    for (Snapshot& s : run.snapshots) {
      s.bodies.own().push_back(s.bodies[kCar]);
      s.bodies.own().back().X_WB.p.x() = k < 3 ? -5.0 * k : 50;
    }
  }
  for (const int towed : {kCar + 1, kCar + 2}) {
    Joint hitch;
    hitch.parent = towed - 1;
    hitch.child = towed;
    model.joints.push_back(hitch);
  }
  const auto near = nearest_approach(model, run);
  ASSERT_TRUE(near);
  EXPECT_NEAR(near->distance, 50 - 4, 1e-9) << "of the car and the other one, each 4 m long";
}

}  // namespace
}  // namespace engine
