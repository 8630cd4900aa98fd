// Measures of persons against what the trajectory itself shows, read off here by other means than the measures' own.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "engine/geometry/hyper_ellipsoid.h"
#include "engine/measure/metrics.h"
#include "engine/measure/phases.h"
#include "engine/simulate.h"
#include "scenes/scene.h"

namespace {

using namespace engine;

struct Struck {
  const char* name;
  const char* scene;
  std::vector<std::string> overrides;
};

void PrintTo(const Struck& struck, std::ostream* out) {
  *out << struck.name;
}

const std::vector<std::string> kChild = {"person.pedestrian.figure=child-6", "person.pedestrian.stature=1.14 m",
                                         "person.pedestrian.mass=23.4 kg"};

std::vector<std::string> child_and(std::vector<std::string> more) {
  more.insert(more.end(), kChild.begin(), kChild.end());
  return more;
}

const Struck kCases[] = {
    {"adult", "sedan_pedestrian_40kmh", {}},
    {"child", "sedan_pedestrian_40kmh", kChild},
    {"standing", "sedan_pedestrian_40kmh", {"person.pedestrian.pose=standing"}},
    {"other_leg", "sedan_pedestrian_40kmh", {"person.pedestrian.pose=walking_left"}},
    {"rider", "cyclist", {}},
    {"carried", "sedan_pedestrian_40kmh", {"vehicle.sedan.brake.deceleration=0.1 g", "simulation.duration=3 s"}},
    {"pushed_along",
     "sedan_pedestrian_40kmh",
     {"vehicle.sedan.model=bus", "vehicle.sedan.brake.deceleration=0.1 g", "simulation.duration=3 s"}},
    {"run_over", "sedan_pedestrian_40kmh",
     child_and({"vehicle.sedan.model=bus", "vehicle.sedan.speed=90 km/h", "vehicle.sedan.front=-2.5 -1.75 m"})},
};

class Measured : public testing::TestWithParam<Struck> {
 protected:
  void SetUp() override {
    scene_ = scenes::load(std::string(CRASHREEL_SOURCE_DIR) + "/scenes/cases/" + GetParam().scene + ".toml", GetParam().overrides);
    run_ = simulate(scene_.model);
    metrics_ = measure(scene_.model, run_);
    ASSERT_FALSE(run_.failure);
    for (const Snapshot& s : run_.snapshots)
      if (!hit_ && touched(s, [&](int body) { return is_part(body) || body == person().mount; })) hit_ = s.time;
    ASSERT_TRUE(hit_);
  }

  const Person& person() const { return scene_.model.persons[0]; }
  bool is_part(int body) const { return std::find(person().bodies.begin(), person().bodies.end(), body) != person().bodies.end(); }

  /// Does a vehicle press on a body that `counts`?
  template <class Counts>
  bool touched(const Snapshot& s, const Counts& counts) const {
    return std::any_of(s.contacts.begin(), s.contacts.end(), [&](const ContactRecord& c) {
      const bool vehicle = c.kind == ContactKind::vehicle || c.kind == ContactKind::vehicle_pair;
      return vehicle && c.normal_impulse > 0 && (counts(c.body_a) || counts(c.body_b));
    });
  }

  std::optional<double> value(const std::string& key) const {
    for (const Metric& m : metrics_)
      if (m.key == key && m.object == person().name) return m.value;
    return std::nullopt;
  }

  Vec3 centre(const Snapshot& s) const {
    Vec3 sum = Vec3::Zero();
    double mass = 0;
    for (const int b : person().bodies)
      sum += scene_.model.bodies[b].mass * s.bodies[b].X_WB.p, mass += scene_.model.bodies[b].mass;
    return sum / mass;
  }

  double lowest(const Snapshot& s, int b) const {
    const Pose& X = s.bodies[b].X_WB;
    return X.p.z() - support_value(std::get<HyperEllipsoid>(scene_.model.bodies[b].shape), X.q.conjugate() * -Vec3::UnitZ());
  }

  static constexpr double kInterval = 5e-3;  // [s] between snapshots
  scenes::Scene scene_;
  Recording run_;
  std::vector<Metric> metrics_;
  std::optional<double> hit_;  // [s] first snapshot that has a touch
};

INSTANTIATE_TEST_SUITE_P(Persons, Measured, testing::ValuesIn(kCases), [](const auto& p) { return std::string(p.param.name); });

TEST_P(Measured, ThrowIsTheWayOfTheCentreFromTheTouchToTheEnd) {
  const Vec3 way = centre(run_.snapshots.back()) - centre(run_.at(*hit_));
  // the touch lies within the interval before its snapshot, in which a person walks or rides 2.5 cm at most
  EXPECT_NEAR(value("throw_distance_m").value(), way.head<2>().norm(), 0.03);
}

TEST_P(Measured, HeadStrikesWhenItsContactBegins) {
  std::optional<double> first;
  for (const Snapshot& s : run_.snapshots)
    if (!first && touched(s, [&](int body) { return body == person().head; })) first = s.time;
  const auto told = value("head_impact_s");
  ASSERT_EQ(told.has_value(), first.has_value());
  if (told) {
    EXPECT_NEAR(*told, *first - 0.5 * kInterval, 0.5 * kInterval + 2e-3);
  }
}

TEST_P(Measured, LandsWhenTheTrunkReachesTheGround) {
  std::optional<double> first;
  for (const Snapshot& s : run_.snapshots)
    for (const int b : trunk_of(scene_.model, 0))
      if (!first && s.time > *hit_ && lowest(s, b) < 0) first = s.time;
  const auto told = value("landing_s");
  ASSERT_EQ(told.has_value(), first.has_value());
  if (told) {
    EXPECT_NEAR(*told, *first - 0.5 * kInterval, 0.5 * kInterval + 2e-3);
  }
}

TEST_P(Measured, PhasesFollowEachOtherAndSumToTheThrow) {
  const auto thrown = throw_of_person(scene_.model, run_, 0);
  ASSERT_TRUE(thrown && !thrown->phases.empty());
  double sum = 0;
  for (std::size_t i = 0; i < thrown->phases.size(); ++i) {
    sum += thrown->phases[i].distance;
    if (i > 0) {
      EXPECT_NEAR(thrown->phases[i].from, thrown->phases[i - 1].to, 1e-12) << thrown->phases[i].name;
    }
  }
  EXPECT_NEAR(sum, value("throw_distance_m").value(), 1e-6);
  EXPECT_NEAR(thrown->phases.front().from, *hit_ - 0.5 * kInterval, 0.5 * kInterval + 2e-3);
}

TEST_P(Measured, NothingMovesAfterRest) {
  const auto rest = value("rest_s");
  if (!rest) return;
  for (const Snapshot& s : run_.snapshots) {
    if (s.time <= *rest + kInterval) continue;
    for (const int b : person().bodies) EXPECT_LT(s.bodies[b].V_WB.v.norm(), 0.06) << scene_.model.bodies[b].name << " " << s.time;
  }
}

}  // namespace
