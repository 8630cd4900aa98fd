// Slips beside those of a scene's first lines: whole sections, files that a scene names, times in the wrong order, outputs that
// cannot be written, a disk without room. Everything on standard error is compared, word for word.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/program.h"
#include "tests/cli/slip.h"

using namespace cli_tests;
using testing::HasSubstr;

namespace {

const std::string kCar = "[simulation]\nduration = \"1 s\"\n[[vehicle]]\nname = \"car\"\nmodel = \"sedan\"\n";
const std::string kMeshBall = "[[body]]\nname = \"ball\"\nmass = \"2 kg\"\ninertia = \"1 1 1 kg m^2\"\n";
const std::string kPoints =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n1 0 0\n0 1 "
    "0\n";

class SectionsAndFiles : public testing::TestWithParam<Slip> {};

}  // namespace

TEST_P(SectionsAndFiles, AreToldWithLineMarkAndRemedy) {
  const Folder folder;
  folder.write("scan.ply", kPoints);
  folder.write("text.obj", "x\n");
  folder.write("photo.jpg", "\xff\xd8\xff\xe0 and more of it");
  expect_told(folder, GetParam());
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, SectionsAndFiles,
    testing::ValuesIn(std::vector<Slip>{
        Slip{"a_section_mistyped", "[simulaton]\nstep = \"1 ms\"\n" + kPerson,
             "a.toml:1:2: simulaton is not a known key; did you mean \"simulation\"?\n    1 | [simulaton]\n      |  ^\n"},
        Slip{"one_bracket_for_two", "[person]\nname = \"p\"\n",
             "a.toml:1:1: person is a table: must be a list of tables, each written under [[person]]\n    1 | [person]\n      | "
             "^\n"},
        Slip{"a_mesh_of_points", kMeshBall + "mesh = \"scan.ply\"\n",
             "a.toml:5:8: body.ball.mesh is \"scan.ply\": holds points or lines but no triangles; a scan must be meshed first\n"
             "    5 | mesh = \"scan.ply\"\n      |        ^\n"},
        Slip{"text_for_a_mesh", kMeshBall + "mesh = \"text.obj\"\n",
             "a.toml:5:8: body.ball.mesh is \"text.obj\": is no .obj file; its name and its content disagree\n"
             "    5 | mesh = \"text.obj\"\n      |        ^\n"},
        Slip{"a_drawing_for_a_mesh", kMeshBall + "mesh = \"site.dxf\"\n",
             "a.toml:5:8: body.ball.mesh is \"site.dxf\": must be a mesh file of a known kind: .obj .stl .gltf .glb .dae .3ds .ac "
             ".fbx .off .ply .x\n    5 | mesh = \"site.dxf\"\n      |        ^\n"},
        Slip{"a_missing_mesh_beside_what_else_is_missing", "[[vehicle]]\nname = \"car\"\nmesh = \"nosuch.obj\"\n",
             "a.toml:1:1: vehicle.car.mass is missing; write like mass = \"1500 kg\", or name a model of the library\n"
             "    1 | [[vehicle]]\n      | ^\n"
             "a.toml:1:1: vehicle.car.cg is missing; write like cg = \"0.1 0 0.55 m\", or name a model of the library\n"
             "    1 | [[vehicle]]\n      | ^\n"
             "a.toml:1:1: vehicle.car.inertia is missing; write like inertia = \"550 2500 2700 kg m^2\", or name a model of the "
             "library\n    1 | [[vehicle]]\n      | ^\n"
             "a.toml:3:8: vehicle.car.mesh is \"nosuch.obj\": must be a mesh file; there is no nosuch.obj and "
             "no " CRASHREEL_SOURCE_DIR "/nosuch.obj\n    3 | mesh = \"nosuch.obj\"\n      |        ^\n"},
        Slip{"a_jpeg_for_a_picture_of_the_road", kPerson + "[road]\npicture = \"photo.jpg\"\n",
             "a.toml:4:11: road.picture is \"photo.jpg\": cannot read photo.jpg: it is a JPEG picture, only PNG is read; convert "
             "it\n    4 | picture = \"photo.jpg\"\n      |           ^\n"},
        Slip{"a_shot_by_no_camera", kPerson + "[[camera]]\nname = \"side\"\nkind = \"top\"\n[[shot]]\ncamera = \"sied\"\n",
             "a.toml:7:10: shot.0.camera is \"sied\": is no camera of the scene; did you mean \"side\"?\n    7 | camera = "
             "\"sied\"\n      |          ^\n"},
        Slip{"a_shot_by_a_preset", kPerson + "[[shot]]\ncamera = \"top\"\n",
             "a.toml:4:10: shot.0.camera is \"top\": is no camera of the scene; it has overview\n    4 | camera = \"top\"\n"
             "      |          ^\n"},
        Slip{"a_shot_without_camera", kPerson + "[[shot]]\ncamara = \"top\"\n",
             "a.toml:3:1: shot.0.camera is missing; [[shot]] needs a text\n    3 | [[shot]]\n      | ^\n"
             "a.toml:4:1: shot.0.camara is not a known key; did you mean \"camera\"?\n    4 | camara = \"top\"\n      | ^\n"},
        Slip{"a_shot_that_ends_before_it_begins",
             kPerson + "[[camera]]\nname = \"side\"\nkind = \"top\"\n[[shot]]\ncamera = \"side\"\nfrom = \"2 s\"\nto = \"1 s\"\n",
             "a.toml:9:6: shot.0.to is \"1 s\": must not be earlier than from\n    9 | to = \"1 s\"\n      |      ^\n"},
        Slip{"a_driver_who_stops_before_he_begins",
             kCar + "[[vehicle.driver]]\nfrom = \"2 s\"\nuntil = \"1 s\"\nlevel = \"6 m/s^2\"\n",
             "a.toml:8:9: vehicle.car.driver.0.until is \"1 s\": must not be earlier than the first force\n    8 | until = \"1 "
             "s\"\n      |         ^\n"}}),
    [](const auto& slip) { return slip.param.name; });

