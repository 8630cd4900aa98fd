// The person against its closed set of 1.75 m and 78 kg, its poses, and its joints.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/geometry/hyper_ellipsoid.h"
#include "scene_file.h"

namespace scenes {
namespace {

using engine::Vec3;
using scenes::testing::SceneFolder;

constexpr double kDegree = std::numbers::pi / 180;

Scene person(const std::string& more) {
  static const SceneFolder folder;
  return folder.load("[[person]]\nname = \"p\"\n" + more);
}

const engine::Body& part(const Scene& scene, const std::string& name) {
  for (const engine::Body& body : scene.model.bodies)
    if (body.name == "p/" + name) return body;
  throw std::out_of_range(name);
}

double mass(const Scene& scene) {
  double sum = 0;
  for (const engine::Body& body : scene.model.bodies) sum += body.mass;
  return sum;
}

Vec3 centre_of_gravity(const Scene& scene) {
  Vec3 sum = Vec3::Zero();
  for (const engine::Body& body : scene.model.bodies) sum += body.mass * body.X_WB.p;
  return sum / mass(scene);
}

double lowest(const engine::Body& body) {
  return (body.X_WB * engine::support_point(std::get<engine::HyperEllipsoid>(body.shape), body.X_WB.q.conjugate() * -Vec3::UnitZ()))
      .z();
}

TEST(Person14, HasTheMassesAndTheCentreOfGravityOfItsClosedSet) {
  const Scene scene = person("");
  ASSERT_EQ(scene.model.bodies.size(), 14u);
  ASSERT_EQ(scene.model.joints.size(), 13u);
  EXPECT_NEAR(mass(scene), 78.0, 1e-9);
  // the set is printed to a gram and the centre to a millimetre
  EXPECT_NEAR(centre_of_gravity(scene).z(), 0.969, 5e-4);
  EXPECT_NEAR(part(scene, "torso").mass, 25.476, 5e-4);
  EXPECT_NEAR(part(scene, "hips").mass, 8.667, 5e-4);
  EXPECT_NEAR(part(scene, "head").mass, 4.100, 5e-4);
  EXPECT_NEAR(part(scene, "left_thigh").mass, 11.140, 5e-4);
  EXPECT_NEAR(part(scene, "right_forearm").mass, 1.714, 5e-4);
  EXPECT_NEAR(part(scene, "left_calf").inertia_B(0, 0), 0.04161, 5e-6);
}

TEST(Person14, TakesTheGivenStatureAndMassForBothSexes) {
  for (const char* sex : {"male", "female"}) {
    const Scene scene = person("sex = \"" + std::string(sex) + "\"\nstature = \"1.62 m\"\nmass = \"60 kg\"\n");
    EXPECT_NEAR(mass(scene), 60, 1e-9);
    const engine::Body& head = part(scene, "head");
    EXPECT_NEAR(head.X_WB.p.z() + std::get<engine::HyperEllipsoid>(head.shape).semi_axes.z(), 1.62, 1e-9);
    for (const engine::Body& body : scene.model.bodies) EXPECT_GT(body.mass, 0.3) << body.name;
  }
}

TEST(Person14, OverridesOnePartAndLeavesTheOthers) {
  const Scene plain = person("");
  const Scene scene = person("[person.segment.head]\nmass = \"5 kg\"\nfriction = 0.2\n");
  EXPECT_EQ(part(scene, "head").mass, 5);
  EXPECT_EQ(part(scene, "head").surface.friction_ground.at(0), 0.2);
  EXPECT_EQ(part(scene, "torso").mass, part(plain, "torso").mass);
}

TEST(Person14, YieldsUnlessTheSceneSaysOtherwise) {
  const Scene scene = person("");
  EXPECT_EQ(scene.model.settings.contact_law, engine::ContactLaw::persons_yield);
  EXPECT_EQ(part(scene, "head").surface.stiffness.at(0), 1e6);
  EXPECT_EQ(part(scene, "left_upper_arm").surface.stiffness.at(0), 60e3);
  EXPECT_EQ(part(scene, "torso").surface.stiffness.at(0), 400e3);
  const Scene given = person("stiffness = \"200 kN/m\"\n");
  EXPECT_EQ(part(given, "head").surface.stiffness.at(0), 200e3) << "the scene's stands for all parts";
  const SceneFolder folder;
  const Scene nobody = folder.load("[[body]]\nname = \"b\"\nmass = \"1 kg\"\naxes = \"0.1 0.1 0.1 m\"\n");
  EXPECT_EQ(nobody.model.settings.contact_law, engine::ContactLaw::default_auto);
}

TEST(Person14, WalksAlongItsHeading) {
  const Scene scene = person("heading = \"90 deg\"\nspeed = \"1.4 m/s\"\nposition = \"3 4 m\"\n");
  const engine::Body& hips = part(scene, "hips");
  EXPECT_TRUE(hips.V_WB.v.isApprox(Vec3(0, 1.4, 0), 1e-12));
  EXPECT_NEAR(hips.X_WB.p.x(), 3, 1e-12);
  EXPECT_NEAR(hips.X_WB.p.y(), 4, 1e-12);
  // facing +y, the left side is towards -x
  EXPECT_LT(part(scene, "left_thigh").X_WB.p.x(), 3);
}

TEST(Person14, SwingsArmsAgainstLegs) {
  const Scene scene = person("pose = \"walking_left\"\n");
  EXPECT_GT(part(scene, "left_foot").X_WB.p.x(), part(scene, "right_foot").X_WB.p.x() + 0.3);
  EXPECT_LT(part(scene, "left_forearm").X_WB.p.x(), part(scene, "right_forearm").X_WB.p.x() - 0.2);
}

TEST(Person14, TurnsAnatomicalWordsTheRightWay) {
  // each motion moves the end of its limb the way the word says; figures are levers times sines, signs are what counts
  EXPECT_GT(part(person("[person.angles]\nleft_shoulder_flexion = \"90 deg\"\n"), "left_forearm").X_WB.p.x(), 0.4);
  EXPECT_GT(part(person("[person.angles]\nleft_shoulder_abduction = \"90 deg\"\n"), "left_forearm").X_WB.p.y(), 0.6);
  EXPECT_LT(part(person("[person.angles]\nright_shoulder_abduction = \"90 deg\"\n"), "right_forearm").X_WB.p.y(), -0.6);
  EXPECT_GT(part(person("[person.angles]\nleft_elbow_flexion = \"90 deg\"\n"), "left_forearm").X_WB.p.x(), 0.1);
  EXPECT_LT(part(person("[person.angles]\nleft_knee_flexion = \"90 deg\"\n"), "left_calf").X_WB.p.x(), -0.1);
  EXPECT_GT(part(person("[person.angles]\nleft_hip_flexion = \"90 deg\"\n"), "left_thigh").X_WB.p.x(), 0.2);
  EXPECT_GT(part(person("[person.angles]\ntrunk_flexion = \"60 deg\"\n"), "head").X_WB.p.x(), 0.4);
  EXPECT_GT(part(person("[person.angles]\ntrunk_side = \"30 deg\"\n"), "head").X_WB.p.y(), 0.2);
  const Scene toes = person("[person.angles]\nleft_ankle_flexion = \"20 deg\"\n");
  EXPECT_GT((part(toes, "left_foot").X_WB.q * Vec3::UnitX()).z(), 0.3);
}

class Poses : public ::testing::TestWithParam<const char*> {};

TEST_P(Poses, StandsOnTheGroundWithItsJointsTogether) {
  const Scene scene = person("pose = \"" + std::string(GetParam()) + "\"\nheading = \"37 deg\"\n");
  double least = 1e9;
  for (const engine::Body& body : scene.model.bodies) least = std::min(least, lowest(body));
  EXPECT_NEAR(least, 0, 1e-12);
  for (const engine::Joint& joint : scene.model.joints) {
    const auto& parent = scene.model.bodies[static_cast<std::size_t>(joint.parent)];
    const auto& child = scene.model.bodies[static_cast<std::size_t>(joint.child)];
    EXPECT_LT((parent.X_WB * joint.X_PF.p - child.X_WB * joint.X_CF.p).norm(), 1e-12) << joint.name;
    // the limits hold the pose and stay clear of the singular half turn
    for (const engine::JointCoordinate& angle : joint.angles) EXPECT_LE(angle.lower, angle.upper) << joint.name;
    const auto& a = joint.angles;
    const double corner = std::hypot(std::max(-a[0].lower, a[0].upper), std::max(-a[1].lower, a[1].upper));
    EXPECT_LT(corner, 170 * kDegree) << joint.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Library, Poses,
                         ::testing::Values("standing", "walking_left", "walking_right", "running", "sitting", "sitting_upright",
                                           "lying_supine", "lying_prone", "leaning", "cyclist", "motorcyclist", "cat", "prayer"));

TEST(PoseHeights, OfLyingSittingAndStandingComeInThatOrder) {
  const auto height = [](const char* pose) { return centre_of_gravity(person("pose = \"" + std::string(pose) + "\"\n")).z(); };
  EXPECT_LT(height("lying_supine"), 0.15);
  EXPECT_LT(height("lying_prone"), 0.15);
  EXPECT_LT(height("sitting"), 0.45);
  EXPECT_LT(height("prayer"), height("cat"));
  EXPECT_LT(height("cat"), height("leaning"));
  EXPECT_LT(height("leaning"), height("standing"));
}

TEST(PoseOfOnesOwn, IsFoundBesideTheScene) {
  const SceneFolder folder;
  folder.write("poses/salute.toml", "[angles]\nright_shoulder_abduction = \"80 deg\"\nright_elbow_flexion = \"120 deg\"\n");
  const Scene scene = folder.load("[[person]]\nname = \"p\"\npose = \"salute\"\n");
  EXPECT_LT(part(scene, "right_upper_arm").X_WB.p.y(), -0.3);
}

TEST(JointFrames, GiveTheKneeItsWholeRange) {
  const Scene scene = person("");
  for (const engine::Joint& joint : scene.model.joints) {
    if (joint.name != "p/left_knee") continue;
    EXPECT_EQ(joint.kind, engine::JointKind::revolute);
    EXPECT_NEAR(joint.angles[1].upper - joint.angles[1].lower, 140 * kDegree, 1e-9);
    // standing is at the lower end: the frame sits in the middle of the range
    EXPECT_NEAR(joint.angles[1].lower, -70 * kDegree, 1e-9);
    return;
  }
  FAIL() << "no left knee";
}

}  // namespace
}  // namespace scenes
