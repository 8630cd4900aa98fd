// A person of 14 parts in free flight: the order of the schemes, what must be kept, and mirror symmetry.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/simulate.h"
#include "scenes/scene.h"

namespace {

using engine::Scheme;
using engine::Vec3;

const std::string kGallery = std::string(CRASHREEL_SOURCE_DIR) + "/scenes/gallery/";

/// High above the ground, turning, limbs swinging; `resistance` says whether joints have springs, dampers and passive torques
/// (never friction and stops, which are not smooth).
enum class Resistance { none, smooth };

engine::Model flying(Scheme scheme, Resistance resistance, double step, double duration) {
  auto scene = scenes::load(kGallery + "pose_walking_left.toml",
                            {"person.0.height=10 m", "person.0.zero_condition=false", "person.0.velocity=5 1 3 m/s",
                             "person.0.angular_velocity=3 4 -2.5 rad/s"});
  engine::Model& model = scene.model;
  model.settings.scheme = scheme;
  model.settings.step = step;
  model.settings.duration = duration;
  model.settings.record_interval = duration;
  model.settings.stop_at_rest = false;
  model.settings.effects["joint_limits"] = engine::Force::off;
  model.settings.effects["self_contact"] = engine::Force::off;
  model.settings.effects["air_drag"] = engine::Force::off;
  if (resistance == Resistance::none) {
    model.settings.effects["joint_resistance"] = engine::Force::off;
    for (engine::Joint& joint : model.joints)  // nothing would hold a neck together
      if (joint.kind == engine::JointKind::spinal) joint.kind = engine::JointKind::ragdoll;
  }
  for (engine::Joint& joint : model.joints)
    for (engine::JointCoordinate& angle : joint.angles) {
      angle.friction = 0;
      angle.damping *= 0.2;  // light enough for an explicit scheme at the coarsest step
    }
  return model;
}

engine::Snapshot end_of(const engine::Model& model) {
  return engine::simulate(model).snapshots.back();
}

double distance(const engine::Snapshot& a, const engine::Snapshot& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.bodies.size(); ++i) largest = std::max(largest, (a.bodies[i].X_WB.p - b.bodies[i].X_WB.p).norm());
  return largest;
}

/// About the centre of gravity, which gravity does not turn.
Vec3 angular_momentum(const engine::Model& model, const engine::Snapshot& s) {
  Vec3 cg = Vec3::Zero(), v = Vec3::Zero(), L = Vec3::Zero();
  double mass = 0;
  for (std::size_t b = 0; b < s.bodies.size(); ++b) {
    mass += model.bodies[b].mass;
    cg += model.bodies[b].mass * s.bodies[b].X_WB.p;
    v += model.bodies[b].mass * s.bodies[b].V_WB.v;
  }
  for (std::size_t b = 0; b < s.bodies.size(); ++b) {
    const auto& [X, V] = s.bodies[b];
    L += X.q * (model.bodies[b].inertia_B * (X.q.conjugate() * V.w)) +
         model.bodies[b].mass * (X.p - cg / mass).cross(V.v - v / mass);
  }
  return L;
}

TEST(FlyingPerson, Rk4IsOfFourthOrderOverFourHalvings) {
  // the coarsest step turns no limb by more than 0.1 rad: beyond that the engine divides it. The flight is long enough for its
  // error to stay above what projecting joints leaves (1e-11) down to the finest step.
  const engine::Snapshot exact = end_of(flying(Scheme::rk4, Resistance::none, 3.125e-5, 1.4));
  double last = 0;
  for (const double step : {2e-3, 1e-3, 5e-4, 2.5e-4, 1.25e-4}) {
    const double error = distance(end_of(flying(Scheme::rk4, Resistance::none, step, 1.4)), exact);
    if (last > 0) {
      EXPECT_NEAR(std::log2(last / error), 4, 0.2) << "step " << step << ", error " << error;
    }
    last = error;
  }
}

TEST(FlyingPerson, Rk4IsOfFourthOrderWithResistance) {
  // from a millisecond downwards: above, the ankles are too stiff for an explicit scheme and are left implicit
  const engine::Snapshot exact = end_of(flying(Scheme::rk4, Resistance::smooth, 3.125e-5, 0.1));
  double last = 0;
  for (const double step : {1e-3, 5e-4, 2.5e-4}) {
    const double error = distance(end_of(flying(Scheme::rk4, Resistance::smooth, step, 0.1)), exact);
    if (last > 0) {
      EXPECT_GT(std::log2(last / error), 3.8) << "step " << step << ", error " << error;
    }
    last = error;
  }
}

