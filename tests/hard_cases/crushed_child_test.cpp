// A child pressed between two cars that collide: limbs stand at dead centres between surfaces that close at metres a second, and
// their contacts yield (engine/solver/contact_solver.cpp). The books must know of it.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/hard_cases/hard_case.h"

namespace hard_cases {
namespace {

class CrushedChild : public testing::TestWithParam<Setting> {};
INSTANTIATE_TEST_SUITE_P(At, CrushedChild, testing::ValuesIn(kSettings));

TEST_P(CrushedChild, LosesNoEnergyThatNobodyKnowsOf) {
  const Outcome it = run("crushed_child", GetParam());
  const auto& d = it.diagnostics();
  const double unexplained = it.recording.snapshots.back().energies.residual,
               lost = energy(it.recording.snapshots.front()) - energy(it.recording.snapshots.back());
  row("child between two cars", it, "%.0f kJ lost, %.1f J of it unexplained, penetration %.3f mm, drift %.1e m, residual %.1e m/s",
      lost / 1e3, unexplained, d.max_penetration * 1e3, d.max_joint_gap, d.max_solver_residual);
  EXPECT_LT(std::abs(unexplained), 1e-3 * lost);
  EXPECT_LT(d.max_penetration, 2e-3);
  EXPECT_LT(d.max_joint_gap, 1e-5);
  EXPECT_LT(d.max_solver_residual, 1e-4);  // of some 2,000 contact problems one or two stop short of 1e-5
}

}  // namespace
}  // namespace hard_cases
