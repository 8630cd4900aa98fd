// A run says by itself when its energy does not add up, and which step took long: planted faults, and runs without any.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/effects/effect.h"
#include "engine/record/energy_watch.h"
#include "engine/start.h"
#include "engine/step/energy_ledger.h"
#include "engine/step_watch.h"
#include "tests/engine/experiment.h"

namespace {

using namespace engine;
using namespace engine::test;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A pendulum that meets the ground, two bodies by name.
Model experiment() {
  Model model = on_ground(0.5);
  model.bodies = {ball(0.2, 3, {0, 0, 0.6}), ball(0.2, 1, {1, 0, 0.2})};
  model.bodies[0].name = "high";
  model.bodies[1].name = "low";
  return model;
}

/// Snapshots' energies: kinetic, potential, dissipated, residual.
Energies at_instant(double kinetic, double potential, double dissipated, double residual) {
  return {kinetic, potential, {dissipated}, 0, residual};
}

struct Watched {
  Model model = experiment();
  Plan plan = compile(model);
  World world{model, plan, {}};
  State state = start(world);
};

TEST(EnergyWatch, WarnsOfMoreThanAHundredthUnexplained) {
  for (const double missing : {-1.2, -0.8, 0.8, 1.2}) {
    Watched w;
    EnergyWatch watch;
    watch.weigh(w.world, w.state, at_instant(0, 100, 0, 0));
    w.state.time = 0.25;
    watch.weigh(w.world, w.state, at_instant(40, 0, 60 + missing, missing));  // 100 J were turned over
    w.state.time = 0.5;
    watch.weigh(w.world, w.state, at_instant(0, 0, 100, 0));
    Diagnostics out;
    watch.close(w.world, out);
    EXPECT_NEAR(out.energy_turned_over, std::max(100.0, 100 + missing), 1e-12);
    EXPECT_EQ(out.max_unexplained, std::abs(missing));
    if (std::abs(missing) < 1)
      EXPECT_THAT(out.warnings, IsEmpty());
    else
      EXPECT_THAT(out.warnings, ElementsAre(AllOf(HasSubstr("1.2 J at 250 ms that no effect explains"), HasSubstr("turned over"))));
  }
}

/// Of much it is a thousandth, and no less than a step may mislay.
TEST(EnergyWatch, WarnsOfAThousandthOfMuch) {
  for (const double moved : {5e3, 5e4})
    for (const double missing : {9.0, 11.0, 45.0, 55.0}) {
      Watched w;
      EnergyWatch watch;
      watch.weigh(w.world, w.state, at_instant(moved, 0, 0, 0));
      watch.weigh(w.world, w.state, at_instant(moved - missing, 0, 0, missing));
      Diagnostics out;
      watch.close(w.world, out);
      EXPECT_EQ(out.warnings.size(), missing > std::max(10.0, 1e-3 * moved) ? 1u : 0u) << missing << " J of " << moved;
    }
}

TEST(EnergyWatch, IsSilentAboutRoundingOfWhatRests) {
  Watched w;
  EnergyWatch watch;
  watch.weigh(w.world, w.state, at_instant(1e-14, 20, 0, 1e-9));
  Diagnostics out;
  watch.close(w.world, out);
  EXPECT_THAT(out.warnings, IsEmpty());
}

/// The index of an effect in the plan.
int named(const Plan& plan, const std::string& name) {
  for (std::size_t e = 0; e < plan.active.size(); ++e)
    if (name == plan.active[e]->name) return static_cast<int>(e);
  return -1;
}

TEST(EnergyWatch, NamesTheEffectAndBodiesOfAGiftInAStep) {
  Watched w;
  const int ground = named(w.plan, "ground_contact");
  ASSERT_GE(ground, 0);
  StepBuffers buffers(w.world);
  choose_trees(w.world, w.state);
  buffers.dissipated_before = w.state.energy.dissipated;
  StepContext step(w.world, w.state, buffers, 1e-3);
  // the ground throws `low` up: an impulse along what it moves by
  Constraint c;
  c.effect = ground;
  c.a.body = c.a.record = 1;
  c.impulse = {4, 0, 0};
  c.u.after = {2, 0, 0};
  step.constraints = {c};
  step.impulses = true;
  buffers.weight = {0.5};
  buffers.pull = {Vec3::Zero()};
  book(step);
  note_gains(step);
  EXPECT_NEAR(w.world.log.gain.amount, 4, 1e-12);  // L (u_before + u_after) / 2
  EnergyWatch watch;
  watch.weigh(w.world, w.state, at_instant(10, 20, 0, 0));
  Diagnostics out;
  watch.close(w.world, out);
  EXPECT_NEAR(out.max_effect_gain, 4, 1e-12);
  EXPECT_THAT(out.warnings,
              ElementsAre(AllOf(HasSubstr("ground_contact gave 4 J to low and the world"), HasSubstr("has none to give"))));
}

/// A surface that yields may give within a step; over a run it has nothing to give. A prone person on a slope crept up it for
/// minutes at steps of 2 ms, fed by the ground.
TEST(EnergyWatch, TellsOfASurfaceThatGaveOverTheRun) {
  for (const double given : {4.0, 20.0}) {
    Watched w;
    const auto ground = static_cast<std::size_t>(named(w.plan, "ground_contact"));
    EnergyWatch watch;
    Energies now = at_instant(0, 100, 0, 0);
    now.dissipated.assign(w.plan.active.size(), 0);
    watch.weigh(w.world, w.state, now);
    now.dissipated[ground] = -given;
    watch.weigh(w.world, w.state, now);
    Diagnostics out;
    watch.close(w.world, out);
    EXPECT_EQ(out.warnings.size(), given < 5 ? 0u : 1u);
    if (!out.warnings.empty()) {
      EXPECT_THAT(out.warnings[0], AllOf(HasSubstr("ground_contact gave 20 J over the run"), HasSubstr("none to give")));
    }
  }
}

TEST(EnergyWatch, LetsSpringsAndYieldingSurfacesGive) {
  Model model = experiment();
  model.settings.contact_law = ContactLaw::compliant;
  const Plan plan = compile(model);
  const World world(model, plan, {});
  EXPECT_TRUE(world.gives[static_cast<std::size_t>(named(plan, "ground_contact"))]);
  const Watched rigid;
  EXPECT_FALSE(rigid.world.gives[static_cast<std::size_t>(named(rigid.plan, "ground_contact"))]);
}

TEST(EnergyWatch, FindsNothingInARunThatKeepsItsBooks) {
  const Recording run = simulate(experiment());
  EXPECT_THAT(run.diagnostics.warnings, IsEmpty());
  EXPECT_GT(run.diagnostics.energy_turned_over, 3 * kGravity * 0.4 * 0.9);  // what falls 0.4 m
  EXPECT_LT(run.diagnostics.max_unexplained, 1e-3 * run.diagnostics.energy_turned_over);
  EXPECT_LT(run.diagnostics.max_effect_gain, 1e-3 * run.diagnostics.energy_turned_over);
}

TEST(EnergyWatch, WarnsOfARunWhoseStepIsTooLong) {
  // the spring of a contact that a step of 20 ms cannot follow in the stages of Runge and Kutta would be divided; a pendulum with
  // 2.2 rad a step is not: its fourth order has nothing left
  Model model = free_space(20, 0.2);
  model.settings.gravity = {0, 0, -kGravity};
  model.settings.record_interval = 0.2;
  model.bodies = {inert(1, Vec3::Constant(1e-3), {0.12, 0, 0})};
  model.joints = {joint_at(model, JointKind::revolute, -1, 0, Vec3::Zero())};
  const Recording coarse = simulate(model);
  EXPECT_THAT(coarse.diagnostics.warnings, testing::Contains(HasSubstr("that no effect explains")))
      << coarse.diagnostics.max_unexplained;
  model.settings.step = 1e-3;
  EXPECT_THAT(simulate(model).diagnostics.warnings, IsEmpty());
}

// A clock of the test's own: each look takes a millisecond, but for one that takes long.
int looks = 0;
int slow_look = -1;
double passed() {
  ++looks;
  return 1e-3 * looks + (slow_look >= 0 && looks > slow_look ? 2.5 : 0);
}
double computed() {
  return 1e-3 * looks + (slow_look >= 0 && looks > slow_look ? 1.5 : 0);  // a second of those others had
}

/// Pairs of heavy bodies on a ball joint that fall onto the road far from each other.
Model falling_pairs(int count, double mass) {
  Model model = on_ground(0.2);
  for (int k = 0; k < count; ++k) {
    const int first = static_cast<int>(model.bodies.size());
    const Vec3 at(5.0 * k, 0, 0.5);
    for (const double along : {0.0, 0.6}) {
      model.bodies.push_back(solid({{0.25, 0.1, 0.1}, 2}, mass, at + Vec3(along, 0, 0)));
      model.bodies.back().V_WB.v = {3, 0, -6};
    }
    model.joints.push_back(joint_at(model, JointKind::spherical, first, first + 1, at + Vec3(0.3, 0, 0)));
    model.bodies[first].V_WB = {{3, 0, -6 + 8 * 0.3}, {0, 8, 0}};
  }
  return model;
}

// A step is halved where an impact leaves 10 J unexplained: of each by itself, however many there are.
TEST(StepControl, HalvesForTheBooksOfOneIslandNotOfAll) {
  const auto substeps = [](int count, double mass) { return simulate(falling_pairs(count, mass)).diagnostics.substeps; };
  constexpr double kMass = 5e4;  // of which one leaves somewhat less
  EXPECT_EQ(substeps(1, kMass), 0);
  EXPECT_EQ(substeps(4, kMass), 0);
  EXPECT_GT(substeps(1, 4 * kMass), 0);
}

TEST(StepWatch, NamesTheStepThatTookLongestAndItsBodies) {
  looks = 0;
  slow_look = 301;  // one look when the run begins, one a step
  RunOptions options;
  options.step_clocks = {passed, computed};
  const Recording run = simulate(experiment(), options);
  ASSERT_TRUE(run.longest_step.has_value());
  EXPECT_NEAR(run.longest_step->processor_s, 1.5, 0.0121);  // and no more than 10 ms and a look too long
  EXPECT_NEAR(run.longest_step->time, 0.301, 1.1e-3);
  EXPECT_THAT(run.longest_step->bodies, testing::Contains("low"));
  // and nothing of the run has changed
  EXPECT_EQ(hash(run), hash(simulate(experiment())));
}

TEST(StepWatch, NeedsClocks) {
  EXPECT_FALSE(simulate(experiment()).longest_step.has_value());
}

/// What is thrown up and has no weight goes on, and gains nothing by the height it gets.
TEST(Energy, GravityThatIsOffIsNoWeightInItEither) {
  Model model = free_space(1);
  model.settings.gravity = {0, 0, -kGravity};
  model.settings.effects["gravity"] = Force::off;
  model.bodies = {ball(0.1, 10, {0, 0, 2})};
  model.bodies[0].V_WB.v.z() = 10;
  const Recording run = simulate(model);
  ASSERT_FALSE(run.failure);
  EXPECT_NEAR(run.snapshots.back().bodies[0].X_WB.p.z(), 12, 1e-9);
  EXPECT_EQ(run.snapshots.back().energies.residual, 0);
  EXPECT_EQ(run.snapshots.back().energies.potential, 0);
}

/// Somebody's part, 20 cm thick, before a block of 600 kg that comes at a speed, and before a wall or nothing.
Model pressed_part(double speed, bool wall) {
  Model model = free_space(0.2);
  model.settings.contact_law = ContactLaw::persons_yield;
  model.bodies = {solid({{0.1, 0.16, 0.1}, 3}, 20, {0, 0, 0}), solid({{0.2, 0.5, 0.5}, 30}, 600, {-0.31, 0, 0})};
  model.bodies[0].name = "person/hips";
  model.bodies[0].person = 0;
  model.persons = {of_one_part(0)};
  model.bodies[1].name = "block";
  model.bodies[1].V_WB.v.x() = speed;
  if (!wall) return model;
  model.bodies.push_back(solid({{0.2, 0.5, 0.5}, 30}, 1, {0.31, 0, 0}));
  model.bodies[2].name = "wall";
  model.bodies[2].fixed = true;
  return model;
}

/// Each side by itself keeps within half of the thickness; both together do not.
TEST(BoundsWatch, TellsOfAPartThatIsPressedFromTwoSides) {
  EXPECT_THAT(simulate(pressed_part(5, false)).diagnostics.warnings, IsEmpty()) << "thrown off";
  EXPECT_THAT(simulate(pressed_part(0.5, true)).diagnostics.warnings, IsEmpty()) << "1 cm";
  const Recording run = simulate(pressed_part(5, true));
  EXPECT_THAT(run.diagnostics.warnings,
              ElementsAre(AllOf(HasSubstr("person/hips was pressed"), HasSubstr("mm by wall"), HasSubstr("mm by block"),
                                HasSubstr("from the other side"), HasSubstr("more than it has room for"))));
  double deepest = 0;
  for (const Snapshot& s : run.snapshots)
    for (const ContactRecord& c : s.contacts) deepest = std::max(deepest, c.depth);
  EXPECT_LT(deepest, 0.12) << "either side alone would have warned of nothing";
}

/// A rod on a hinge, given a velocity that is none of a turn about it: what is left is the part of the motion that the joint lets
/// be.
TEST(Start, TellsOfAVelocityThatAJointForbids) {
  Model model = free_space(0.01);
  model.bodies = {inert(4, {1, 1, 1}, {0, 0, 2})};
  model.bodies[0].name = "rod";
  model.joints = {joint_at(model, JointKind::spherical, -1, 0, {0, 0, 2.5})};
  model.joints[0].name = "hook";
  model.bodies[0].V_WB = {{3, 0, 0}, {0, -6, 0}};
  EXPECT_THAT(simulate(model).diagnostics.warnings, IsEmpty()) << "it turns about the hook";
  model.bodies[0].V_WB = {{3, 0, 0}, {0, 0, 0}};
  // L about the hook is kept: w = m v l / (I + m l^2) = 6 / 2, so that its centre has 1.5 m/s, and m v (v - w l) / 2 is lost
  EXPECT_THAT(simulate(model).diagnostics.warnings,
              ElementsAre(AllOf(HasSubstr("rod starts with a velocity that joint hook forbids, 3 m/s at its point"),
                                HasSubstr("with 9 J"), HasSubstr("rod starts at 1.5 m/s in place of 3 m/s"))));
}

}  // namespace
