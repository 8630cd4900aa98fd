// [[joint]]: what becomes of its keys, and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/joints/coordinates.h"
#include "engine/joints/joint_type.h"
#include "scene_file.h"

namespace scenes {
namespace {

using scenes::testing::folder;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

const std::string kBall = "[[body]]\nname = \"ball\"\nmass = \"1 kg\"\naxes = \"0.1 0.1 0.1 m\"\n[[joint]]\nchild = \"ball\"\n";

TEST(JointSection, KnowsEveryKindOfTheEngineByItsName) {
  for (int k = 0; k < static_cast<int>(engine::JointKind::count); ++k) {
    const auto kind = static_cast<engine::JointKind>(k);
    const Scene scene = folder().load(kBall + "kind = \"" + engine::type_of(kind).name + "\"\n");
    EXPECT_EQ(scene.model.joints.at(0).kind, kind);
  }
}

TEST(JointSection, ReadsASlide) {
  for (const std::string kind : {"prismatic", "cylindrical"}) {
    const Scene scene =
        folder().load(kBall + "kind = \"" + kind +
                      "\"\naxis = [3, 0, 4]\n[joint.slide]\nrange = [\"-10 cm\", \"0.4 m\"]\nstiffness = \"200 N/m\"\n"
                      "rest = \"5 cm\"\ndamping = \"6 N s/m\"\nfriction = \"3 N\"\nstop_stiffness = \"5 kN/m\"\n");
    const engine::Joint& joint = scene.model.joints.at(0);
    EXPECT_DOUBLE_EQ(joint.slide.lower, -0.1);
    EXPECT_DOUBLE_EQ(joint.slide.upper, 0.4);
    EXPECT_DOUBLE_EQ(joint.slide.stiffness, 200);
    EXPECT_DOUBLE_EQ(joint.slide.rest, 0.05);
    EXPECT_DOUBLE_EQ(joint.slide.damping, 6);
    EXPECT_DOUBLE_EQ(joint.slide.friction, 3);
    EXPECT_DOUBLE_EQ(joint.slide.stop_stiffness, 5000);
    // 25 cm along the axis is a slide of 25 cm
    engine::Pose X = scene.model.bodies.at(0).X_WB;
    X.p += 0.25 * engine::Vec3(0.6, 0, 0.8);
    EXPECT_NEAR(engine::joint_coordinates(joint, {}, X).value[engine::kSlide], 0.25, 1e-12);
  }
  EXPECT_EQ(folder().load(kBall + "kind = \"prismatic\"\n").model.joints.at(0).slide.damping, 0);
}

TEST(JointSection, RefusesWhatTheKindLeavesNoFreedomFor) {
  EXPECT_THAT(
      folder().errors(kBall + "kind = \"prismatic\"\ndamping = \"3 N m s/rad\"\n"),
      ElementsAre("case.toml:8:11: joint.0.damping is \"3 N m s/rad\": a prismatic joint does not turn; what is of its slide "
                  "stands in [joint.slide]"));
  EXPECT_THAT(folder().errors(kBall + "kind = \"fixed\"\nrange = [\"-1 deg\", \"1 deg\"]\n"),
              ElementsAre("case.toml:8:9: joint.0.range is [\"-1 deg\", \"1 deg\"]: a fixed joint does not turn"));
  EXPECT_THAT(folder().errors(kBall + "kind = \"cylindrical\"\n[joint.z]\ndamping = \"3 N m s/rad\"\n"),
              ElementsAre("case.toml:8:1: joint.0.z is a table: a cylindrical joint does not turn about z"));
  EXPECT_THAT(
      folder().errors(kBall + "kind = \"revolute\"\n[joint.slide]\ndamping = \"3 N s/m\"\n"),
      ElementsAre(
          "case.toml:8:1: joint.0.slide is a table: a revolute joint does not slide; prismatic, cylindrical and spinal ones do"));
  EXPECT_THAT(folder().errors(kBall + "kind = \"prismatic\"\n[joint.slide]\ndamping = \"3 N m s/rad\"\n"), ::testing::SizeIs(1));
  EXPECT_THAT(folder().errors(kBall + "kind = \"cylindrical\"\ndamping = \"3 N m s/rad\"\n[joint.y]\ndamping = \"1 N m s/rad\"\n"),
              IsEmpty());
}

}  // namespace
}  // namespace scenes
