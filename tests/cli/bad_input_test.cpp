// What the program says to bad input, word by word, and how it exits.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <sstream>

#include "tests/cli/program.h"

using namespace cli_tests;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

namespace {

constexpr int kAuthor = 2;
constexpr int kMachine = 3;

struct BadScene {
  std::string name;
  std::string text;
  std::string message;
};

void PrintTo(const BadScene& scene, std::ostream* out) {
  *out << scene.name;
}

/// The line of the text that the message names, and a mark under its column.
std::string marked(const std::string& text, const std::string& message) {
  int line = 0, column = 0;
  std::sscanf(message.c_str(), "case.toml:%d:%d:", &line, &column);
  std::istringstream lines(text);
  std::string shown;
  for (int n = 0; n < line; ++n) std::getline(lines, shown);
  const std::string number = std::to_string(line);
  return std::string(5 - number.size(), ' ') + number + " | " + shown + "\n      | " +
         std::string(static_cast<std::size_t>(column - 1), ' ') + "^\n";
}

class BadSceneIsRefused : public testing::TestWithParam<BadScene> {};

}  // namespace

TEST_P(BadSceneIsRefused, WithItsPlaceAndARemedyAndExitCode2) {
  const Folder folder;
  folder.write("case.toml", GetParam().text);
  for (const char* command : {"check", "simulate", "render"}) {
    std::vector<std::string> arguments = {command, "case.toml"};
    if (std::string(command) == "simulate") arguments.insert(arguments.end(), {"-o", "out"});
    const Result result = run(folder, arguments);
    EXPECT_EQ(result.code, kAuthor) << command;
    EXPECT_THAT(result.err, StartsWith(GetParam().message)) << command;
    EXPECT_EQ(result.err.substr(GetParam().message.size()), marked(GetParam().text, GetParam().message)) << command;
    EXPECT_THAT(result.out, IsEmpty()) << command;
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
  EXPECT_FALSE(std::filesystem::exists(folder / "case.mp4"));
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, BadSceneIsRefused,
    testing::ValuesIn(std::vector<BadScene>{
        BadScene{"broken_toml", "title = \"Ball\"\n[simulation\n",
                 "case.toml:2:12: the section's bracket is not closed; write [simulation]\n"},
        BadScene{"negative_mass", ball_with("\"2 kg\"", "\"-2 kg\""),
                 "case.toml:9:8: body.ball.mass is \"-2 kg\": must be greater than 0 kg\n"},
        BadScene{"impossible_inertia", ball_with("friction = 0.5", "inertia = \"1 1 3 kg m^2\""),
                 "case.toml:13:11: body.ball.inertia is \"1 1 3 kg m^2\": must be physically possible; of its principal moments 1 "
                 "+ 1 is less than 3 kg m^2\n"},
        BadScene{"exponent_below_two", ball_with("friction = 0.5", "exponent = 1.5"),
                 "case.toml:13:12: body.ball.exponent is 1.5: must lie in 2..100; a hyper-ellipsoid needs n >= 2\n"},
        BadScene{"unknown_key", ball_with("friction = 0.5", "fricton = 0.5"),
                 "case.toml:13:1: body.ball.fricton is not a known key; did you mean \"friction\"?\n"},
        BadScene{"wrong_dimension", ball_with("\"2 kg\"", "\"2 m\""),
                 "case.toml:9:8: body.ball.mass is \"2 m\": must be a mass; write it like \"1 kg\"; units: kg, g, t, lb\n"},
        BadScene{"missing_unit", ball_with("\"2 kg\"", "2"),
                 "case.toml:9:8: body.ball.mass = 2 needs a unit: write \"2 kg\" or \"4.41 lb\"\n"},
        BadScene{"step_of_zero", ball_with("duration = \"0.4 s\"", "step = \"0 ms\""),
                 "case.toml:4:8: simulation.step is \"0 ms\": must be greater than 0 and at most 0.1 s; 1 ms is a good start\n"},
        BadScene{
            "missing_mesh", ball_with("axes = \"0.1 0.1 0.1 m\"", "mesh = \"none.obj\""),
            "case.toml:10:8: body.ball.mesh is \"none.obj\": must be a mesh file; there is no none.obj and no " CRASHREEL_SOURCE_DIR
            "/none.obj\n"}}),
    [](const auto& scene) { return scene.param.name; });

TEST(BadInput, SeveralErrorsAreToldAtOnce) {
  const Folder folder;
  folder.write("case.toml", ball_with("mass = \"2 kg\"", "mass = \"-2 kg\"\nfricton = 1"));
  const Result result = run(folder, {"check", "case.toml"});
  EXPECT_EQ(result.code, kAuthor);
  EXPECT_THAT(result.err, HasSubstr("body.ball.mass"));
  EXPECT_THAT(result.err, HasSubstr("body.ball.fricton"));
}

TEST(BadInput, CheckTellsOfEverySceneAndFailsIfOneDoes) {
  const Folder folder;
  folder.write("good.toml", kBall);
  folder.write("bad.toml", ball_with("\"2 kg\"", "\"-2 kg\""));
  const Result result = run(folder, {"check", "bad.toml", "good.toml"});
  EXPECT_EQ(result.code, kAuthor);
  EXPECT_EQ(result.out, "good.toml: OK\n");
  EXPECT_THAT(result.err, StartsWith("bad.toml:9:8: "));
  EXPECT_EQ(run(folder, {"check", "good.toml"}).code, 0);
}

TEST(BadInput, MissingSceneFile) {
  const Folder folder;
  const Result result = run(folder, {"render", "none.toml"});
  EXPECT_EQ(result.code, kAuthor);
  EXPECT_EQ(result.err, "none.toml: there is no such file\n");
}

namespace {

struct BadCommand {
  std::string name;
  std::vector<std::string> arguments;
  int code;
  std::string message;
};

void PrintTo(const BadCommand& command, std::ostream* out) {
  *out << command.name;
}

class BadCommandIsRefused : public testing::TestWithParam<BadCommand> {};

}  // namespace

TEST_P(BadCommandIsRefused, WithItsMessageAndExitCode) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  folder.write("there.mp4", "something");
  folder.write("there.png", "something");
  folder.write("my case.toml", kBall);
  std::filesystem::create_directory(folder / "frames");
  folder.write("frames/frame_00007.png", "something");
  const Result result = run(folder, GetParam().arguments);
  EXPECT_EQ(result.code, GetParam().code);
  EXPECT_EQ(result.err, "crashreel" + GetParam().message + "\n");
  EXPECT_THAT(result.out, IsEmpty());
  EXPECT_EQ(contents(folder / "there.mp4"), "something");
}

