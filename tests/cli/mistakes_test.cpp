// The slips of a first day: each is told by its cause and with what to write instead, with the line and a mark under the place.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/program.h"
#include "tests/cli/slip.h"

using namespace cli_tests;
using testing::HasSubstr;
using testing::StartsWith;
using Json = nlohmann::json;

namespace {

class SlipIsTold : public testing::TestWithParam<Slip> {};

}  // namespace

TEST_P(SlipIsTold, WithItsLineAndTheRemedy) {
  const Folder folder;
  expect_told(folder, GetParam());
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, SlipIsTold,
    testing::ValuesIn(std::vector<Slip>{
        Slip{"forgotten_quotes", kPerson + "speed = 40 km/h\n",
             "a.toml:3:12: 40 km/h needs quotes; write speed = \"40 km/h\"\n    3 | speed = 40 km/h\n      |            ^\n"},
        Slip{"forgotten_quotes_of_a_word", kPerson + "pose = standing\n",
             "a.toml:3:8: standing needs quotes; write pose = \"standing\"\n    3 | pose = standing\n      |        ^\n"},
        Slip{
            "forgotten_quotes_and_a_remark", kPerson + "speed = 40 km/h # fast\n",
            "a.toml:3:12: 40 km/h needs quotes; write speed = \"40 km/h\"\n    3 | speed = 40 km/h # fast\n      |            ^\n"},
        Slip{"typographic_quotes", kPerson + "speed = \u201c40 km/h\u201d\n",
             "a.toml:3:9: typographic quotes; write straight ones: speed = \"40 km/h\"\n    3 | speed = \u201c40 km/h\u201d\n      "
             "| "
             "        ^\n"},
        Slip{"no_closing_quote", kPerson + "pose = \"standing\n",
             "a.toml:3:17: the text has no closing quote; write pose = \"standing\"\n    3 | pose = \"standing\n      |        "
             "         ^\n"},
        Slip{"decimal_comma", kPerson + "speed = \"40,5 km/h\"\n",
             "a.toml:3:9: person.p.speed is \"40,5 km/h\": has a decimal comma; write \"40.5 km/h\"\n    3 | speed = \"40,5 "
             "km/h\"\n      |         ^\n"},
        Slip{"decimal_comma_of_a_number", kPerson + "friction = 0,5\n",
             "a.toml:3:13: 0,5 has a decimal comma; write friction = 0.5\n    3 | friction = 0,5\n      |             ^\n"},
        Slip{"commas_between_numbers", kPerson + "position = \"-1.1, -1.75 m\"\n",
             "a.toml:3:12: person.p.position is \"-1.1, -1.75 m\": has commas between its numbers; write \"-1.1 -1.75 m\"\n    3 | "
             "position = \"-1.1, -1.75 m\"\n      |            ^\n"},
        Slip{"title_twice", "title = \"a\"\ntitle = \"b\"\n" + kPerson,
             "a.toml:2:9: title is given twice, first in line 1; keep one of them\n    2 | title = \"b\"\n      |         ^\n"},
        Slip{"section_twice", "[simulation]\nstep = \"1 ms\"\n[simulation]\nduration = \"1 s\"\n",
             "a.toml:3:1: [simulation] is given twice, first in line 1; put the keys of both under one of them\n    3 | "
             "[simulation]\n      | ^\n"},
        Slip{"open_bracket", "[simulation\n",
             "a.toml:1:12: the section's bracket is not closed; write [simulation]\n    1 | [simulation\n      |            ^\n"},
        Slip{"no_equals_sign", kPerson + "speed \"4 km/h\"\n",
             "a.toml:3:7: there is no = between key and value; write speed = \"4 km/h\"\n    3 | speed \"4 km/h\"\n      |       "
             "^\n"},
        Slip{"no_value", kPerson + "speed =\n", "a.toml:3:8: speed has no value\n    3 | speed =\n      |        ^\n"},
        Slip{"stature_in_centimetres", kPerson + "stature = \"178\"\n",
             "a.toml:3:11: person.p.stature is \"178\": needs a unit: write \"178 cm\"\n    3 | stature = \"178\"\n      |         "
             "  "
             "^\n"},
        Slip{"bare_stature", kPerson + "stature = 178\n",
             "a.toml:3:11: person.p.stature = 178 needs a unit: write \"178 cm\"\n    3 | stature = 178\n      |           ^\n"},
        Slip{"bare_speed", kPerson + "speed = 4\n",
             "a.toml:3:9: person.p.speed = 4 needs a unit: write \"4 km/h\" or \"1.11 m/s\"\n    3 | speed = 4\n      |         "
             "^\n"},
        Slip{"capital_unit", kPerson + "speed = \"40 Km/h\"\n",
             "a.toml:3:9: person.p.speed is \"40 Km/h\": \"Km\" is not a unit; did you mean \"40 km/h\"?\n    3 | speed = \"40 "
             "Km/h\"\n      |         ^\n"},
        Slip{"unit_without_slash", kPerson + "speed = \"40 kmh\"\n",
             "a.toml:3:9: person.p.speed is \"40 kmh\": \"kmh\" is not a unit; did you mean \"40 km/h\"?\n    3 | speed = \"40 "
             "kmh\"\n      |         ^\n"},
        Slip{"a_unit_nobody_knows", kPerson + "speed = \"40 foo\"\n",
             "a.toml:3:9: person.p.speed is \"40 foo\": \"foo\" is not a unit; must be a speed; write it like \"1 km/h\"; units: "
             "km/h, m/s, mph, ft/s\n    3 | speed = \"40 foo\"\n      |         ^\n"},
        Slip{"feet_and_inches", kPerson + "stature = \"5ft9\"\n",
             "a.toml:3:11: person.p.stature is \"5ft9\": 9 has no unit; write \"5ft 9 in\"\n    3 | stature = \"5ft9\"\n      | "
             "          ^\n"},
        Slip{
            "metres_and_centimetres", kPerson + "stature = \"1 m 78\"\n",
            "a.toml:3:11: person.p.stature is \"1 m 78\": 78 has no unit; write \"1 m 78 cm\"\n    3 | stature = \"1 m 78\"\n      "
            "|           ^\n"},
        Slip{
            "minutes_and_seconds", kPerson + "[simulation]\nduration = \"1 min 3\"\n",
            "a.toml:4:12: simulation.duration is \"1 min 3\": 3 has no unit; write \"1 min 3 s\"\n    4 | duration = \"1 min 3\"\n "
            "     |            ^\n"},
        Slip{"a_number_after_what_nothing_follows", kPerson + "speed = \"4 km/h 2\"\n",
             "a.toml:3:9: person.p.speed is \"4 km/h 2\": 2 has no unit\n    3 | speed = \"4 km/h 2\"\n      |         ^\n"},
        Slip{"a_deceleration_in_g",
             "[[vehicle]]\nname = \"car\"\nmodel = \"sedan\"\n[vehicle.brake]\nfrom = \"0 s\"\ndeceleration = 0.7\n",
             "a.toml:6:16: vehicle.car.brake.deceleration = 0.7 needs a unit: write \"0.7 g\" or \"6.87 m/s^2\"\n    6 | "
             "deceleration = "
             "0.7\n      |                ^\n"},
        Slip{"a_deceleration_in_metres",
             "[[vehicle]]\nname = \"car\"\nmodel = \"sedan\"\n[vehicle.brake]\nfrom = \"0 s\"\ndeceleration = 7\n",
             "a.toml:6:16: vehicle.car.brake.deceleration = 7 needs a unit: write \"7 m/s^2\" or \"0.714 g\"\n    6 | deceleration "
             "= "
             "7\n      |                ^\n"},
        Slip{"a_camera_that_follows_nobody", kPerson + "[[camera]]\nname = \"c\"\nkind = \"follow\"\nfollow = \"pp\"\n",
             "a.toml:6:10: camera.c.follow is \"pp\": is no body, vehicle or person of the scene; did you mean \"p\"?\n    6 | "
             "follow = "
             "\"pp\"\n      |          ^\n"},
        Slip{
            "knots", kPerson + "speed = \"8 kn\"\n",
            "a.toml:3:9: person.p.speed is \"8 kn\": \"kn\" is not a unit; a knot is 1.852 km/h\n    3 | speed = \"8 kn\"\n      | "
            "        ^\n"},
        Slip{
            "wrong_dimension", kPerson + "speed = \"4 kg\"\n",
            "a.toml:3:9: person.p.speed is \"4 kg\": must be a speed; write it like \"1 km/h\"; units: km/h, m/s, mph, ft/s\n    3 "
            "| speed = \"4 kg\"\n      |         ^\n"},
        Slip{"negative_mass_is_one_error", kPerson + "mass = \"-70 kg\"\n",
             "a.toml:3:8: person.p.mass is \"-70 kg\": must be greater than 0 kg\n    3 | mass = \"-70 kg\"\n      |        ^\n"},
        Slip{"a_person_called_like_a_vehicle", "[[vehicle]]\nname = \"p\"\nmodel = \"sedan\"\n" + kPerson,
             "a.toml:5:8: person.name \"p\" is already used by a vehicle; every vehicle, person and body needs a name of its own\n "
             "  "
             " 5 | name = \"p\"\n      |        ^\n"},
        Slip{"an_empty_scene", "title = \"Nothing\"\n",
             "a.toml: the scene is empty; add a [[vehicle]], a [[person]] or a [[body]]\n"},
        Slip{"utf_16", std::string("\xff\xfe[\0", 4), "a.toml: is written in UTF-16; save it as UTF-8\n"},
        Slip{"latin_1",
             "# speed of the car\ntitle = \"Stra\xdf"
             "e\"\n",
             "a.toml:2: holds a letter that is not UTF-8, as files in Latin-1 or Windows-1252 do; save the file as UTF-8\n    2 | "
             "title = \"Stra\xdf"
             "e\"\n"},
        Slip{"a_program",
             std::string("\x7f"
                         "ELF\0\1",
                         6),
             "a.toml: is a binary file, no scene file\n"},
        Slip{"a_picture", "\x89PNG\r\n\x1a\n", "a.toml: is a PNG picture, no scene file\n"},
        Slip{"a_pose_nobody_has", kPerson + "pose = \"standin\"\n",
             "a.toml:3:8: person.p.pose is \"standin\": there is no such pose; did you mean \"standing\"? available: cat, cyclist, "
             "leaning, lying_prone, lying_supine, motorcyclist, prayer, running, sitting, sitting_upright, standing, walking_left, "
             "walking_right\n    3 | pose = \"standin\"\n      |        ^\n"}}),
    [](const auto& slip) { return slip.param.name; });

