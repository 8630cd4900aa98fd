// Parts of persons that got faster than blows make them.
#include "engine/measure/flung.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/engine/hand_made_runs.h"

namespace {

using namespace engine;
using namespace engine::test;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A car at 10 m/s: a hip at 29 m/s may be, one at 31 is told.
TEST(FlungParts, AreToldBeyondWhatABlowGives) {
  const Model model = person_and_car();
  for (const double speed : {29.0, 31.0}) {
    Recording run = standing_still(10);
    for (Snapshot& s : run.snapshots) s.bodies.own()[kCar].V_WB.v = {10, 0, 0};
    run.snapshots[7].bodies.own()[kHips].V_WB.v = {0, speed, 0};
    run.snapshots[6].contacts = {push(kHips, kCar, kOnVehicle, {5, 0, 0})};
    const std::vector<std::string> told = flung_parts(model, run);
    if (speed < 30)
      EXPECT_THAT(told, IsEmpty());
    else
      EXPECT_THAT(told, ElementsAre(HasSubstr("had 31.0 m/s at 70 ms, where no vehicle was faster than 10.0 m/s")));
  }
}

/// Who runs, or falls, beside a vehicle.
TEST(FlungParts, AreNotLookedForBeforeAVehicleTouches) {
  Recording run = standing_still(10);
  run.snapshots[7].bodies.own()[kHips].V_WB.v = {0, 50, 0};
  EXPECT_THAT(flung_parts(person_and_car(), run), IsEmpty());
}

}  // namespace
