// What a recording shows between its snapshots, and at them.
#include "engine/recording.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "engine/simulate.h"
#include "tests/engine/experiment.h"

namespace engine {
namespace {

using test::ball;

/// A share of the duration as `study` writes its steps, to twelve digits.
TEST(Simulate, AStepToldToTwelveDigitsIsNotTakenOnceMore) {
  for (const long parts : {7L, 91L, 7280L, 14560L}) {
    Model model = test::on_ground(1.3, std::round(1.3 / static_cast<double>(parts) * 1e15) * 1e-15);
    model.bodies = {ball(0.1, 1, {0, 0, 5})};
    EXPECT_EQ(simulate(model).steps, parts);
  }
}

TEST(RecordingAt, ATimeARoundingBesideASnapshotShowsThatOne) {
  Recording run;
  run.interval = 0.1;
  for (int i = 0; i <= 3; ++i) {
    Snapshot s;
    s.time = 0.1 * i;
    s.bodies.own().resize(1);
    s.bodies.own()[0].X_WB.p = {s.time, 0, 0};
    s.bodies.own()[0].V_WB.v = {1, 0, 0};
    s.contacts.resize(static_cast<std::size_t>(i));  // as many as its number
    run.snapshots.push_back(s);
  }
  constexpr double kNever = std::numeric_limits<double>::infinity();
  for (const double time : {0.2, std::nextafter(0.2, kNever), std::nextafter(0.2, -kNever), 0.2 + 1e-12}) {
    EXPECT_EQ(run.at(time).contacts.size(), 2u) << time - 0.2;
    EXPECT_NEAR(run.at(time).bodies[0].X_WB.p.x(), 0.2, 2e-12) << time - 0.2;
  }
  // what lies between two shows the contacts of the later
  EXPECT_EQ(run.at(0.2001).contacts.size(), 3u);
  EXPECT_NEAR(run.at(0.2001).bodies[0].X_WB.p.x(), 0.2001, 1e-12);
}

/// Between two snapshots it has one speed or the other: half way between stood in captions of films, as what nobody had.
TEST(RecordingAt, ABlowIsNotSpreadOverTheInterval) {
  Recording run;
  run.interval = 0.005;
  for (int i = 0; i <= 1; ++i) {
    Snapshot s;
    s.time = 0.005 * i;
    s.bodies.own().resize(2);
    s.bodies.own()[0].V_WB.v = {i == 0 ? 14.0 : 11.0, 0, 0};  // struck
    s.bodies.own()[1].V_WB.v = {i == 0 ? 14.0 : 13.9, 0, 0};  // braked
    run.snapshots.push_back(s);
  }
  EXPECT_NEAR(run.at(0.0025).bodies[0].V_WB.v.x(), 12.5, 1e-12) << "pulled at a joint, or pressed for a while";
  ContactRecord c;
  c.body_a = 0;
  c.begun = 0.003;
  c.state = ContactState::impact;
  run.snapshots[1].contacts = {c};
  EXPECT_EQ(run.at(0.0029).bodies[0].V_WB.v.x(), 14);
  EXPECT_EQ(run.at(0.0031).bodies[0].V_WB.v.x(), 11);
  EXPECT_NEAR(run.at(0.0025).bodies[1].V_WB.v.x(), 13.95, 1e-12);
}

/// A ball comes along y and strikes the head of somebody who waits, at 40 ms; somebody else waits on, one body is fixed.
Recording somebody_struck(const Vec3& place, bool waiting) {
  Model model;
  model.ground.plane = false;
  model.settings.contact_law = ContactLaw::persons_yield;
  model.settings.record_interval = 5e-3;
  model.settings.duration = 0.1;
  model.settings.stop_at_rest = false;
  model.bodies = {ball(0.1, 5, place), ball(0.1, 4.5, place + Vec3(0, 0.6, 0)), ball(0.1, 70, place + Vec3(0, 3, -1)), Body{}};
  model.bodies[0].V_WB.v = {0, 10, 0};
  model.bodies[1].surface.stiffness = 1e6;
  model.bodies[3].fixed = true;
  model.bodies[3].X_WB.p = place + Vec3(1, 2, 3);
  for (const int p : {0, 1}) {
    Person person;
    person.name = "p" + std::to_string(p);
    person.bodies = {1 + p};
    person.head = 1 + p;
    person.zero_condition = waiting;
    model.bodies[static_cast<std::size_t>(1 + p)].person = p;
    model.persons.push_back(person);
  }
  return simulate(model);
}

bool same(const BodyState& a, const BodyState& b) {
  return a.X_WB.p == b.X_WB.p && a.X_WB.q.coeffs() == b.X_WB.q.coeffs() && a.V_WB.v == b.V_WB.v && a.V_WB.w == b.V_WB.w;
}

TEST(RecordingOfWhoWaits, HasTheirPlaceAtEveryInstantUntilTheyAreStruck) {
  const Vec3 place(1e4 / 3, -20, 7);
  const Recording run = somebody_struck(place, true);
  ASSERT_EQ(run.snapshots.size(), 21u);
  double released = -1;
  for (const Event& event : run.events)
    if (event.kind == "release") released = event.time;
  EXPECT_NEAR(released, 0.04, 2e-3);  // the gap of 0.4 m at 10 m/s, to the step before and the fall's part of it
  for (const Snapshot& s : run.snapshots) {
    ASSERT_EQ(s.bodies.size(), 4u);
    for (const std::size_t b : {2, 3}) EXPECT_TRUE(same(s.bodies[b], run.snapshots[0].bodies[b])) << s.time;
    EXPECT_EQ(same(s.bodies[1], run.snapshots[0].bodies[1]), s.time <= released) << s.time;
    std::size_t next = 0;
    for (const BodyState& state : s.bodies) EXPECT_EQ(&state, &s.bodies[next++]);
  }
  // to the rounding of the run's own origin
  EXPECT_NEAR((run.snapshots[20].bodies[2].X_WB.p - (place + Vec3(0, 3, -1))).norm(), 0, 1e-8);
  EXPECT_NEAR((run.snapshots[20].bodies[3].X_WB.p - (place + Vec3(1, 2, 3))).norm(), 0, 1e-8);
}

TEST(RecordingOfWhoWaits, HasTheEnergiesOfAllBodiesToTheLastBit) {
  const Recording run = somebody_struck(Vec3::Zero(), true);
  const double mass[] = {5, 4.5, 70};
  for (const Snapshot& s : run.snapshots) {
    double kinetic = 0, potential = 0;
    for (std::size_t b = 0; b < 3; ++b) {
      const Body body = ball(0.1, mass[b], Vec3::Zero());
      const Vec3 w_B = s.bodies[b].X_WB.q.conjugate() * s.bodies[b].V_WB.w;
      kinetic += 0.5 * mass[b] * s.bodies[b].V_WB.v.squaredNorm() + 0.5 * w_B.dot(body.inertia_B * w_B);
      potential -= mass[b] * Settings{}.gravity.dot(s.bodies[b].X_WB.p);
    }
    EXPECT_EQ(s.energies.kinetic, kinetic) << s.time;
    EXPECT_EQ(s.energies.potential, potential) << s.time;
  }
}

TEST(RecordingOfWhoWaits, HasASampleOfTheirHeadsForEveryStep) {
  const Recording run = somebody_struck(Vec3::Zero(), true), awake = somebody_struck(Vec3::Zero(), false);
  for (const Recording* r : {&run, &awake}) {
    ASSERT_EQ(r->heads.size(), 2u);
    for (const HeadMotion& head : r->heads) {
      ASSERT_EQ(head.time.size(), head.acceleration.size());
      EXPECT_TRUE(std::is_sorted(head.time.begin(), head.time.end()));
      // and more while the one of them is struck, which is later by the fall of the ball where they wait
      for (int k = 0; k <= 100; ++k) EXPECT_TRUE(std::binary_search(head.time.begin(), head.time.end(), k * 1e-3)) << k;
    }
  }
  for (std::size_t p = 0; p < 2; ++p) {
    const HeadMotion& head = run.heads[p];
    for (std::size_t i = 0; i < head.time.size(); ++i) {
      const bool waits = p == 1 || head.time[i] < 0.038;
      EXPECT_TRUE(!waits || head.acceleration[i] == 0) << head.time[i];
    }
  }
  EXPECT_GT(*std::max_element(run.heads[0].acceleration.begin(), run.heads[0].acceleration.end()), 100);
}

TEST(RecordingOfWhoWaits, IsChangedAtOneInstantWithoutTheOthers) {
  Recording run = somebody_struck(Vec3::Zero(), true);
  const BodyState waiting = run.snapshots[2].bodies[1], striker = run.snapshots[1].bodies[0];
  run.snapshots[1].bodies.own()[1].X_WB.p.x() = 9;
  EXPECT_EQ(run.snapshots[1].bodies[1].X_WB.p.x(), 9);
  EXPECT_TRUE(same(run.snapshots[1].bodies[0], striker));
  EXPECT_TRUE(same(run.snapshots[2].bodies[1], waiting));
  // between two instants, held by one and shared by the other
  EXPECT_NEAR(run.at(0.5 * (run.snapshots[1].time + run.snapshots[2].time)).bodies[1].X_WB.p.x(), 4.5, 1e-12);
}

}  // namespace
}  // namespace engine