TEST(Mistakes, ASceneFileThatIsNotThere) {
  const Folder folder;
  folder.write("case.toml", kBall);
  EXPECT_EQ(run(folder, {"check", "nosuch.toml"}).err, "nosuch.toml: there is no such file\n");
  EXPECT_EQ(run(folder, {"check", "cas.toml"}).err, "cas.toml: there is no such file; did you mean case.toml?\n");
  EXPECT_EQ(run(folder, {"check", "lane1.toml"}).err, "lane1.toml: there is no such file\n");
  folder.write("my case.toml", kBall);
  EXPECT_EQ(run(folder, {"check", "my"}).err,
            "my: there is no such file; did you mean \"my case.toml\"? A name with spaces stands in quotes\n");
  EXPECT_EQ(run(folder, {"check", "."}).err, ".: is a folder; name a scene file in it\n");
  EXPECT_EQ(run(folder, {"check", "-"}).err, "-: there is no such file; standard input is /dev/stdin\n");
  EXPECT_EQ(run(folder, {"check", "none/case.toml"}).err,
            "none/case.toml: there is no such file; there is no folder none either\n");
}

TEST(Mistakes, APictureThatIsNoPngIsToldByItsKind) {
  const Folder folder;
  folder.write("photo.png", "\xff\xd8\xff\xe0 and more of it");
  folder.write("text.png", "not a picture at all");
  const Result jpeg = run(folder, {"compare", "photo.png", "photo.png"});
  EXPECT_EQ(jpeg.code, 3);
  EXPECT_EQ(jpeg.err, "crashreel: cannot read photo.png: it is a JPEG picture, only PNG is read; convert it\n");
  EXPECT_EQ(run(folder, {"compare", "text.png", "text.png"}).err,
            "crashreel: cannot read text.png: it is no PNG picture; convert it to PNG\n");
}

