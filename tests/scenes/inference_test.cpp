// [variables], [[uncertain]] and [[evidence]]: what they read as, and what their authors are told.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "scene_file.h"

namespace scenes {
namespace {

using scenes::testing::folder;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string kPuck = "[[body]]\nname = \"puck\"\nmass = \"1 kg\"\naxes = \"0.1 0.1 0.1 m\"\n";

TEST(Variables, ValuesFollowFromThem) {
  const Scene scene = folder().load(
      "[variables]\nspeed = \"36 km/h\"\ndistance = \"speed^2 / (2 * mu * 9.81 m/s^2)\"\nmu = 0.5\n" + kPuck +
      "position = [\"-0.432 s * speed\", \"-(distance + 1 m)\", \"0.1 m\"]\nvelocity = \"speed * cos(60 deg), -speed, 0\"\n"
      "friction = \"mu / 2\"\n");
  const auto& body = scene.model.bodies.at(0);
  EXPECT_DOUBLE_EQ(body.X_WB.p.x(), -4.32);
  EXPECT_DOUBLE_EQ(body.X_WB.p.y(), -(100 / 9.81 + 1));
  EXPECT_NEAR(body.V_WB.v.x(), 5, 1e-14);  // cos 60 deg rounds
  EXPECT_DOUBLE_EQ(body.V_WB.v.y(), -10);
  EXPECT_DOUBLE_EQ(body.surface.friction_ground.at(0), 0.25);
}

TEST(Variables, AnOverrideOfOneMovesAll) {
  const Scene scene = folder().load("[variables]\nspeed = \"36 km/h\"\n" + kPuck + "position = [\"-1 s * speed\", 0, \"0.1 m\"]\n",
                                    {"variables.speed=\"20 m/s\""});
  EXPECT_DOUBLE_EQ(scene.model.bodies.at(0).X_WB.p.x(), -20);
}

TEST(Variables, ErrorsNameThePlace) {
  const auto errors = [](const std::string& variables, const std::string& position) {
    return folder().errors("[variables]\n" + variables + kPuck + "position = " + position + "\n");
  };
  EXPECT_THAT(errors("speed = \"40 km/h\"\n", "[\"2 s * sped\", 0, 0]"),
              ElementsAre("case.toml:7:13: body.puck.position[0] = \"2 s * sped\" has \"sped\", which is neither a unit nor one of "
                          "[variables]; did you mean \"speed\"?"));
  EXPECT_THAT(errors("speed = \"40 km/h\"\n", "[\"speed\", 0, 0]"),
              ElementsAre("case.toml:7:13: body.puck.position[0] = \"speed\" is a speed, must be a length"));
  EXPECT_THAT(errors("a = \"b\"\nb = \"2 * a\"\n", "\"0 0 1 m\""),
              ElementsAre("case.toml:2:5: variables.a = \"b\" goes in a circle: a depends on itself",
                          "case.toml:3:5: variables.b = \"2 * a\" goes in a circle: b depends on itself"));
  EXPECT_THAT(errors("length = \"1 m\"\nwait = \"2 s\"\n", "[\"length + wait\", 0, 0]"),
              ElementsAre("case.toml:8:13: body.puck.position[0] = \"length + wait\" adds a length and a time"));
  EXPECT_THAT(errors("km = \"1 m\"\n", "\"0 0 1 m\""),
              ElementsAre("case.toml:2:1: variables.km has the name of a unit; take a longer one"));
  EXPECT_THAT(errors("time = \"1 s\"\n", "[\"1 m / (time - time) * 1 s\", 0, 0]"), ElementsAre(HasSubstr("has no finite value")));
}

TEST(Uncertain, IsReadInTheUnitsOfItsKey) {
  const Scene scene = folder().load(
      "[variables]\nspeed = \"30 mph\"\n[[uncertain]]\nkey = \"variables.speed\"\nuniform = \"20 40 mph\"\n"
      "[[uncertain]]\nkey = \"bodies.puck.mass\"\nnormal = [\"10 kg\", \"500 g\"]\n"
      "[uncertain.correlation]\n\"variables.speed\" = 0.5\n" +
      kPuck + "velocity = [\"speed\", 0, 0]\n");
  const auto& all = scene.inference.uncertain;
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].si_unit, "m/s");
  EXPECT_EQ(all[0].unit.name, "mph");
  EXPECT_DOUBLE_EQ(all[0].numbers[0], 20 * 0.44704);
  EXPECT_DOUBLE_EQ(all[1].numbers[1], 0.5);
  EXPECT_THAT(all[1].correlation, ElementsAre(std::pair<std::string, double>("variables.speed", 0.5)));
}