TEST(FlyingPerson, SteppingIsOfFourthOrderWithoutAndOfFirstWithResistance) {
  const engine::Snapshot exact = end_of(flying(Scheme::rk4, Resistance::none, 1.25e-4, 1.4));
  const double coarse = distance(end_of(flying(Scheme::stepping, Resistance::none, 2e-3, 1.4)), exact);
  const double fine = distance(end_of(flying(Scheme::stepping, Resistance::none, 1e-3, 1.4)), exact);
  EXPECT_NEAR(std::log2(coarse / fine), 4, 0.2);
  // resistance is linearly implicit over the step: first order
  const engine::Snapshot resisted = end_of(flying(Scheme::rk4, Resistance::smooth, 6.25e-5, 0.2));
  double last = 0;
  for (const double step : {1e-3, 5e-4, 2.5e-4, 1.25e-4}) {
    const double error = distance(end_of(flying(Scheme::stepping, Resistance::smooth, step, 0.2)), resisted);
    EXPECT_LT(error, 10 * step) << "m, of a flight of a metre";
    if (last > 0) {
      EXPECT_GT(std::log2(last / error), 0.85) << "step " << step << ", error " << error;
    }
    last = error;
  }
}

TEST(FlyingPerson, KeepsEnergyAngularMomentumAndJointsForASecond) {
  for (const Scheme scheme : {Scheme::rk4, Scheme::stepping}) {
    engine::Model model = flying(scheme, Resistance::none, 1e-3, 1);
    model.settings.record_interval = 0.01;
    const engine::Recording run = engine::simulate(model);
    const auto& first = run.snapshots.front();
    // energy of the motion: that of the height, 10 m above z = 0, would hide any error
    const double kinetic = first.energies.kinetic, total = kinetic + first.energies.potential;
    const Vec3 L = angular_momentum(model, first);
    double energy = 0, momentum = 0;
    for (const engine::Snapshot& s : run.snapshots) {
      energy = std::max(energy, std::abs(s.energies.kinetic + s.energies.potential - total) / kinetic);
      momentum = std::max(momentum, (angular_momentum(model, s) - L).norm() / L.norm());
    }
    RecordProperty("energy", std::to_string(energy));
    EXPECT_LT(energy, 1e-8);
    EXPECT_LT(momentum, 1e-8);
    EXPECT_LT(run.diagnostics.max_joint_gap, 1e-9);
  }
}

TEST(SymmetricPerson, StaysSymmetricUntilItTouches) {
  for (const Scheme scheme : {Scheme::stepping, Scheme::rk4}) {
    const auto scene =
        scenes::load(kGallery + "pose_sitting.toml",
                     {"person.0.height=2 m", "person.0.zero_condition=false", "person.0.position=0 0 m", "person.0.heading=0 deg",
                      "person.0.velocity=3 0 2 m/s", "person.0.angular_velocity=0 3 0 rad/s", "simulation.stop_at_rest=false"});
    engine::Model model = scene.model;
    model.settings.scheme = scheme;
    model.settings.duration = 0.8;
    model.settings.record_interval = 0.02;
    const engine::Recording run = engine::simulate(model);
    ASSERT_FALSE(run.failure);
    double moved = 0, worst = 0;
    for (const engine::Snapshot& s : run.snapshots) {
      if (std::any_of(s.contacts.begin(), s.contacts.end(), [](auto& c) { return c.shapes.on_ground(); })) break;
      for (std::size_t b = 0; b < s.bodies.size(); ++b) {
        std::string twin = model.bodies[b].name;
        const std::string side = twin.find("/left_") != std::string::npos ? "/left_" : "/right_";
        if (const auto at = twin.find(side); at != std::string::npos)
          twin.replace(at, side.size(), side == "/left_" ? "/right_" : "/left_");
        const auto other = std::find_if(model.bodies.begin(), model.bodies.end(), [&](auto& body) { return body.name == twin; });
        const auto& mirror = s.bodies[static_cast<std::size_t>(other - model.bodies.begin())];
        const Vec3 image(mirror.X_WB.p.x(), -mirror.X_WB.p.y(), mirror.X_WB.p.z());
        worst = std::max(worst, (s.bodies[b].X_WB.p - image).norm());
        moved = std::max(moved, (s.bodies[b].V_WB.w - s.bodies[0].V_WB.w).norm());
      }
    }
    EXPECT_LT(worst, 1e-9);
    EXPECT_GT(moved, 1) << "rad/s: the limbs must move for the test to mean anything";
  }
}

}  // namespace
