// What a scene's author is told, word for word.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene_file.h"

namespace scenes {
namespace {

using scenes::testing::folder;
using ::testing::ElementsAre;

const std::string kBall = "[[body]]\nname = \"ball\"\nmass = \"1 kg\"\naxes = \"0.1 0.1 0.1 m\"\n";

TEST(SceneErrorTexts, BrokenToml) {
  const auto lines = folder().errors("title = \"x\n");
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0], "case.toml:1:11: the text has no closing quote; write title = \"x\"");
}

/// Of 20 ms the flagship's delta-v came out as 0.29 instead of 0.47 m/s, without a word.
TEST(SceneWarnings, IntervalsTooLongForCollisionsAreTold) {
  const auto warnings = [](const std::string& interval) {
    return folder().load("[simulation]\nrecord_interval = \"" + interval + "\"\n" + kBall).warnings;
  };
  EXPECT_THAT(warnings("11 ms"), ElementsAre(::testing::HasSubstr("simulation.record_interval is longer than 10 ms: delta-v")));
  EXPECT_THAT(warnings("10 ms"), ElementsAre());
}

TEST(SceneErrorTexts, KeysTheParserCannotStand) {
  // each of these once ended the process inside the parser
  std::string endless;
  for (int i = 0; i < 100'000; ++i) endless += "a.";
  EXPECT_THAT(folder().errors("title = \"x.y\"\n" + endless + "a = 1\n"),
              ElementsAre("case.toml:2: not TOML: a key of more than 16 parts; no key of a scene has"));
  EXPECT_THAT(folder().errors("title = \"x\"\n\n[.a]\nb = 1\n"),
              ElementsAre("case.toml:3: not TOML: a key or a value is not whole"));
  for (const char* letter : {"\u00b0 = 1\n", "title = \"\"\"\n\\\u00b0\"\"\"\n", "title = 0\"\u00b0\"\n"})
    EXPECT_THAT(folder().errors(letter), ElementsAre(::testing::HasSubstr(": not TOML: "))) << letter;
}

TEST(SceneErrorTexts, OrdinaryTomlIsNotHeldForThat) {
  const std::string text =
      "\xef\xbb\xbftitle = \"\"\"one. . . . . . . . . . . . . . . . . . . . two\\\n \" \u00b0 three\"\"\"\n"
      "description = 'a.b.c.d.e.f.g.h.i.j.k.l.m.n.o.p.q.r.s \u00b0' # ................. \u00b0\n"
      "[simulation]\nstep = \"0.5 ms\"\n";
  EXPECT_THAT(folder().errors(text + kBall), ElementsAre());
}

TEST(SceneErrorTexts, EndlessFiles) {
  try {
    load("/dev/zero");
    FAIL() << "a file without end was loaded";
  } catch (const SceneErrors& error) {
    EXPECT_THAT(error.lines, ElementsAre("/dev/zero: is larger than 16 MB, this is no scene file"));
  }
}

TEST(SceneErrorTexts, MissingFile) {
  try {
    load("no/such/scene.toml");
    FAIL() << "a scene that is not there was loaded";
  } catch (const SceneErrors& error) {
    EXPECT_THAT(error.lines, ElementsAre("no/such/scene.toml: there is no such file; there is no folder no/such either"));
  }
}

TEST(SceneErrorTexts, NegativeMass) {
  EXPECT_THAT(folder().errors("[[body]]\nname = \"ball\"\nmass = \"-3 kg\"\naxes = \"0.1 0.1 0.1 m\"\n"),
              ElementsAre("case.toml:3:8: body.ball.mass is \"-3 kg\": must be greater than 0 kg"));
}

TEST(SceneErrorTexts, NegativeDrag) {
  EXPECT_THAT(folder().errors("[air]\ndrag = -1.2\nvehicle_drag = [0.3, -0.8, 1]\n" + kBall),
              ElementsAre("case.toml:2:8: air.drag is -1.2: must be at least 0",
                          "case.toml:3:22: air.vehicle_drag[1] is -0.8: must be at least 0"));
}

TEST(SceneErrorTexts, BrakeSharesOfSomeWheelsOnly) {
  const std::string head =
      "[[vehicle]]\nname = \"v\"\nmesh = \"assets/vehicles/sedan_collision.obj\"\nmass = \"1 t\"\ncg = \"0 0 0.5 m\"\n"
      "inertia = \"500 1500 1500 kg m^2\"\n";
  const std::string front = "[[vehicle.wheel]]\nname = \"front\"\nat = \"1 0 0.3 m\"\n";
  const std::string rear = "[[vehicle.wheel]]\nname = \"rear\"\nat = \"-1 0 0.3 m\"\n";
  EXPECT_THAT(folder().errors(head + front + rear), ElementsAre());
  EXPECT_THAT(folder().errors(head + front + "brake_share = 0.6\n" + rear),
              ElementsAre("case.toml:1:1: vehicle.v has a brake_share at some of its wheels; give it at all, or at none"));
  EXPECT_THAT(folder().errors(head + front + "brake_share = 0.6\n" + rear + "brake_share = 0.6\n"),
              ElementsAre("case.toml:1:1: vehicle.v has brake shares that sum to 1.2, must sum to 1"));
}

TEST(SceneErrorTexts, ImpossibleInertia) {
  EXPECT_THAT(
      folder().errors(kBall + "inertia = \"1 2 5 kg m^2\"\n"),
      ElementsAre("case.toml:5:11: body.ball.inertia is \"1 2 5 kg m^2\": must be physically possible; of its principal moments "
                  "1 + 2 is less than 5 kg m^2"));
  EXPECT_THAT(
      folder().errors(kBall + "inertia = \"-1 2 2 kg m^2\"\n"),
      ElementsAre("case.toml:5:11: body.ball.inertia is \"-1 2 2 kg m^2\": must be positive definite; its smallest principal "
                  "moment is -1 kg m^2"));
}

TEST(SceneErrorTexts, ExponentBelowTwo) {
  EXPECT_THAT(folder().errors(kBall + "exponent = 1.5\n"),
              ElementsAre("case.toml:5:12: body.ball.exponent is 1.5: must lie in 2..100; a hyper-ellipsoid needs n >= 2"));
}

TEST(SceneErrorTexts, UnknownKey) {
  EXPECT_THAT(folder().errors(kBall + "frictoin = 0.6\n"),
              ElementsAre("case.toml:5:1: body.ball.frictoin is not a known key; did you mean \"friction\"?"));
}

TEST(SceneErrorTexts, WrongDimension) {
  EXPECT_THAT(
      folder().errors("[simulation]\nduration = \"4 km/h\"\n"),
      ElementsAre(
          "case.toml:2:12: simulation.duration is \"4 km/h\": must be a time; write it like \"1 s\"; units: s, ms, min, h"));
}

TEST(SceneErrorTexts, BareNumber) {
  EXPECT_THAT(folder().errors("[[person]]\nname = \"pedestrian\"\nspeed = 40\n"),
              ElementsAre("case.toml:3:9: person.pedestrian.speed = 40 needs a unit: write \"40 km/h\" or \"11.1 m/s\""));
}

TEST(SceneErrorTexts, StepOfZero) {
  EXPECT_THAT(
      folder().errors("[simulation]\nstep = \"0 s\"\n"),
      ElementsAre("case.toml:2:8: simulation.step is \"0 s\": must be greater than 0 and at most 0.1 s; 1 ms is a good start"));
}

TEST(SceneErrorTexts, NotANumber) {
  EXPECT_THAT(folder().errors(kBall + "friction = nan\n"),
              ElementsAre("case.toml:5:12: body.ball.friction is nan: must be a finite decimal number"));
  EXPECT_THAT(folder().errors(kBall + "friction = 0x10\n"),
              ElementsAre("case.toml:5:12: body.ball.friction is 16: must be a finite decimal number"));
}

TEST(SceneErrorTexts, MissingMesh) {
  EXPECT_THAT(
      folder().errors("[[body]]\nname = \"rock\"\nmass = \"1 kg\"\ninertia = \"1 1 1 kg m^2\"\nmesh = \"rock.obj\"\n"),
      ElementsAre(
          "case.toml:5:8: body.rock.mesh is \"rock.obj\": must be a mesh file; there is no rock.obj and no " CRASHREEL_SOURCE_DIR
          "/rock.obj"));
}

TEST(SceneErrorTexts, OddPictureWidth) {
  EXPECT_THAT(folder().errors("[output]\nwidth = 641\n"),
              ElementsAre("case.toml:2:9: output.width is 641: must be even; the video's colour is stored for pairs of pixels"));
}

TEST(SceneErrorTexts, PoseOutsideTheRangeOfMotionNamesTheJoint) {
  EXPECT_THAT(
      folder().errors("[[person]]\nname = \"p\"\n[person.angles]\nleft_knee_flexion = \"-20 deg\"\n"),
      ElementsAre("case.toml:4:21: person.p.angles.left_knee_flexion is \"-20 deg\": must lie in 0..140 deg; that is the range of "
                  "flexion of joint left_knee"));
}

TEST(SceneErrorTexts, ComeSeveralAtOnceInTheOrderOfTheFile) {
  EXPECT_THAT(
      folder().errors("[simulation]\nstep = 1\nduraton = \"4 s\"\n" + kBall + "restitution = -0.2\n[[joint]]\nchild = \"bal\"\n"),
      ElementsAre("case.toml:2:8: simulation.step = 1 needs a unit: write \"1 ms\"",
                  "case.toml:3:1: simulation.duraton is not a known key; did you mean \"duration\"?",
                  "case.toml:8:15: body.ball.restitution is -0.2: must lie in 0..1",
                  "case.toml:10:9: joint.0.child is \"bal\": is no body of the scene; did you mean \"ball\"?"));
}

TEST(Overrides, ReachElementsByNameAndNumber) {
  const Scene scene = folder().load(kBall, {"bodies.ball.mass=3 kg", "body.0.velocity=\"1 2 3 m/s\"", "simulation.step='2 ms'"});
  EXPECT_EQ(scene.model.bodies[0].mass, 3);
  EXPECT_EQ(scene.model.bodies[0].V_WB.v, engine::Vec3(1, 2, 3));
  EXPECT_EQ(scene.model.settings.step, 2e-3);
}

TEST(Overrides, AreNamedInErrors) {
  EXPECT_THAT(folder().errors(kBall, {"body.ball.mass=0"}),
              ElementsAre("--set body.ball.mass=0: body.ball.mass is 0: must be greater than 0 kg"));
  EXPECT_THAT(folder().errors(kBall, {"body.bell.mass=1 kg"}),
              ElementsAre("--set body.bell.mass=1 kg: there is no body named or numbered \"bell\"; the scene has ball"));
  EXPECT_THAT(folder().errors(kBall, {"nonsense"}),
              ElementsAre("--set nonsense: must be path.to.key=value; write --set simulation.step='0.5 ms'"));
}

TEST(SceneHash, IsThatOfTheFileAndItsOverrides) {
  const Scene plain = folder().load(kBall);
  const Scene changed = folder().load(kBall, {"body.ball.mass=2 kg"});
  EXPECT_EQ(plain.sha256.size(), 64u);
  EXPECT_EQ(plain.sha256, folder().load(kBall).sha256);
  EXPECT_NE(plain.sha256, changed.sha256);
}

TEST(Library, GivesAMassOfTheScenesTheInertiaOfTheModelInProportion) {
  const auto body = [](const std::string& keys) {
    return folder().load("[[vehicle]]\nname = \"van\"\nmodel = \"van\"\n" + keys).model.bodies.at(0);
  };
  const engine::Body own = body(""), laden = body("mass = \"3500 kg\"\n");
  EXPECT_TRUE(laden.inertia_B.isApprox(3500 / own.mass * own.inertia_B, 1e-12));
  const engine::Body given = body("mass = \"3500 kg\"\ninertia = \"1300 6500 6700 kg m^2\"\n");
  EXPECT_EQ(given.inertia_B.diagonal(), engine::Vec3(1300, 6500, 6700));
  const engine::Body same = body("mass = \"2500 kg\"\n");
  EXPECT_EQ(same.inertia_B, own.inertia_B);
  // it stands as high, its wheels' loads being found for the mass it has
  EXPECT_EQ(laden.X_WB.p, own.X_WB.p);
}

TEST(Library, IsNotHiddenByASceneOfTheSameName) {
  const scenes::testing::SceneFolder own;
  const std::string scene = "[[person]]\nname = \"rider\"\npose = \"cyclist\"\nposition = \"0 0 m\"\n";
  own.write("cyclist.toml", scene);  // a case of that name beside the scene
  EXPECT_THAT(own.errors(scene), ElementsAre());
  own.write("cyclist.toml", "[angles]\nright_elbow_flexion = \"400 deg\"\n");  // a pose of one's own still goes first
  EXPECT_EQ(own.errors(scene).size(), 1u);
}

}  // namespace
}  // namespace scenes