TEST(Mistakes, AMeshOfPointsIsToldWhatItLacks) {
  const Folder folder;
  folder.write(
      "scan.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n1 0 "
      "0\n0 1 0\n");
  folder.write("text.obj", "x\n");
  for (const auto& [file, told] : {std::pair("scan.ply", "holds points or lines but no triangles; a scan must be meshed first"),
                                   std::pair("text.obj", "is no .obj file; its name and its content disagree")}) {
    folder.write("a.toml",
                 ball_with("axes = \"0.1 0.1 0.1 m\"", std::string("inertia = \"1 1 1 kg m^2\"\nmesh = \"") + file + "\""));
    const Result result = run(folder, {"check", "a.toml"});
    EXPECT_EQ(result.code, 2);
    EXPECT_THAT(result.err, HasSubstr(told)) << file;
  }
}

TEST(Mistakes, APictureThatCannotBeWrittenIsToldTheCause) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  // a limit on files stands for a full disk: the call that writes fails in the same place
  const std::string command = "cd " + folder.path().string() + " && bash -c 'ulimit -f 1; exec " + program() +
                              " render ball.toml --at 0.1s --size 256x256 -o a.png' >/dev/null 2>.stderr";
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 3);
  EXPECT_THAT(contents(folder / ".stderr"), HasSubstr("File too large"));
}

