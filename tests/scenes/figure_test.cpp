// Every figure of the library, a person and a pose of one's own, what a person may be given and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/joints/coordinates.h"
#include "scene_file.h"

namespace scenes {
namespace {

using engine::Vec3;
using scenes::testing::SceneFolder;
using ::testing::Contains;
using ::testing::HasSubstr;

constexpr double kDegree = std::numbers::pi / 180;
const std::filesystem::path kLibrary = std::filesystem::path(CRASHREEL_SOURCE_DIR) / "scenes/library";

const SceneFolder& folder() {
  static const SceneFolder folder;
  return folder;
}

Scene person(const std::string& more) {
  return folder().load("[[person]]\nname = \"p\"\n" + more);
}

std::vector<std::string> errors(const std::string& more) {
  return folder().errors("[[person]]\nname = \"p\"\n" + more);
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

double lowest(const Scene& scene) {
  double least = 1e9;
  for (const engine::Body& body : scene.model.bodies)
    least =
        std::min(least, body.X_WB.p.z() - engine::aabb_half_widths(std::get<engine::HyperEllipsoid>(body.shape), body.X_WB.q).z());
  return least;
}

double top(const Scene& scene) {
  const engine::Body& head = part(scene, "head");
  return head.X_WB.p.z() + engine::aabb_half_widths(std::get<engine::HyperEllipsoid>(head.shape), head.X_WB.q).z();
}

std::vector<std::string> names(const char* kind) {
  std::vector<std::string> out;
  for (const auto& file : std::filesystem::directory_iterator(kLibrary / kind)) out.push_back(file.path().stem().string());
  std::sort(out.begin(), out.end());
  return out;
}

class Figures : public ::testing::TestWithParam<std::string> {};

TEST_P(Figures, AreWholeAndStandOnTheirSoles) {
  const Scene scene = person("figure = \"" + GetParam() + "\"\n");
  const engine::Person& p = scene.model.persons[0];
  EXPECT_GE(p.head, 0);
  EXPECT_GE(p.torso, 0);
  EXPECT_EQ(scene.model.joints.size() + 1, scene.model.bodies.size());
  EXPECT_NEAR(top(scene), p.stature, 2e-3);
  EXPECT_NEAR(lowest(scene), 0, 1e-12);
  for (const engine::Body& body : scene.model.bodies) {
    // living tissue: lungs in the torso, bone in the head, a child's with more of it; shoes make feet bigger than their mass
    const double density = body.mass / engine::volume(std::get<engine::HyperEllipsoid>(body.shape));
    EXPECT_GT(density, 750) << body.name;
    EXPECT_LT(density, 1260) << body.name;
  }
}

TEST_P(Figures, TakeEveryPoseOfTheLibraryWithTheirLowestPointOnTheGround) {
  for (const std::string& pose : names("poses")) {
    const Scene scene = person("figure = \"" + GetParam() + "\"\npose = \"" + pose + "\"\nheading = \"37 deg\"\n");
    EXPECT_NEAR(lowest(scene), 0, 1e-12) << pose;
    for (const engine::Joint& joint : scene.model.joints) {
      const auto& P = scene.model.bodies[static_cast<std::size_t>(joint.parent)];
      const auto& C = scene.model.bodies[static_cast<std::size_t>(joint.child)];
      EXPECT_LT((P.X_WB * joint.X_PF.p - C.X_WB * joint.X_CF.p).norm(), 1e-12) << pose << " " << joint.name;
      const engine::JointCoordinates now = engine::joint_coordinates(joint, P.X_WB, C.X_WB);
      for (std::size_t i = 0; i < 3; ++i) {
        if (!now.free[i]) continue;
        EXPECT_GE(now.value[static_cast<int>(i)], joint.angles[i].lower - 1e-9) << pose << " " << joint.name << " " << i;
        EXPECT_LE(now.value[static_cast<int>(i)], joint.angles[i].upper + 1e-9) << pose << " " << joint.name << " " << i;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(OfTheLibrary, Figures, ::testing::ValuesIn(names("persons")), [](const auto& one) {
  std::string name = one.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(Poses, OfTheLibraryAreThirteen) {
  EXPECT_EQ(names("poses").size(), 13u);
}

TEST(Person16, HasSixteenPartsFifteenJointsAndKneesOfTheirOwn) {
  const Scene scene = person("figure = \"person-16\"\n");
  EXPECT_EQ(scene.model.bodies.size(), 16u);
  EXPECT_EQ(scene.model.joints.size(), 15u);
  EXPECT_NEAR(mass(scene), 78, 1e-9);
  const engine::Body& knee = part(scene, "left_knee");
  EXPECT_NEAR(knee.mass, 0.9, 5e-4);
  EXPECT_TRUE(std::get<engine::HyperEllipsoid>(knee.shape).semi_axes.isApproxToConstant(0.06, 1e-12));
  EXPECT_EQ(std::get<engine::HyperEllipsoid>(knee.shape).exponent, 2.2);
  // the same man otherwise
  EXPECT_NEAR(part(scene, "left_femur").mass, 11.140 - 0.6, 1e-3);
  EXPECT_NEAR(part(scene, "left_lower_leg").mass, 3.343 - 0.3, 1e-3);
  EXPECT_NEAR(centre_of_gravity(scene).z(), 0.969, 5e-3);
  int of_kind[static_cast<int>(engine::JointKind::count)] = {};
  for (const engine::Joint& joint : scene.model.joints) ++of_kind[static_cast<int>(joint.kind)];
  EXPECT_EQ(of_kind[static_cast<int>(engine::JointKind::revolute)], 6);
  EXPECT_EQ(of_kind[static_cast<int>(engine::JointKind::universal)], 5);
  EXPECT_EQ(of_kind[static_cast<int>(engine::JointKind::ragdoll)], 3);
  EXPECT_EQ(of_kind[static_cast<int>(engine::JointKind::spinal)], 1);
}

TEST(Person16, SharesTheFlexionOfAKneeBetweenItsTwoJoints) {
  const Scene scene = person("figure = \"person-16\"\n[person.angles]\nleft_knee_flexion = \"90 deg\"\n");
  auto flexion = [&](const std::string& name) {
    const Vec3 shin = part(scene, name).X_WB.q * -Vec3::UnitZ();
    return std::atan2(-shin.x(), -shin.z()) / kDegree;
  };
  EXPECT_NEAR(flexion("left_knee"), 45, 1e-9);
  EXPECT_NEAR(flexion("left_lower_leg"), 90, 1e-9);
}

TEST(Person16, HangsAnUpperArmInACardanCross) {
  const Scene scene = person(
      "figure = \"person-16\"\n[person.angles]\nright_shoulder_flexion = \"50 deg\"\nright_shoulder_abduction = \"70 deg\"\n");
  for (const engine::Joint& joint : scene.model.joints) {
    if (joint.name != "p/right_shoulder") continue;
    const engine::JointCoordinates now =
        engine::joint_coordinates(joint, scene.model.bodies[static_cast<std::size_t>(joint.parent)].X_WB,
                                  scene.model.bodies[static_cast<std::size_t>(joint.child)].X_WB);
    // flexion turns about -y from the middle of -60..180 deg, abduction of the right arm about -x from the middle of -30..180 deg
    EXPECT_NEAR(now.value.y(), -(50 - 60) * kDegree, 1e-12);
    EXPECT_NEAR(now.value.x(), -(70 - 75) * kDegree, 1e-12);
    return;
  }
  FAIL() << "no right shoulder";
}

TEST(Children, HaveProportionsOfTheirOwn) {
  auto share = [](const std::string& figure, const char* name) {
    const Scene scene = person("figure = \"" + figure + "\"\n");
    return part(scene, name).mass / mass(scene);
  };
  EXPECT_NEAR(share("child-6", "head") + share("child-6", "neck"), 0.18, 0.005);
  EXPECT_GT(share("child-3", "head"), share("child-6", "head"));
  EXPECT_GT(share("child-6", "head"), share("child-10", "head"));
  EXPECT_GT(share("child-10", "head"), 2 * share("person-14", "head"));
  EXPECT_LT(share("child-6", "left_thigh"), 0.7 * share("person-14", "left_thigh"));
  // the centre of gravity stands higher, by stature: 0.554 of it in the man
  auto height = [](const std::string& figure) {
    const Scene scene = person("figure = \"" + figure + "\"\n");
    return centre_of_gravity(scene).z() / scene.model.persons[0].stature;
  };
  EXPECT_GT(height("child-6"), height("person-14") + 0.01);
  EXPECT_LT(height("child-6"), 0.62);
}

TEST(Size, StaysWithinWhatTheFigureIsMadeFor) {
  EXPECT_THAT(errors("stature = \"1.1 m\"\n"),
              Contains(HasSubstr("p.stature is \"1.1 m\": must lie in 1.3..2.3 m for the figure person-14")));
  EXPECT_THAT(errors("stature = \"1.1 m\"\n"), Contains(HasSubstr("child-6")));
  EXPECT_THAT(errors("figure = \"child-6\"\nmass = \"60 kg\"\n"), Contains(HasSubstr("must lie in 15..40 kg")));
  EXPECT_EQ(errors("figure = \"child-6\"\nstature = \"1.2 m\"\nmass = \"25 kg\"\n"), std::vector<std::string>{});
  const Scene scene = person("figure = \"child-6\"\nstature = \"1.2 m\"\nmass = \"25 kg\"\n");
  EXPECT_NEAR(top(scene), 1.2, 2e-3);
  EXPECT_NEAR(mass(scene), 25, 1e-9);
}

TEST(PoseBeyondTheRanges, IsRefusedWithTheJointNamed) {
  EXPECT_THAT(errors("[person.angles]\nleft_knee_flexion = \"150 deg\"\n"),
              Contains(HasSubstr("must lie in 0..140 deg; that is the range of flexion of joint left_knee")));
  EXPECT_THAT(errors("[person.angles]\nhip_flexion = \"-30 deg\"\n"), Contains(HasSubstr("joint left_hip")));
  EXPECT_THAT(errors("figure = \"person-16\"\n[person.angles]\nright_knee_flexion = \"141 deg\"\n"),
              Contains(HasSubstr("must lie in 0..140 deg; that is the range of flexion of joint right_knee_upper")));
  folder().write("poses/impossible.toml", "[angles]\nelbow_flexion = \"-10 deg\"\n");
  EXPECT_THAT(errors("pose = \"impossible\"\n"), Contains(HasSubstr("joint left_elbow")));
}

TEST(PoseOfOnesOwn, IsRefusedWhenAWordIsMisspelt) {
  folder().write("poses/misspelt.toml", "[angles]\nelbo_flexion = \"10 deg\"\n");
  EXPECT_THAT(errors("pose = \"misspelt\"\n"), Contains(HasSubstr("did you mean \"elbow_flexion\"")));
}

TEST(PoseOfTheLibrary, IsFollowedAsFarAsTheJointsGoAndSaysSo) {
  const Scene scene = person("figure = \"person-16\"\npose = \"lying_prone\"\n");
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("shoulder_rotation")));
  EXPECT_TRUE(person("pose = \"lying_prone\"\n").warnings.empty());
}

TEST(PersonOfOnesOwn, IsFoundBesideTheScene) {
  folder().write("persons/snowman.toml", R"(stature = "1.4 m"
mass = "40 kg"
root = "belly"
[[segment]]
name = "belly"
centre = "0 0 0.5 m"
axes = "0.5 0.5 0.5 m"
mass_share = 0.8
[[segment]]
name = "head"
centre = "0 0 1.2 m"
axes = "0.2 0.2 0.2 m"
mass_share = 0.2
[[joint]]
name = "neck"
parent = "belly"
child = "head"
at = "0 0 1 m"
angle = [{ name = "flexion", about = "+y", range = ["-30 deg", "30 deg"] }]
)");
  const Scene scene = person("figure = \"snowman\"\n");
  ASSERT_EQ(scene.model.bodies.size(), 2u);
  EXPECT_NEAR(part(scene, "head").mass, 8, 1e-9);
  EXPECT_EQ(scene.model.joints[0].kind, engine::JointKind::revolute);
  EXPECT_THAT(errors("figure = \"snowmann\"\n"), Contains(HasSubstr("did you mean \"snowman\"")));
}

TEST(StaticParameters, AreTheAngularOffsetAndTheHeightOfTheCentreOfGravity) {
  const Scene scene = person("heading = \"30 deg\"\ncg_height = \"1.20 m\"\npose = \"walking_left\"\n");
  EXPECT_NEAR(centre_of_gravity(scene).z(), 1.20, 1e-12);
  EXPECT_GT(lowest(scene), 0.1);
  const Vec3 forward = part(scene, "hips").X_WB.q * Vec3::UnitX();
  EXPECT_NEAR(std::atan2(forward.y(), forward.x()), 30 * kDegree, 1e-12);
  EXPECT_THAT(errors("height = \"1 m\"\ncg_height = \"2 m\"\n"), Contains(HasSubstr("must not be given together with height")));
}

TEST(PartOfAPerson, HasEveryPropertyOfItsOwn) {
  const Scene scene = person(R"(friction = 0.7
[person.segment.head]
axes = "0.11 0.09 0.13 m"
exponent = 3
mass = "5 kg"
inertia = [["0.03 kg m^2", "0.001 kg m^2", "0 kg m^2"], ["0.001 kg m^2", "0.035 kg m^2", "0.002 kg m^2"],
  ["0 kg m^2", "0.002 kg m^2", "0.025 kg m^2"]]
stiffness = "80 kN/m"
friction_body = 0.25
friction_ground = 0.45
restitution_body = 0.15
restitution_ground = [["0 s", 0.3], ["1 s", 0.1]]
)");
  const engine::Body& head = part(scene, "head");
  const auto& shape = std::get<engine::HyperEllipsoid>(head.shape);
  EXPECT_TRUE(shape.semi_axes.isApprox(Vec3(0.11, 0.09, 0.13)));
  EXPECT_EQ(shape.exponent, 3);
  EXPECT_EQ(head.mass, 5);
  engine::Mat3 inertia;
  inertia << 0.03, 0.001, 0, 0.001, 0.035, 0.002, 0, 0.002, 0.025;
  EXPECT_TRUE(head.inertia_B.isApprox(inertia));
  EXPECT_EQ(head.surface.stiffness.at(0), 80e3);
  EXPECT_EQ(head.surface.friction_body.at(0), 0.25);
  EXPECT_EQ(head.surface.friction_ground.at(0), 0.45);
  EXPECT_EQ(head.surface.restitution_body.at(0), 0.15);
  EXPECT_DOUBLE_EQ(head.surface.restitution_ground.at(0.5), 0.2);
  EXPECT_EQ(part(scene, "torso").surface.friction_body.at(0), 0.7);
  // a tensor no body can have: one moment above the sum of the others
  EXPECT_FALSE(errors("[person.segment.head]\ninertia = [\"0.1 kg m^2\", \"0.01 kg m^2\", \"0.01 kg m^2\"]\n").empty());
}

}  // namespace
}  // namespace scenes