TEST(Uncertain, SaysWhatIsWrong) {
  const auto errors = [](const std::string& uncertain) { return folder().errors("[[uncertain]]\n" + uncertain + kPuck); };
  EXPECT_THAT(
      errors("key = \"body.puck.mass\"\nuniform = \"-10 80 kg\"\n"),
      ElementsAre(
          "case.toml:3:11: uncertain.0.uniform is \"-10 80 kg\": reaches -10 kg, but body.puck.mass must be greater than 0 kg"));
  EXPECT_THAT(errors("key = \"body.puck.mass\"\nnormal = \"10 3 kg\"\n"),
              ElementsAre(HasSubstr("say what is possible with `within`")));
  EXPECT_THAT(errors("key = \"body.puk.mass\"\nuniform = \"1 2 kg\"\n"), ElementsAre(HasSubstr("it has puck")));
  EXPECT_THAT(errors("key = \"body.puck.masss\"\nuniform = \"1 2 kg\"\n"), ElementsAre(HasSubstr("did you mean \"mass\"?")));
  EXPECT_THAT(errors("key = \"body.puck.mass\"\nuniform = \"1 2 kg\"\nnormal = \"1 0.1 kg\"\n"),
              ElementsAre(HasSubstr("give one of them")));
  EXPECT_THAT(errors("key = \"body.puck.mass\"\nuniform = \"1-2 kg\"\n"),
              ElementsAre(HasSubstr("must be two values, the lower one first, as in \"20 60 km/h\"")));
  EXPECT_THAT(errors("key = \"body.puck.mass\"\nuniform = \"1 2 m\"\n"), ElementsAre(HasSubstr("must end in a unit of mass")));
  EXPECT_THAT(errors("key = \"body.puck.mass\"\n"), ElementsAre(HasSubstr("says nothing of body.puck.mass; give one of uniform")));
}

TEST(Uncertain, AKeyThatDoesNotExistIsToldWithThoseThatDo) {
  const auto errors = [](const std::string& key) {
    return folder().errors("[variables]\nspeed = \"30 mph\"\n[[uncertain]]\nkey = \"" + key + "\"\nuniform = \"1 2 m/s\"\n" +
                           kPuck);
  };
  EXPECT_THAT(
      errors("variables.sped"),
      ElementsAre("case.toml:4:7: uncertain.0.key is \"variables.sped\": names no variable: [variables] has no \"sped\"; it has "
                  "speed"));
  EXPECT_THAT(
      errors("body.puk.mass"),
      ElementsAre("case.toml:4:7: uncertain.0.key is \"body.puk.mass\": names no body of the scene: none is called or numbered "
                  "\"puk\"; it has puck"));
}

TEST(Uncertain, CorrelationsThatContradictEachOtherAreRefused) {
  // a goes with b and with c, so b and c cannot go against each other
  const std::string text =
      "[variables]\na = 1\nb = 1\nc = 1\n"
      "[[uncertain]]\nkey = \"variables.a\"\nuniform = \"0 1\"\n"
      "[uncertain.correlation]\n\"variables.b\" = 0.9\n\"variables.c\" = 0.9\n"
      "[[uncertain]]\nkey = \"variables.b\"\nuniform = \"0 1\"\n[uncertain.correlation]\n\"variables.c\" = -0.9\n"
      "[[uncertain]]\nkey = \"variables.c\"\nuniform = \"0 1\"\n";
  EXPECT_THAT(
      folder().errors(text + kPuck + "friction = \"(a + b + c) / 3\"\n"),
      ElementsAre(HasSubstr("contradicts the others: no quantities can be correlated so among each other; make one smaller")));
}

