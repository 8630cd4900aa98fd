// Heavy things that touch with a light part of theirs: a table on feet of a gramme, a lever that falls on a pad of a gramme.
#include <gtest/gtest.h>

#include "tests/hard_cases/hard_case.h"

namespace hard_cases {
namespace {

using engine::JointKind;
using engine::Vec3;

constexpr double kFoot = 0.05;  // [m] radius

/// At rest and on the surface: as asked of a body on a plane, and a tenth of what may be deep for a step.
void expect_rest(const Outcome& it) {
  EXPECT_LT(it.diagnostics().max_penetration, 1e-3);
  EXPECT_LT(it.diagnostics().rest_penetration, 1e-4);
  EXPECT_LT(it.last(0).V_WB.v.norm(), 1e-3);
}

/// A ball joined to body `parent` with its centre `at` [m] in the parent's axes.
void add_foot(engine::Model& model, int parent, const Vec3& at, double mass, JointKind kind) {
  engine::Body foot;
  foot.name = "foot" + std::to_string(model.bodies.size());
  foot.mass = mass;
  foot.inertia_B *= 0.4 * mass * kFoot * kFoot;
  foot.shape = engine::HyperEllipsoid{Vec3::Constant(kFoot), 2};
  foot.surface = model.bodies[0].surface;
  foot.X_WB.p = model.bodies[static_cast<std::size_t>(parent)].X_WB * at;
  engine::Joint joint;
  joint.name = foot.name;
  joint.kind = kind;
  joint.parent = parent;
  joint.child = static_cast<int>(model.bodies.size());
  joint.X_PF.p = at;
  model.bodies.push_back(foot);
  model.joints.push_back(joint);
}

/// The scene's body as a heavy plate that touches with nothing of its own.
engine::Body& heavy_plate(engine::Model& model) {
  model.settings.duration = 2;
  engine::Body& plate = model.bodies[0];
  plate.mass = 80;
  plate.inertia_B = Vec3(3, 5, 7).asDiagonal();
  plate.shape = std::monostate{};
  return plate;
}

class LightFeet : public testing::TestWithParam<std::tuple<double, JointKind, Setting>> {};
INSTANTIATE_TEST_SUITE_P(Of, LightFeet,
                         testing::Combine(testing::Values(1.0, 1e-3, 1e-6), testing::Values(JointKind::fixed, JointKind::spherical),
                                          testing::ValuesIn(kSettings)));

TEST_P(LightFeet, CarryATableOf80Kilogrammes) {
  const auto [mass, kind, setting] = GetParam();
  const Outcome it = run("redundant", setting, {}, [mass = mass, kind = kind](engine::Model& model) {
    model.ground.plane = true;
    heavy_plate(model).X_WB.p = {0, 0, kFoot + 0.01};  // comes down by a centimetre
    for (const double x : {-0.4, 0.4})
      for (const double y : {-0.3, 0.3}) add_foot(model, 0, {x, y, 0}, mass, kind);
  });
  double force = 0;
  for (const engine::ContactRecord& c : it.recording.snapshots.back().contacts) force += c.normal_force;
  const double weight = (80 + 4 * mass) * engine::kGravity;
  row("table on light feet", it, "feet of %.0e kg, %s: penetration %.2f mm, at the end %.3f mm; N/mg %.4f; speed %.1e m/s", mass,
      kind == JointKind::fixed ? "fixed" : "turning", it.diagnostics().max_penetration * 1e3,
      it.diagnostics().rest_penetration * 1e3, force / weight, it.last(0).V_WB.v.norm());
  expect_rest(it);
  EXPECT_NEAR(force / weight, 1, 0.01);
}

class LightPads : public testing::TestWithParam<std::tuple<double, Setting>> {};
INSTANTIATE_TEST_SUITE_P(Of, LightPads, testing::Combine(testing::Values(1.0, 1e-3, 1e-6), testing::ValuesIn(kSettings)));

TEST_P(LightPads, HoldALeverOnItsOwnFoundation) {
  const auto [mass, setting] = GetParam();
  const Outcome it = run("redundant", setting, {}, [mass = mass](engine::Model& model) {
    heavy_plate(model).X_WB.p = {0, 0, 0.5};
    engine::Body base = model.bodies[0];
    base.name = "base";
    base.mass = 2000;
    base.inertia_B *= 25;
    base.X_WB.p = {0, 0, 0};
    model.bodies.push_back(base);
    engine::Joint held;  // the base stands on a joint, so that it and the lever are one tree
    held.kind = JointKind::fixed;
    held.child = 1;
    model.joints.push_back(held);
    engine::Joint hinge;
    hinge.kind = JointKind::revolute;
    hinge.parent = 1;
    hinge.child = 0;
    hinge.X_PF.p = {-0.5, 0, 0.5};
    hinge.X_CF.p = {-0.5, 0, 0};
    model.joints.push_back(hinge);
    add_foot(model, 0, {0.5, 0, -0.1}, mass, JointKind::fixed);
    add_foot(model, 1, {0.5, 0, 0.2}, mass, JointKind::fixed);
  });
  row("lever on light pads", it, "pads of %.0e kg: penetration %.2f mm, at the end %.3f mm; speed %.1e m/s", mass,
      it.diagnostics().max_penetration * 1e3, it.diagnostics().rest_penetration * 1e3, it.last(0).V_WB.v.norm());
  expect_rest(it);
  EXPECT_GT(it.recording.snapshots.back().contacts.size(), 0u);
}

}  // namespace
}  // namespace hard_cases
