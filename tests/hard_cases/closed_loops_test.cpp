// Joints that close loops: a mechanism through its singular position, hands that never let go, the same joint twice.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/hard_cases/hard_case.h"

namespace hard_cases {
namespace {

using engine::Vec3;

/// Top of the first vertical link.
Vec3 tip(const Outcome& it) {
  return it.last(0).X_WB * Vec3(0, 0, 0.5);
}

/// What the run cannot explain, at most, as a share of the energy at its start.
double unexplained(const Outcome& it) {
  double most = 0;
  for (const engine::Snapshot& s : it.recording.snapshots) most = std::max(most, std::abs(s.energies.residual));
  return most / std::abs(energy(it.recording.snapshots.front()));
}

Outcome four_bar(const char* step, const char* scheme) {
  return run("four_bar", {step, scheme});
}

class FourBar : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Schemes, FourBar, testing::Values("stepping", "rk4"));

TEST_P(FourBar, PassesItsStretchedPositionAndArrivesWherePublished) {
  // IFToMM benchmark A02, N = 2: ten seconds, some ten times through the position in which all links lie on a line
  const Outcome it = four_bar("1 ms", GetParam());
  const double off = (tip(it) - Vec3(0.3285, 0, 0.9445)).norm();
  row("four-bar through its line", it, "tip %.1e m off, %.1e of the energy unexplained, drift %.1e m", off, unexplained(it),
      it.diagnostics().max_joint_gap);
  EXPECT_LT(off, 1e-3);
  EXPECT_LT(unexplained(it), 1e-6);
  EXPECT_LT(it.diagnostics().max_joint_gap, 1e-9);
}

TEST_P(FourBar, ConvergesWithOrderTwoOrBetter) {
  const Vec3 best = tip(four_bar("0.5 ms", GetParam()));
  const double coarse = (tip(four_bar("4 ms", GetParam())) - best).norm();
  const double fine = (tip(four_bar("2 ms", GetParam())) - best).norm();
  // one of its steps ends so near the line that the loops answer by less than the proximal term: that costs digits, not the way
  const double near = (tip(four_bar("0.25 ms", GetParam())) - best).norm();
  row("four-bar, order", std::string("4 and 2 ms ") + GetParam(), "%.2f (%.1e and %.1e m from 0.5 ms; 0.25 ms is %.1e m off)",
      std::log2(coarse / fine), coarse, fine, near);
  EXPECT_GT(coarse / fine, 4);
  EXPECT_LT(near, 1e-5);
}

class Loops : public testing::TestWithParam<Setting> {};
INSTANTIATE_TEST_SUITE_P(At, Loops, testing::ValuesIn(kSettings));

TEST_P(Loops, HandsThatNeverLetGoGiveNoEnergy) {
  const Outcome it =
      run("scenes/cases/cyclist", GetParam(),
          {"person.rider.grip_force=1000 kN", "person.rider.pedal_force=1000 kN", "person.rider.seat_force=1000 kN"});
  const double given = rises(it.recording).largest;
  row("cyclist who never lets go", it, "most energy given in 5 ms %.2f J, unexplained %.2f J of %.0f kJ, drift %.1e m", given,
      it.recording.snapshots.back().energies.residual, 1e-3 * energy(it.recording.snapshots.front()),
      it.diagnostics().max_joint_gap);
  EXPECT_LT(std::abs(it.recording.snapshots.back().energies.residual), 1e-3 * energy(it.recording.snapshots.front()));
  EXPECT_LT(it.diagnostics().max_joint_gap, 1e-9);
}

TEST_P(Loops, TheSameJointTwiceIsTheSameAsOnce) {
  const auto twice = [](engine::Model& model) {
    const std::vector<engine::Joint> once = model.joints;
    model.joints.insert(model.joints.end(), once.begin(), once.end());
  };
  const Outcome one = run("scenes/gallery/babyboot", GetParam(), {"simulation.duration=2 s"});
  const Outcome two = run("scenes/gallery/babyboot", GetParam(), {"simulation.duration=2 s"}, twice);
  double apart = 0;
  for (int b = 0; b < static_cast<int>(one.model.bodies.size()); ++b)
    apart = std::max(apart, (one.last(b).X_WB.p - two.last(b).X_WB.p).norm());
  row("every joint twice", two, "%.1e m from once, %.1e of the energy unexplained", apart, unexplained(two));
  EXPECT_LT(apart, 1e-8);
}

}  // namespace
}  // namespace hard_cases
