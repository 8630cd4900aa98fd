// What a run shows where a mark was seen, against marks and runs made by hand.
#include <gtest/gtest.h>

#include <cmath>

#include "cli/inference/observe.h"

namespace cli::inference {
namespace {

using engine::Vec3;

/// A car with a wheel to each side, 1.4 m apart, slides 10 m along x on both.
struct Slide {
  engine::Model model;
  engine::Recording recording;

  explicit Slide(double slip_of_right = 5) {
    model.bodies.resize(1);
    model.bodies[0].name = "car";
    model.bodies[0].vehicle = 0;
    engine::Vehicle car;
    car.name = "car";
    car.body = 0;
    car.wheels.resize(2);
    car.wheels[0].hub_B = {0, 0.7, 0};
    car.wheels[1].hub_B = {0, -0.7, 0};
    model.vehicles = {car};
    for (int i = 0; i <= 100; ++i) {
      engine::Snapshot s;
      s.time = 0.01 * i;
      s.bodies.own().resize(1);
      for (int w = 0; w < 2; ++w) {
        engine::WheelRecord wheel;
        wheel.wheel = w;
        wheel.contact = {0.1 * i, w == 0 ? 0.7 : -0.7, 0};
        wheel.slip = w == 0 ? 5 : slip_of_right;
        s.wheels.push_back(wheel);
      }
      recording.snapshots.push_back(s);
    }
  }

  double off(const std::vector<Vec3>& mark) const {
    scenes::Evidence e;
    e.seen = scenes::Seen::mark;
    e.of = "car";
    e.mark = mark;
    return observe(e, model, recording, {}).value().front();
  }
};

TEST(MeasureAsEvidence, ADirectionIsSeenAWholeTurnFarther) {
  scenes::Evidence e;
  e.seen = scenes::Seen::metric;
  e.metric = "pdof_deg";
  e.value = {180};
  e.tolerance = 5;
  engine::Metric pdof;
  pdof.key = e.metric;
  pdof.value = -179;
  const auto predicted = observe(e, {}, {}, {pdof});
  EXPECT_NEAR(predicted.value().front(), 181, 1e-9);
  EXPECT_NEAR(misfit(e, predicted), 0.2, 1e-9);
}

TEST(MarkAsEvidence, OfOneSideIsHeldAgainstTheWheelsOfThatSide) {
  const Slide slide;
  EXPECT_NEAR(slide.off({{0, 0.7, 0}, {10, 0.7, 0}}), 0, 1e-9);
  EXPECT_NEAR(slide.off({{0, -0.7, 0}, {10, -0.7, 0}}), 0, 1e-9);
  EXPECT_NEAR(slide.off({{0, 0.9, 0}, {10, 0.9, 0}}), 0.2, 1e-9);
}

TEST(MarkAsEvidence, CountsWhatTheRunMarksAndNobodySaw) {
  // half the track is 5 m shorter: the mean square of 0 to 5 m in steps of 0.1 m over its half
  const Slide slide;
  double unseen = 0;
  for (int i = 1; i <= 50; ++i) unseen += 0.01 * i * i;
  EXPECT_NEAR(slide.off({{0, 0.7, 0}, {5, 0.7, 0}}), std::sqrt(0.5 * unseen / 101), 1e-9);
}

TEST(MarkAsEvidence, OfBothSidesIsHeldAgainstAll) {
  // down one side and back along the other: nearer to both than to either; the 14 points across lie up to 0.7 m off
  const Slide slide;
  const double both = slide.off({{0, 0.7, 0}, {10, 0.7, 0}, {10, -0.7, 0}, {0, -0.7, 0}});
  EXPECT_GT(both, 0);
  EXPECT_LT(both, 0.15);
}

TEST(MarkAsEvidence, AWheelThatRollsMarksNothing) {
  const Slide slide(0.1);
  EXPECT_NEAR(slide.off({{0, -0.7, 0}, {10, -0.7, 0}}), 1.4, 1e-9);
}

}  // namespace
}  // namespace cli::inference