INSTANTIATE_TEST_SUITE_P(
    Commands, BadCommandIsRefused,
    testing::ValuesIn(std::vector<BadCommand>{
        BadCommand{"no_command",
                   {},
                   kAuthor,
                   ": no command given; take one of render, simulate, plan, study, sample, fit, eval, "
                   "figure, check, compare, snapshot, library, explain, schema, version, man, completion; see crashreel --help"},
        BadCommand{"unknown_command", {"rendr"}, kAuthor, ": unknown command rendr; did you mean render?"},
        BadCommand{"unknown_option",
                   {"render", "ball.toml", "--siz", "64x64"},
                   kAuthor,
                   " render: unknown option --siz; did you mean --size?"},
        BadCommand{"unknown_option_alone", {"--verbos"}, kAuthor, ": unknown option --verbos"},
        BadCommand{"second_scene", {"render", "ball.toml", "other.toml"}, kAuthor, " render: unexpected argument \"other.toml\""},
        BadCommand{"a_name_without_quotes",
                   {"render", "my", "case.toml"},
                   kAuthor,
                   " render: unexpected argument \"case.toml\"; a name with spaces stands in quotes: \"my case.toml\""},
        BadCommand{"no_scene", {"render"}, kAuthor, " render: SCENE is required; see crashreel render --help"},
        BadCommand{"no_folder", {"simulate", "ball.toml"}, kAuthor, " simulate: -o DIR is required; see crashreel simulate --help"},
        BadCommand{"bad_quality",
                   {"render", "ball.toml", "--quality", "best"},
                   kAuthor,
                   " render: --quality: \"best\" is none of draft, standard, fine; see crashreel render --help"},
        BadCommand{"odd_size",
                   {"render", "ball.toml", "--size", "641x480"},
                   kAuthor,
                   ": --size is 641x480, H.264 needs an even width and height; take 642x480, or PNGs"},
        BadCommand{"size_not_a_size",
                   {"render", "ball.toml", "--size", "0x10"},
                   kAuthor,
                   ": --size is \"0x10\": each side must lie in 16..16384 pixels"},
        BadCommand{"size_nonsense",
                   {"render", "ball.toml", "--size", "nanx1e3"},
                   kAuthor,
                   ": --size is \"nanx1e3\": must be WIDTHxHEIGHT, like 1280x720"},
        BadCommand{"fps_nan", {"render", "ball.toml", "--fps", "nan"}, kAuthor, ": --fps is \"nan\": must be a number in 1..1000"},
        BadCommand{
            "jobs_zero", {"render", "ball.toml", "--jobs", "0"}, kAuthor, ": --jobs is \"0\": must be a whole number in 1..256"},
        BadCommand{
            "at_late", {"render", "ball.toml", "-o", "a.png", "--at", "9s"}, kAuthor, ": --at is \"9s\": the scene ends at 0.4 s"},
        BadCommand{"at_infinite",
                   {"render", "ball.toml", "-o", "a.png", "--at", "1e999"},
                   kAuthor,
                   ": --at is \"1e999\": must be a time; write it like \"1 s\"; units: s, ms, min, h"},
        BadCommand{"png_without_at",
                   {"render", "ball.toml", "-o", "a.png"},
                   kAuthor,
                   ": -o is \"a.png\": a single PNG needs --at TIME; for a sequence name a folder or frame_%05d.png"},
        BadCommand{"unknown_ending",
                   {"render", "ball.toml", "-o", "a.avi"},
                   kAuthor,
                   ": -o is \"a.avi\": must end in .mp4, .mkv or .png, or name a folder"},
        BadCommand{"wild_pattern",
                   {"render", "ball.toml", "-o", "a%s%n.png"},
                   kAuthor,
                   ": -o is \"a%s%n.png\": a pattern must hold one %05d in its file name and end in .png"},
        BadCommand{
            "unknown_camera",
            {"render", "ball.toml", "--camera", "sid"},
            kAuthor,
            ": --camera is \"sid\": the scene has side, above; presets: top, side, front, driver, follow; did you mean side?"},
        BadCommand{"existing_video",
                   {"render", "ball.toml", "-o", "there.mp4"},
                   kAuthor,
                   ": there.mp4 exists; give --overwrite to replace it, or another -o"},
        BadCommand{"existing_still",
                   {"render", "ball.toml", "-o", "there.png", "--at", "0.1s"},
                   kAuthor,
                   ": there.png exists; give --overwrite to replace it, or another -o"},
        BadCommand{"existing_frames",
                   {"render", "ball.toml", "-o", "frames"},
                   kAuthor,
                   ": frames/frame_00007.png exists; give --overwrite to replace frames, or another -o"},
        BadCommand{"unwritable_video",
                   {"render", "ball.toml", "-o", "there.png/a.mp4"},
                   kMachine,
                   ": writing into there.png: it is not a folder"},
        BadCommand{"unwritable_folder",
                   {"simulate", "ball.toml", "-o", "there.png/none/out"},
                   kMachine,
                   ": making the folder there.png/none/out: there.png is a file"},
        BadCommand{"unknown_effect",
                   {"plan", "ball.toml", "--effects", "gravty=off"},
                   kAuthor,
                   ": simulation.effects.gravty: there is no effect of that name; did you mean gravity?"},
        BadCommand{"effect_state",
                   {"plan", "ball.toml", "--effects", "gravity=no"},
                   kAuthor,
                   ": --effects is \"gravity=no\": must be NAME=on, NAME=off or NAME=auto"},
        BadCommand{"frames_reversed",
                   {"render", "ball.toml", "--frames", "9:3"},
                   kAuthor,
                   ": --frames is \"9:3\": must be frames counted from 0: 7, 10-20, 10-20x5 (every fifth), 10-, -20, or a list of "
                   "these with commas"}}),
    [](const auto& command) { return command.param.name; });