TEST(Mistakes, OptionsThatMeanAValueOfTheScene) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  EXPECT_EQ(
      run(folder, {"render", "ball.toml", "--speed", "50"}).err,
      "crashreel render: unknown option --speed; values of the scene are changed by --set, like --set vehicle.sedan.speed=\"50 "
      "km/h\"\n");
  EXPECT_EQ(run(folder, {"check", "ball.toml", "--set", "body.bal.mass=1 kg"}).err,
            "crashreel: --set body.bal.mass=1 kg: there is no body named or numbered \"bal\"; the scene has ball\n");
  EXPECT_EQ(run(folder, {"check", "ball.toml", "--set", "ball.mass=1 kg"}).err,
            "crashreel: --set ball.mass=1 kg: there is no section ball; did you mean body.ball.mass?\n");
}

TEST(Mistakes, AKeyInTheWrongPlaceIsToldItsPlace) {
  const Folder folder;
  const std::string car = "[[vehicle]]\nname = \"car\"\nmodel = \"sedan\"\n";
  const auto told = [&folder](const std::string& scene) {
    folder.write("a.toml", scene);
    return run(folder, {"check", "a.toml"}).err;
  };
  EXPECT_THAT(told(car + "[[pedestrian]]\nname = \"p\"\n"), HasSubstr("pedestrian is not a known key; did you mean [[person]]?"));
  EXPECT_THAT(told(car + "[[driver]]\nfrom = \"1 s\"\n"), HasSubstr("driver is not a known key; did you mean [[vehicle.driver]]?"));
  EXPECT_THAT(told(car + "[[vehicle.driver]]\nfrom = \"1 s\"\ndeceleration = \"4 m/s^2\"\n"),
              HasSubstr("deceleration is not a known key; [[vehicle.driver]] has "));
  EXPECT_THAT(told("banana = 1\n" + car),
              HasSubstr("banana is not a known key; the keys at the top of the file are in scenes/README.md"));
  EXPECT_THAT(told(car + "[[camera]]\nname = \"c\"\nlens = \"28\"\n"), HasSubstr("needs a unit: write \"28 mm\"\n"));
}