TEST(ExactTexts, FiveErrorsOfAFileComeInItsOrder) {
  const Folder folder;
  folder.write("a.toml", "[simulation]\nstep = 1\nduraton = \"4 s\"\n" + kPerson +
                             "stature = \"178\"\nmass = \"-70 kg\"\n[output]\nwidht = 3\n");
  const Result result = run(folder, {"check", "a.toml"});
  EXPECT_EQ(result.code, 2);
  EXPECT_EQ(
      result.err,
      "a.toml:2:8: simulation.step = 1 needs a unit: write \"1 ms\"\n    2 | step = 1\n      |        ^\n"
      "a.toml:3:1: simulation.duraton is not a known key; did you mean \"duration\"?\n    3 | duraton = \"4 s\"\n      | ^\n"
      "a.toml:6:11: person.p.stature is \"178\": needs a unit: write \"178 cm\"\n    6 | stature = \"178\"\n      |           ^\n"
      "a.toml:7:8: person.p.mass is \"-70 kg\": must be greater than 0 kg\n    7 | mass = \"-70 kg\"\n      |        ^\n"
      "a.toml:9:1: output.widht is not a known key; did you mean \"width\"?\n    9 | widht = 3\n      | ^\n");
}

TEST(ExactTexts, ASpeedNoRoadKnowsEndsTheRunAtOnce) {
  const Folder folder;
  folder.write("a.toml", kCar + "speed = \"4000000 km/h\"\n");
  const Result result = run(folder, {"simulate", "a.toml", "-q", "-o", "out"});
  EXPECT_EQ(result.code, 4);
  EXPECT_EQ(
      result.err,
      "crashreel: the model diverged at 0.0000 s, body car, effect gravity: the motion left every physical bound: a smaller step "
      "or other properties may help; the recording up to there is kept\n");
}

TEST(ExactTexts, AClosedStandardOutputIsToldByItsCause) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  const Result result = under_shell(folder, "$P check ball.toml >&-");
  EXPECT_EQ(result.code, 3);
  EXPECT_EQ(result.err, "crashreel: writing the result to standard output: Bad file descriptor\n");
}

TEST(ExactTexts, AnUnlikelySpeedIsAskedAbout) {
  const Folder folder;
  folder.write("a.toml", kCar + "speed = \"400 km/h\"\n");
  const Result result = run(folder, {"check", "a.toml"});
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.err, "a.toml: car starts at 400 km/h, faster than 250 km/h; is the unit right?\n");
  EXPECT_EQ(result.out, "a.toml: OK, with warnings\n");
}

TEST(ExactTexts, ARunTellsWhoStandsInAVehicle) {
  const Folder folder;
  folder.write("a.toml", kCar + kPerson);
  const Result result = run(folder, {"simulate", "a.toml", "-o", "out"});
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.err,
            "crashreel: note: nothing touched: no vehicle or person met anything but the ground in this run\n"
            "crashreel: warning: p stands inside car at the start\n");
  EXPECT_THAT(contents(folder / "out/summary.json"), HasSubstr("p stands inside car at the start"));
}

TEST(ExactTexts, FilesOfOtherSystemsAreRead) {
  const Folder folder;
  folder.write("crlf.toml", "[[person]]\r\nname = \"p\"\r\nspeed = \"4 km/h\"\r\n");
  folder.write("bom.toml", "\xef\xbb\xbf" + kPerson);
  folder.write("tabs.toml", kPerson + "\tspeed\t=\t\"4 km/h\"\n\theading = \"90\u00b0\"\n");
  for (const char* file : {"crlf.toml", "bom.toml", "tabs.toml"}) {
    const Result result = run(folder, {"check", file});
    EXPECT_EQ(result.out, std::string(file) + ": OK\n");
    EXPECT_EQ(result.err, "");
  }
  EXPECT_EQ(under_shell(folder, "$P check /dev/stdin <tabs.toml").out, "/dev/stdin: OK\n");
}

