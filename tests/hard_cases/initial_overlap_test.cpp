// Bodies put inside each other by mistake: they must be told of and part gently, not explode.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/hard_cases/hard_case.h"
#include "tests/hard_cases/meshes.h"

namespace hard_cases {
namespace {

class InitialOverlap : public testing::TestWithParam<std::tuple<bool, Setting>> {};
INSTANTIATE_TEST_SUITE_P(In, InitialOverlap, testing::Combine(testing::Bool(), testing::ValuesIn(kSettings)),
                         [](const auto& tuple) {
                           return std::string(std::get<0>(tuple.param) ? "mesh" : "segment") + std::to_string(tuple.index);
                         });

TEST_P(InitialOverlap, IsToldAndResolvedGently) {
  const auto [in_mesh, setting] = GetParam();
  const Outcome it = run("initial_overlap", setting, {}, [in_mesh = in_mesh](engine::Model& model) {
    if (!in_mesh) return;
    model.bodies.pop_back();
    engine::Body block;
    block.name = "block";
    block.mass = 10;
    block.inertia_B = engine::Mat3::Identity();
    block.shape = engine::MeshShape{box_mesh({0.3, 0.3, 0.3}), {}};
    block.X_WB.p = {0.4, 0, 1};
    model.bodies.push_back(block);
  });
  double fastest = 0, apart_at = -1;
  const auto& snapshots = it.recording.snapshots;
  for (std::size_t i = 1; i < snapshots.size(); ++i) {
    const auto &now = snapshots[i], &before = snapshots[i - 1];
    const double moved =
        ((now.bodies[1].X_WB.p - now.bodies[0].X_WB.p) - (before.bodies[1].X_WB.p - before.bodies[0].X_WB.p)).norm();
    fastest = std::max(fastest, moved / (now.time - before.time));
    double depth = 0;
    for (const engine::ContactRecord& c : now.contacts) depth = std::max(depth, c.depth);
    if (depth < 1e-4 && apart_at < 0) apart_at = now.time;
  }
  const double gained = energy(snapshots.back()) - energy(snapshots.front());
  row("initial overlap", it, "in %s: apart after %.2f s at %.3f m/s, energy gained %.1e J, %zu warnings",
      in_mesh ? "mesh" : "segment", apart_at, fastest, gained, it.diagnostics().warnings.size());
  EXPECT_GT(apart_at, 0);
  EXPECT_LT(apart_at, 1);
  EXPECT_LT(fastest, 0.2 + 1e-9);
  EXPECT_LT(gained, 1e-6);
  EXPECT_THAT(it.diagnostics().warnings, testing::Contains(testing::HasSubstr("overlap")));
}

}  // namespace
}  // namespace hard_cases