TEST(Mistakes, AMeshThatIsMissingIsToldBesideWhatElseIs) {
  const Folder folder;
  folder.write("a.toml", "[[vehicle]]\nname = \"car\"\nmesh = \"nosuch.obj\"\n");
  const Result result = run(folder, {"check", "a.toml"});
  EXPECT_EQ(result.code, 2);
  EXPECT_THAT(result.err, HasSubstr("a.toml:1:1: vehicle.car.mass is missing; write like mass = \"1500 kg\""));
  EXPECT_THAT(result.err, HasSubstr("a.toml:3:8: vehicle.car.mesh is \"nosuch.obj\": "));
}

TEST(Mistakes, WhoReadsNoFurtherHearsNoComplaint) {
  const Folder folder;
  const std::string command =
      "cd " + folder.path().string() + " && { " + program() + " schema 2>.stderr; echo $? >code; } | head -c 100 >/dev/null";
  EXPECT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(contents(folder / "code"), "141\n");
  EXPECT_EQ(contents(folder / ".stderr"), "");
}

TEST(Mistakes, TheSameMomentTwiceIsOnePicture) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  const Result result = run(
      folder, {"render", "ball.toml", "--at", "0.1s", "--at", "0.1s", "--at", "0.2", "--size", "64x64", "-o", "a.png", "--json"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(Json::parse(result.out)["files"], Json::array({"a_0.100s.png", "a_0.200s.png"}));
}

TEST(Mistakes, InputsAndTargetsAreCheckedBeforeTheFirstRun) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  const Result unit = run(folder, {"study", "ball.toml", "-o", "out", "--input", "body.ball.mass=2..3"});
  EXPECT_EQ(unit.code, 2);
  EXPECT_EQ(unit.err, "crashreel: --input body.ball.mass=2..3: body.ball.mass = 2 needs a unit: write \"2 kg\" or \"4.41 lb\"\n");
  const Result target = run(folder, {"study", "ball.toml", "-o", "out", "--target", "travl_m=1cm"});
  EXPECT_EQ(target.code, 2);
  EXPECT_THAT(target.err, StartsWith("crashreel: --target: the scene has no measure travl_m; did you mean travel_m?"));
  const Result part = run(folder, {"study", "ball.toml", "-o", "out", "--target", "energy=1m"});
  EXPECT_THAT(part.err, StartsWith("crashreel: --target: the scene has no measure energy; did you mean energy_residual_J?"));
  EXPECT_FALSE(std::filesystem::exists(folder / "out/runs")) << "nothing was run";
}

TEST(Mistakes, CheckGivesScriptsFieldsInPlaceOfSentences) {
  const Folder folder;
  folder.write("a.toml", ball_with("\"2 kg\"", "2") + "[output]\nwidht = 3\n");
  const Result result = run(folder, {"check", "a.toml", "--json"});
  EXPECT_EQ(result.code, 2);
  const Json errors = Json::parse(result.out)[0]["errors"];
  ASSERT_EQ(errors.size(), 2U);
  EXPECT_EQ(errors[0]["file"], "a.toml");
  EXPECT_EQ(errors[0]["line"], 9);
  EXPECT_EQ(errors[0]["column"], 8);
  EXPECT_EQ(errors[0]["code"], "unit");
  EXPECT_EQ(errors[0]["message"], "body.ball.mass = 2 needs a unit: write \"2 kg\" or \"4.41 lb\"");
  EXPECT_EQ(errors[1]["code"], "unknown_key");
}