TEST(ExactTexts, OptionsThatCannotBe) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  folder.write("there", "a file");
  EXPECT_EQ(run(folder, {"render", "ball.toml", "--from", "0.3s", "--to", "0.1s"}).err,
            "crashreel: --from 0.3 s to 0.1 s holds no time; the scene lasts 0.4 s\n");
  EXPECT_EQ(run(folder, {"render", "ball.toml", "--seed", "5"}).err,
            "crashreel render: unknown option --seed; values of the scene are changed by --set, like --set "
            "vehicle.sedan.speed=\"50 km/h\"\n");
  EXPECT_EQ(run(folder, {"study", "ball.toml", "-o", "out", "--target", "travl_m=1cm"}).err,
            "crashreel: --target: the scene has no measure travl_m; did you mean travel_m? it has energy_residual_J, travel_m, "
            "turned_deg\n");
  const Result file = run(folder, {"simulate", "ball.toml", "-o", "there"});
  EXPECT_EQ(file.code, 3);
  EXPECT_EQ(file.err, "crashreel: writing into there: it is not a folder\n");
}

TEST(ExactTexts, ATimeWithoutUnitIsInSecondsOnTheCommandLine) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  const auto still = [&folder](const std::string& at, const std::string& file) {
    EXPECT_EQ(run(folder, {"render", "ball.toml", "--size", "64x64", "-q", "--at", at, "-o", file}).code, 0) << at;
    return contents(folder / file);
  };
  const std::string bare = still("0.2", "bare.png");
  EXPECT_EQ(bare, still("200 ms", "milliseconds.png"));
  EXPECT_NE(bare, still("0.3", "later.png"));
  for (const char* option : {"--from", "--to", "--at"})
    EXPECT_EQ(run(folder, {"render", "ball.toml", "-o", "a.png", option, "0,2"}).err,
              std::string("crashreel: ") + option + " is \"0,2\": has a decimal comma; write \"0.2\"\n");
}

TEST(ExactTexts, WhatMayNotOrCannotBeWrittenIsToldByItsCause) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  // a limit on files stands for a full disk: the call that writes fails in the same place
  EXPECT_EQ(under_shell(folder, "bash -c 'ulimit -f 1; exec '$P' render ball.toml -q --at 0.1s --size 256x256 -o a.png'").err,
            "crashreel: cannot write a.png: File too large\n");
  EXPECT_EQ(under_shell(folder, "bash -c 'ulimit -f 1; exec '$P' simulate ball.toml -q -o out'").err,
            "crashreel: writing out/trajectory.csv: File too large\n");
  EXPECT_EQ(under_shell(folder, "$P check ball.toml >/dev/full").err,
            "crashreel: writing the result to standard output: No space left on device\n");
}

TEST(ExactTexts, AFolderWithoutPermissionIsNamed) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  // root may write anywhere, until it gives that right away
  const std::string humbled = geteuid() == 0 ? "setpriv --bounding-set -dac_override,-dac_read_search "
                                               "--inh-caps -dac_override,-dac_read_search "
                                             : "";
  const std::string locked = "mkdir -p locked && chmod 555 locked && " + humbled;
  EXPECT_EQ(under_shell(folder, locked + "$P simulate ball.toml -q -o locked/out").err,
            "crashreel: making the folder locked/out: Permission denied\n");
  EXPECT_EQ(under_shell(folder, locked + "$P render ball.toml -q --at 0.1s -o locked/a.png").err,
            "crashreel: writing into locked: Permission denied\n");
}

TEST(DiskRoom, IsThatOfTheDiskTheFilmIsWrittenTo) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  // /proc has no room at all, and every folder of these tests some megabytes
  const Result none = run(folder, {"check", "ball.toml", "-o", "/proc/crashreel/film.mp4"});
  EXPECT_EQ(none.code, 0);
  EXPECT_EQ(none.err, "ball.toml: the disk of /proc has 0 kB left; /proc/crashreel/film.mp4 may take 221 kB\n");
  EXPECT_EQ(run(folder, {"check", "ball.toml", "-o", "some/where/film.mp4"}).err, "");
  EXPECT_EQ(under_shell(folder, "scene=$PWD/ball.toml && cd /proc && $P check $scene -o $OLDPWD/film.mp4").err, "");
  const Result refused = run(folder, {"check", "ball.toml", "-o", "film.avi"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_EQ(refused.err, "crashreel: -o is \"film.avi\": must end in .mp4, .mkv or .png, or name a folder\n");
}
