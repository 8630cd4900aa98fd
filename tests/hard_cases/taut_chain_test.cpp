// Two bodies of 100 kg spinning at the ends of a chain of light links: 9.5 kN in links of 1 kg and of 50 g.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/hard_cases/hard_case.h"

namespace hard_cases {
namespace {

struct Chain {
  double ratio;
  const char* step;
  double allowed;  // [m], [rad]
};

class TautChain : public testing::TestWithParam<std::tuple<Chain, const char*>> {};
// the closed form is met at 0.25 ms; at 1 ms the lightest links swing faster than the step can follow
INSTANTIATE_TEST_SUITE_P(Ratios, TautChain,
                         testing::Combine(testing::Values(Chain{100, "0.25 ms", 1e-6}, Chain{2000, "0.25 ms", 1e-6},
                                                          Chain{100, "1 ms", 1e-6}, Chain{2000, "1 ms", 1e-6},
                                                          Chain{2000, "2 ms", 1e-5}),
                                          testing::Values("stepping", "rk4")));

TEST_P(TautChain, StaysStraightAndTurnsEvenly) {
  const auto [chain, scheme] = GetParam();
  const double light = 100 / chain.ratio;
  const Outcome it = run("scenes/gallery/spinning_chain", {chain.step, scheme}, {}, [light](engine::Model& model) {
    for (engine::Body& body : model.bodies)
      if (body.mass < 50) {
        body.inertia_B *= light / body.mass;
        body.mass = light;
      }
  });
  const engine::Vec3 across = it.last(static_cast<int>(it.model.bodies.size()) - 1).X_WB.p - it.last(0).X_WB.p;
  const double distance = across.norm() - 1.9,
               phase = std::remainder(std::atan2(across.y(), across.x()) - 20, 2 * std::numbers::pi);
  row("taut chain", it, "ratio %.0f: distance %+.1e m, phase %+.1e rad, drift %.1e m, %ld parts of steps", chain.ratio, distance,
      phase, it.diagnostics().max_joint_gap, it.diagnostics().substeps);
  EXPECT_NEAR(distance, 0, chain.allowed);
  EXPECT_NEAR(phase, 0, chain.allowed);
}

}  // namespace
}  // namespace hard_cases