TEST(Render, SeveralCamerasShowOneRun) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  const Result result = run(folder, {"render", "ball.toml", "--camera", "side", "--camera", "front", "--eye", "2 -2 1 m", "--at",
                                     "0.1s", "--size", "64x64", "-o", "new/a.png", "--json", "-v"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(Json::parse(result.out)["files"], Json::array({"new/a_side.png", "new/a_front.png", "new/a_eye.png"}));
  EXPECT_NE(contents(folder / "new/a_side.png"), contents(folder / "new/a_front.png"));
  const std::string gravity = "effect gravity: ";
  const std::size_t planned = result.err.find(gravity), counted = result.err.find(gravity, planned + 1);
  EXPECT_EQ(result.err.find(gravity, counted + 1), std::string::npos) << "simulated once, for all three";
}

TEST(Render, ARunsFolderStandsForItsScene) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  const std::vector<std::string> still = {"--at", "0.1s", "--size", "64x64", "-q", "-o"};
  const auto render = [&](std::vector<std::string> arguments, const std::string& file) {
    arguments.insert(arguments.begin(), "render");
    arguments.insert(arguments.end(), still.begin(), still.end());
    arguments.push_back(file);
    return run(folder, arguments);
  };
  ASSERT_EQ(run(folder, {"simulate", "ball.toml", "-o", "out", "-q", "--set", "body.ball.velocity=2 0 0 m/s"}).code, 0);
  ASSERT_EQ(render({"out"}, "of_run.png").code, 0);
  ASSERT_EQ(render({"ball.toml", "--set", "body.ball.velocity=2 0 0 m/s"}, "of_scene.png").code, 0);
  EXPECT_EQ(run(folder, {"compare", "of_run.png", "of_scene.png"}).code, 0);
  const auto simulates = [&](const std::vector<std::string>& more, const std::string& file) {
    std::vector<std::string> arguments = {"out", "-v"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return render(arguments, file).err.find("effect gravity: 1") != std::string::npos;
  };
  EXPECT_FALSE(simulates({}, "kept.png"));
  EXPECT_EQ(contents(folder / "kept.png"), contents(folder / "of_run.png"));
  EXPECT_TRUE(simulates({"--set", "body.ball.mass=3 kg"}, "other.png"));
  std::string bytes = contents(folder / "out/recording.bin");
  bytes[bytes.size() / 2] ^= 1;
  folder.write("out/recording.bin", bytes);
  EXPECT_TRUE(simulates({}, "damaged.png"));
  EXPECT_EQ(contents(folder / "damaged.png"), contents(folder / "of_run.png"));
  folder.write("ball.toml", ball_with("\"2 kg\"", "\"3 kg\""));
  const Result changed = render({"out"}, "later.png");
  EXPECT_EQ(changed.code, 2);
  EXPECT_EQ(changed.err, "crashreel: out holds a run of ball.toml, which has been changed since; name a scene file\n");
  // a summary that `simulate` never wrote stands for no scene
  const Result no_scene = [&] {
    folder.write("out/summary.json", "{}");
    return render({"out"}, "of_nothing.png");
  }();
  for (const char* of :
       {"{\"path\":5}", "{\"path\":\"ball.toml\",\"overrides\":\"a\"}", "{\"path\":\"ball.toml\",\"sha256\":[]}"}) {
    folder.write("out/summary.json", std::string("{\"scene\":") + of + "}");
    const Result odd = render({"out"}, "of_nothing.png");
    EXPECT_EQ(odd.code, 2) << of;
    EXPECT_EQ(odd.err, no_scene.err) << of;
  }
}

TEST(Render, TheTitleTellsWhatWasChanged) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  const std::vector<std::string> still = {"render", "ball.toml", "--at", "0.1s", "--size", "64x64", "-o"};
  const auto titled = [&](const std::string& file, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = still;
    arguments.push_back(file);
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(run(folder, arguments).code, 0);
    return contents(folder / file);
  };
  EXPECT_THAT(titled("a.png", {}), testing::Not(HasSubstr("changed")));
  EXPECT_THAT(titled("b.png", {"--set", "body.ball.mass=3 kg"}), HasSubstr("Ball [changed: body.ball.mass=3 kg]"));
}

