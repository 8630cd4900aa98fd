// What is measured of free bodies, why a measure is absent, and that every measure is defined once.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "engine/measure/definitions.h"
#include "engine/measure/phases.h"
#include "tests/engine/hand_made_runs.h"

namespace engine {
namespace {

TEST(BodyMetrics, ReboundIsTheTopOfTheFlightBetweenTwoTouches) {
  Model model;
  model.bodies.resize(1);
  model.bodies[0].name = "ball";
  HyperEllipsoid ball;
  model.bodies[0].shape = ball;
  const double radius = aabb_half_widths(ball, Quat::Identity()).z();
  Recording run;
  // off the ground at 0.1 s with 2 m/s; the top, 2^2/(2 g) above, lies between two recorded instants
  for (int i = 0; i < 7; ++i) {
    Snapshot s;
    s.time = 0.1 * i;
    s.bodies.own().resize(1);
    const double t = s.time - 0.1;
    s.bodies.own()[0].X_WB.p = {3.0 * i, 4.0 * i, radius + (i ? 2 * t - 0.5 * 9.81 * t * t : 0.3)};
    s.bodies.own()[0].V_WB.v = {30, 40, i ? 2 - 9.81 * t : -3};
    run.snapshots.push_back(s);
  }
  for (const int i : {1, 6}) run.snapshots[i].contacts.push_back(push(0, -1, kOnGround, {0, 0, 5}));
  std::vector<Metric> out;
  measure_body(model, run, 0, out);
  // the top is a flat maximum: searched to 1e-9 s it is right to rounding
  EXPECT_NEAR(value_of(out, "rebound_height_m").value(), 2.0 * 2.0 / (2 * 9.81), kAlmost);
  EXPECT_NEAR(value_of(out, "travel_m").value(), 30, kAlmost);
  EXPECT_NEAR(value_of(out, "turned_deg").value(), 0, 1e-6);
}

TEST(AbsentMetrics, WhoStandsIsNotSaidToMove) {
  const Model model = person_and_car();
  Recording run;
  run.interval = 1;
  run.snapshots = {still(0), still(1)};
  const auto reason = [&] {
    for (const AbsentMetric& a : absent_metrics(model, run, {}))
      if (a.key == "rest_s" && a.object == "pedestrian") return a.reason;
    return std::string();
  };
  EXPECT_EQ(reason(), "nothing touched it: it stands as it stood");
  run.snapshots[1].bodies.own()[kHips].V_WB.v = {1, 0, 0};
  EXPECT_EQ(reason(), "still moving when the run ends");
}

TEST(Definitions, ADirectionIsTheSameAWholeTurnFarther) {
  EXPECT_NEAR(turned_to("pdof_deg", -179.5, 180), 180.5, 1e-12);
  EXPECT_NEAR(turned_to("pdof_deg car", 179, -170), -181, 1e-12);
  EXPECT_NEAR(turned_to("rest_heading_deg", 0.1, 360), 360.1, 1e-12);
  EXPECT_EQ(turned_to("turned_deg", 10, 360), 10) << "no direction";
  EXPECT_EQ(turned_to("throw_distance_m", 500, 0), 500);
}

TEST(Definitions, EveryMeasureIsDefinedOnceWithItsUnitInItsName) {
  std::set<std::string> keys;
  for (const Definition& d : definitions()) {
    EXPECT_TRUE(keys.insert(d.key).second) << d.key;
    for (const char* text : {d.title, d.definition, d.absent, d.sureness}) EXPECT_GT(std::string(text).size(), 0u) << d.key;
    const std::map<std::string, std::string> endings{{"m", "_m"}, {"s", "_s"}, {"m/s", "_mps"}, {"deg", "_deg"}, {"g", "_g"}};
    if (const auto ending = endings.find(d.unit); ending != endings.end()) {
      EXPECT_TRUE(std::string(d.key).ends_with(ending->second)) << d.key;
    }
  }
  const Model model = person_and_car();
  for (const Recording& run : {struck_along_y(), head_on_bonnet()}) {
    const std::vector<Metric> metrics = measure(model, run);
    for (const Metric& m : metrics) EXPECT_TRUE(definition_of(m.key)) << m.key;
    for (const AbsentMetric& a : absent_metrics(model, run, metrics)) {
      EXPECT_TRUE(definition_of(a.key)) << a.key;
      EXPECT_TRUE(
          std::none_of(metrics.begin(), metrics.end(), [&](const Metric& m) { return m.key == a.key && m.object == a.object; }))
          << a.key << ": either a figure or a reason";
    }
  }
}

}  // namespace
}  // namespace engine