TEST(BadInput, ExistingResultsAreLeftAloneWithoutOverwrite) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  std::filesystem::create_directory(folder / "out");
  folder.write("out/contacts.csv", "mine");
  const Result refused = run(folder, {"simulate", "ball.toml", "-o", "out"});
  EXPECT_EQ(refused.code, kAuthor);
  EXPECT_EQ(refused.err, "crashreel: out/contacts.csv exists; give --overwrite to replace it, or another -o\n");
  EXPECT_EQ(contents(folder / "out/contacts.csv"), "mine");
  EXPECT_FALSE(std::filesystem::exists(folder / "out/trajectory.csv"));
  EXPECT_EQ(run(folder, {"simulate", "ball.toml", "-o", "out", "--overwrite"}).code, 0);
  EXPECT_THAT(contents(folder / "out/contacts.csv"), StartsWith("time_s,kind,"));
}

TEST(BadInput, AFileNameThatIsNoUtf8HasItsResults) {
  const Folder folder;
  const std::string name = "b\xffll.toml", told = "b\xef\xbf\xbdll.toml";
  folder.write(name, kBall);
  const Result done = run(folder, {"simulate", name, "-o", "out", "--json", "-q"});
  EXPECT_EQ(done.code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("\"path\": \"" + told + "\""));
  EXPECT_EQ(contents(folder / "out/summary.json"), done.out);
  const Result checked = run(folder, {"check", name, "--json"});
  EXPECT_EQ(checked.code, 0) << checked.err;
  EXPECT_THAT(checked.out, HasSubstr(told));
}