TEST(Help, BeginsWithExamplesAndManualPagesSayTheSame) {
  const Folder folder;
  const Result help = run(folder, {"render", "--help"});
  EXPECT_LT(help.out.find("Examples"), help.out.find("Options"));
  EXPECT_EQ(run(folder, {"help", "render"}).out, help.out);
  const Result page = run(folder, {"man", "render"});
  EXPECT_THAT(page.out, StartsWith(".TH crashreel\\-render 1"));
  for (const char* section : {".SH NAME", ".SH SYNOPSIS", ".SH EXAMPLES", ".SH OPTIONS", ".SH EXIT STATUS", ".SH ENVIRONMENT"})
    EXPECT_THAT(page.out, HasSubstr(section));
  EXPECT_THAT(page.out, HasSubstr("\\-\\-look\\-at"));
  const std::string guide = std::string("See also: man crashreel-render, ") + CRASHREEL_SOURCE_DIR + "/scenes/GUIDE.md\n";
  EXPECT_THAT(help.out, testing::EndsWith(guide)) << "where it is, not where it would be in the source";
  EXPECT_EQ(run(folder, {"man", "rendr"}).err, "crashreel: unknown command rendr; did you mean render?\n");
  EXPECT_EQ(run(folder, {"help", "rendr"}).err, "crashreel: unknown command rendr; did you mean render?\n");
}

TEST(Help, CompletionsAreShellScripts) {
  const Folder folder;
  for (const char* shell : {"bash", "zsh", "fish"}) {
    const Result script = run(folder, {"completion", shell});
    ASSERT_EQ(script.code, 0) << shell;
    for (const char* word : {"simulate", "look-at", "draft standard fine"}) EXPECT_THAT(script.out, HasSubstr(word)) << shell;
    folder.write(shell, script.out);
  }
  const auto completed = [&folder](const std::string& words, const std::string& at) {
    const std::string bash = "cd " + folder.path().string() + " && bash -c '. ./bash && COMP_WORDS=(" + words +
                             ") COMP_CWORD=" + at + " && { _crashreel; echo ${COMPREPLY[*]}; }' >.stdout";
    EXPECT_EQ(std::system(bash.c_str()), 0);
    return contents(folder / ".stdout");
  };
  EXPECT_EQ(completed("crashreel rend", "1"), "render\n");
  EXPECT_EQ(completed("crashreel render --qual", "2"), "--quality\n");
  // names where a command asks for one
  EXPECT_EQ(completed("crashreel man sn", "2"), "snapshot\n");
  EXPECT_EQ(completed("crashreel explain wrap", "2"), "wrap_around_distance_m\n");
  EXPECT_EQ(completed("crashreel explain --js", "2"), "--json\n");
  EXPECT_EQ(completed("crashreel completion f", "2"), "fish\n");
  EXPECT_THAT(contents(folder / "zsh"), HasSubstr("'*: :(bash zsh fish)'"));
  EXPECT_THAT(contents(folder / "zsh"), HasSubstr("'render:simulate a scene, then draw it\\: an MP4"));
  EXPECT_THAT(contents(folder / "fish"), HasSubstr("'__fish_seen_subcommand_from completion' -f -a 'bash zsh fish'"));
  EXPECT_EQ(run(folder, {"completion", "csh"}).code, 2);
}

TEST(Version, IsAnOptionTooAndNamesTheCommit) {
  const Folder folder;
  const Result version = run(folder, {"--version"});
  EXPECT_EQ(version.code, 0);
  EXPECT_THAT(version.out, StartsWith("crashreel "));
  EXPECT_TRUE(Json::parse(run(folder, {"version", "--json"}).out).contains("commit"));
}