TEST(Evidence, IsReadInTheUnitOfItsMeasure) {
  const Scene scene = folder().load(
      "[[evidence]]\nname = \"slide\"\nmetric = \"travel\"\nof = \"puck\"\nvalue = \"20 ft\"\ntolerance = \"1 ft\"\n"
      "[[evidence]]\nname = \"turned\"\nmetric = \"turned\"\nvalue = \"90 deg\"\ntolerance = \"5 deg\"\n"
      "[[evidence]]\nname = \"scuff\"\nmark = [\"0 0 m\", \"3 1 m\"]\nof = \"puck\"\ntolerance = \"0.2 m\"\n"
      "[[evidence]]\nname = \"rest\"\nmetric = \"rest_place\"\nof = \"puck\"\nvalue = \"3 1 m\"\ntolerance = \"20 cm\"\n"
      "[[evidence]]\nname = \"down\"\nmetric = \"landing\"\nvalue = \"1.2 s\"\ntolerance = \"50 ms\"\n"
      "[[evidence]]\nname = \"how far\"\nmetric = \"landing\"\nvalue = \"3 m\"\ntolerance = \"50 cm\"\n" +
      kPuck);
  const auto& all = scene.inference.evidence;
  ASSERT_EQ(all.size(), 6u);
  EXPECT_EQ(all[0].metric, "travel_m");
  EXPECT_DOUBLE_EQ(all[0].value[0], 6.096);
  EXPECT_EQ(all[1].metric, "turned_deg");
  EXPECT_NEAR(all[1].value[0], 90, 1e-12);
  EXPECT_EQ(all[2].mark.size(), 2u);
  EXPECT_EQ(all[3].seen, Seen::rest_place);
  EXPECT_DOUBLE_EQ(all[3].tolerance, 0.2);
  EXPECT_EQ(all[4].metric, "landing_s");
  EXPECT_EQ(all[5].metric, "landing_m");
}

TEST(Evidence, SaysWhatIsWrong) {
  const auto errors = [](const std::string& evidence) {
    return folder().errors("[[evidence]]\nname = \"x\"\n" + evidence + kPuck);
  };
  EXPECT_THAT(errors("metric = \"travel\"\nvalue = \"2 m\"\ntolerance = \"0 m\"\n"),
              ElementsAre(HasSubstr("nothing is measured without error")));
  EXPECT_THAT(errors("metric = \"travel\"\nvalue = \"2 m\"\ntolerance = \"1 s\"\n"),
              ElementsAre(AllOf(HasSubstr("evidence.x.tolerance is \"1 s\": must "), HasSubstr("length"))));
  EXPECT_THAT(errors("metric = \"travel\"\nvalue = \"2 m\"\ntolerance = 0.5\n"),
              ElementsAre(AllOf(HasSubstr(":5:13: evidence.x.tolerance"), HasSubstr("\"0.5 m\""))));
  EXPECT_THAT(errors("metric = \"travel\"\nvalue = \"5,8 m\"\ntolerance = \"1 m\"\n"),
              ElementsAre(AllOf(HasSubstr(":4:9: evidence.x.value is \"5,8 m\": "), HasSubstr("write \"5.8 m\""))));
  EXPECT_THAT(errors("metric = \"travl\"\nvalue = \"2 m\"\ntolerance = \"1 m\"\n"),
              ElementsAre("case.toml:3:10: evidence.x.metric is \"travl\": is no measure; did you mean \"travel\"?; "
                          "`crashreel explain all` lists them"));
  EXPECT_THAT(errors("metric = \"travel\"\nvalue = \"2 m\"\n"),
              ElementsAre(HasSubstr("evidence.x.tolerance is missing; [[evidence]] needs it")));
  EXPECT_THAT(errors("of = \"puk\"\nmetric = \"travel\"\nvalue = \"2 m\"\ntolerance = \"1 m\"\n"),
              ElementsAre(HasSubstr("did you mean \"puck\"?")));
  EXPECT_THAT(errors("value = \"2 m\"\ntolerance = \"1 m\"\n"), ElementsAre(HasSubstr("needs either a metric or a mark")));
}

TEST(JsonSchema, TakesExpressionsWhereNumbersStand) {
  const auto schema = nlohmann::json::parse(json_schema());
  EXPECT_TRUE(schema["properties"]["uncertain"]["items"]["properties"].contains("log_normal"));
  EXPECT_NE(schema["properties"]["body"]["items"]["properties"]["mass"]["anyOf"].dump().find("a-z"), std::string::npos);
}

}  // namespace
}  // namespace scenes
