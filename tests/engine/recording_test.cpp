// What a recording shows between its snapshots, and at them.
#include "engine/recording.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace engine {
namespace {

TEST(RecordingAt, ATimeARoundingBesideASnapshotShowsThatOne) {
  Recording run;
  run.interval = 0.1;
  for (int i = 0; i <= 3; ++i) {
    Snapshot s;
    s.time = 0.1 * i;
    s.bodies.resize(1);
    s.bodies[0].X_WB.p = {s.time, 0, 0};
    s.bodies[0].V_WB.v = {1, 0, 0};
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

}  // namespace
}  // namespace engine
