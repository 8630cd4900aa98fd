// crashreel snapshot on small folders of scenes: every verdict, updating, reports.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pty.h>

#include <nlohmann/json.hpp>

#include "render/image/png.h"
#include "tests/cli/program.h"

using namespace cli_tests;
using testing::HasSubstr;
using Json = nlohmann::json;
namespace fs = std::filesystem;

namespace {

const std::string kStill = R"(
[snapshot]
width = 160
height = 90
[[output.still]]
time = "0.1 s"
camera = "side"
)";
// a quarter of a second of free fall from 0.2 m of air: half way it has gone on by 0.4 m at 1 m/s less what friction took
const std::string kName = "ball_side_0.1s";

/// A folder with one scene and its accepted baseline.
struct Accepted : Folder {
  explicit Accepted(const std::string& more = "") {
    fs::create_directory(*this / "scenes");
    write("scenes/ball.toml", kBall + more + kStill);
    first = run(*this, {"snapshot", "scenes"});
    accepted = run(*this, {"snapshot", "scenes", "--update", "ball"});
  }
  Result again(std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"snapshot", "scenes"});
    return run(*this, more);
  }
  Json report() const { return Json::parse(contents(*this / "snapshot-report/report.json")); }
  fs::path baseline(const std::string& name = kName) const { return *this / ("scenes/snapshots/" + name + ".png"); }
  Result first, accepted;
};

/// The scene with its ball a little to the side.
std::string moved_ball() {
  return ball_with("0 0 0.3 m", "0.03 0 0.3 m") + kStill;
}

/// Runs the program on a terminal of its own and types. All it wrote there.
std::string at_terminal(const Folder& folder, const std::vector<std::string>& arguments, const std::string& typed) {
  int terminal = -1;
  const pid_t child = forkpty(&terminal, nullptr, nullptr, nullptr);
  if (child == 0) {
    std::vector<char*> list = {const_cast<char*>(CRASHREEL_PROGRAM)};
    for (const std::string& argument : arguments) list.push_back(const_cast<char*>(argument.c_str()));
    list.push_back(nullptr);
    if (chdir(folder.path().c_str()) == 0) execv(CRASHREEL_PROGRAM, list.data());
    _exit(127);
  }
  EXPECT_EQ(write(terminal, typed.data(), typed.size()), static_cast<ssize_t>(typed.size()));
  std::string out;
  char block[1024];
  // a terminal whose last user has gone reads as an error
  for (ssize_t n = 0; (n = read(terminal, block, sizeof block)) > 0;) out.append(block, static_cast<std::size_t>(n));
  waitpid(child, nullptr, 0);
  close(terminal);
  return out;
}

}  // namespace

TEST(Snapshot, ANewPictureFailsUntilSomebodyAcceptsIt) {
  const Accepted folder;
  EXPECT_EQ(folder.first.code, 1);
  EXPECT_THAT(folder.first.out, HasSubstr("new        ball.toml: " + kName + ": it has no baseline yet"));
  EXPECT_EQ(folder.accepted.code, 0);
  EXPECT_EQ(contents(folder / "scenes/snapshots/list.txt"), kName + "\n");
  const Result again = folder.again();
  EXPECT_EQ(again.code, 0) << again.out;
  EXPECT_EQ(folder.report()["scenes"][0]["pictures"][0]["figures"]["pixels_differing"], 0);
}

TEST(Snapshot, AChangedPictureFailsAndIsShown) {
  const Accepted folder;
  folder.write("scenes/ball.toml", moved_ball());
  const Result changed = folder.again();
  EXPECT_EQ(changed.code, 1);
  EXPECT_THAT(changed.out, HasSubstr("different  ball.toml: " + kName));
  const Json picture = folder.report()["scenes"][0]["pictures"][0];
  for (const char* kind : {"expected", "actual", "difference", "side_by_side"})
    EXPECT_NO_THROW(render::read_png(folder / ("snapshot-report/" + picture[kind].get<std::string>()))) << kind;
  // wider limits of the scene let it pass
  folder.write("scenes/ball.toml", moved_ball() +
                                       "[snapshot.limits]\nshare_above_2 = 1\npixels_above_32 = 1e6\nrms = 255\npsnr_dB = 0\n"
                                       "ssim = 0\nperceptual_mean = 1\nperceptual_worst = 1\n");
  EXPECT_EQ(folder.again().code, 0);
  // and so does a mask over all of it
  folder.write("scenes/ball.toml", moved_ball() + "[[snapshot.mask]]\ncamera = \"side\"\nwidth = 160\nheight = 90\n");
  EXPECT_EQ(folder.again().code, 0);
  folder.write("scenes/ball.toml", moved_ball() + "[[snapshot.mask]]\ncamera = \"above\"\nwidth = 160\nheight = 90\n");
  EXPECT_EQ(folder.again().code, 1) << "the mask is another camera's";
}

TEST(Snapshot, MissingOrphanedAndUnreadableBaselinesAreToldApart) {
  const Accepted folder;
  fs::copy_file(folder.baseline(), folder.baseline("old"));
  const Result orphaned = folder.again();
  EXPECT_EQ(orphaned.code, 1);
  EXPECT_THAT(orphaned.out, HasSubstr("orphaned   no scene names scenes/snapshots/old.png"));
  EXPECT_EQ(folder.again({"--update", "old"}).code, 0);
  EXPECT_FALSE(fs::exists(folder.baseline("old")));

  fs::resize_file(folder.baseline(), 100);
  EXPECT_THAT(folder.again().out, HasSubstr("unreadable ball.toml: " + kName));
  fs::remove(folder.baseline());
  EXPECT_THAT(folder.again().out, HasSubstr("missing    ball.toml: " + kName + ": its baseline was accepted once and is gone"));

  render::write_png(folder.baseline(), {16, 16, std::vector<std::uint8_t>(4 * 16 * 16, 200)});
  EXPECT_THAT(folder.again().out, HasSubstr("the baseline is 16x16, the picture 160x90"));
}

TEST(Snapshot, UpdateReplacesWhatIsNamedAndNothingElse) {
  const Accepted folder;
  folder.write("scenes/ball.toml", moved_ball() + "[[output.still]]\ntime = \"0.2 s\"\ncamera = \"above\"\n");
  const std::string before = contents(folder.baseline());
  EXPECT_EQ(folder.again({"--update", "*_above_*"}).code, 0);
  EXPECT_EQ(contents(folder.baseline()), before);
  EXPECT_TRUE(fs::exists(folder.baseline("ball_above_0.2s")));
  EXPECT_EQ(folder.again().code, 1) << "the other picture still differs";
  EXPECT_EQ(folder.again({"--update", kName + ".png"}).code, 0);
  EXPECT_NE(contents(folder.baseline()), before);
  EXPECT_EQ(folder.again().code, 0);
  const Result unknown = folder.again({"--update", "ball_syde_0.1s"});
  EXPECT_EQ(unknown.code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("no scene, picture or orphan is called ball_syde_0.1s; did you mean ball_side_0.1s?"));
  EXPECT_TRUE(folder.report()["unfinished"]) << "what ended early is no pass";
  const Result nobody = folder.again({"--update"});
  EXPECT_EQ(nobody.code, 2);
  EXPECT_THAT(nobody.err, HasSubstr("no terminal to ask on"));
}

TEST(Snapshot, UpdateAloneAsksForEachOnTheTerminal) {
  const Accepted folder;
  folder.write("scenes/ball.toml", moved_ball() + "[[output.still]]\ntime = \"0.2 s\"\ncamera = \"above\"\n");
  fs::copy_file(folder.baseline(), folder.baseline("old"));
  const std::string before = contents(folder.baseline());
  // in the order of the questions: the picture that differs, the new one, the orphan
  const std::string no_then_yes = at_terminal(folder, {"snapshot", "scenes", "--update"}, "n\ny\nn\n");
  EXPECT_THAT(no_then_yes, HasSubstr("look at snapshot-report/pictures/" + kName + "_side_by_side.png"));
  EXPECT_EQ(contents(folder.baseline()), before);
  EXPECT_TRUE(fs::exists(folder.baseline("ball_above_0.2s")));
  EXPECT_TRUE(fs::exists(folder.baseline("old")));
  at_terminal(folder, {"snapshot", "scenes", "--update"}, "q\n");
  EXPECT_EQ(contents(folder.baseline()), before) << "q is no yes, to anything";
  at_terminal(folder, {"snapshot", "scenes", "--update"}, "y\ny\n");
  EXPECT_FALSE(fs::exists(folder.baseline("old")));
  EXPECT_EQ(folder.again().code, 0);
}

TEST(Snapshot, PinnedMeasuresTellPhysicsFromDrawing) {
  // 1 m/s over 0.4 s, less what friction on the ground took: between a third and all of 0.4 m
  const Accepted folder("[expect]\ntravel = \"0.27 m +- 0.13 m\"\n");
  EXPECT_EQ(folder.again().code, 0);
  // another place changes the picture, not how far it goes
  std::string scene = ball_with("0 0 0.3 m", "0.03 0 0.3 m");
  folder.write("scenes/ball.toml", scene + "[expect]\ntravel = \"0.27 m +- 0.13 m\"\n" + kStill);
  EXPECT_THAT(folder.again().out, HasSubstr("every pinned measure holds: look at the drawing first"));
  scene = ball_with("1 0 0 m/s", "2 0 0 m/s");
  folder.write("scenes/ball.toml", scene + "[expect]\ntravel = \"0.27 m +- 0.13 m\"\n" + kStill);
  const Result faster = folder.again();
  EXPECT_EQ(faster.code, 1);
  EXPECT_THAT(faster.out, HasSubstr("different  ball.toml: travel_m: is 0."));
  EXPECT_THAT(faster.out, HasSubstr("look at the physics first"));
  folder.write("scenes/ball.toml", kBall + "[expect]\nthrow_distance = \"1 m +- 1 cm\"\n" + kStill);
  EXPECT_THAT(folder.again().out,
              HasSubstr("missing    ball.toml: throw_distance_m: the run has no such measure; the run has travel_m ball"));
}

TEST(Snapshot, APhysicsFaultNoPictureShowsIsSeenInItsMeasure) {
  // friction acts from the landing at 0.2 s; the picture is of the flight. A ball landing at 2 m/s rolls at once where friction is
  // above (1 m/s / 3.5) / 2 m/s = 0.14; at 0.1 it goes on at 0.8 m/s in place of 0.71 m/s, 17 mm in 0.2 s
  const Accepted folder("[expect]\ntravel = \"0.27 m +- 0.13 m\"\n");
  folder.again();
  const double found = folder.report()["scenes"][0]["measures"][0]["found"];
  const std::string pinned = "[expect]\ntravel = \"" + std::to_string(found) + " m +- 1 mm\"\n";
  folder.write("scenes/ball.toml", kBall + pinned + kStill);
  EXPECT_EQ(folder.again().code, 0);
  folder.write("scenes/ball.toml", ball_with("friction = 0.5", "friction = 0.1") + pinned + kStill);
  const Result result = folder.again();
  EXPECT_EQ(result.code, 1);
  EXPECT_THAT(result.out, HasSubstr("measures changed, pictures did not"));
}

TEST(Snapshot, ReportsForMachinesTellEachFailure) {
  const Accepted folder("[expect]\ntravel = \"5 m +- 1 m\"\n");
  fs::copy_file(folder.baseline(), folder.baseline("old"));
  folder.again();
  const std::string junit = contents(folder / "snapshot-report/junit.xml");
  for (const char* part : {"<testsuites name=\"crashreel snapshot\" tests=\"3\" failures=\"2\" errors=\"0\"",
                           "<testcase classname=\"ball.toml\" name=\"ball_side_0.1s\"/>",
                           "<testcase classname=\"ball.toml\" name=\"expect travel_m\">",
                           "<failure type=\"different\" message=\"different: is 0.", "<failure type=\"orphaned\""})
    EXPECT_THAT(junit, HasSubstr(part));
  const Json report = folder.report();
  EXPECT_EQ(report["schema"], 1);
  EXPECT_EQ(report["same"], false);
  EXPECT_EQ(report["counts"]["measures_off"], 1);
  EXPECT_EQ(report["counts"]["orphaned"], 1);
  EXPECT_EQ(report["counts"]["same"], 1);
}

TEST(Snapshot, ASceneThatDoesNotLoadIsAnErrorAndItsBaselinesAreNoOrphans) {
  const Accepted folder;
  folder.write("scenes/ball.toml", ball_with("mass = \"2 kg\"", "mass = 2") + kStill);
  const Result result = folder.again();
  EXPECT_EQ(result.code, 1);
  EXPECT_THAT(result.out, HasSubstr("needs a unit"));
  EXPECT_THAT(result.out, testing::Not(HasSubstr("orphaned")));
  EXPECT_THAT(contents(folder / "snapshot-report/junit.xml"), HasSubstr("errors=\"1\""));
}

TEST(Snapshot, TheReportIsTheSameWithOneTwoAndFourWorkers) {
  const Accepted folder;
  folder.write("scenes/roll.toml", moved_ball());
  folder.write("scenes/fall.toml", ball_with("1 0 0 m/s", "0 0 0 m/s") + kStill);
  std::vector<std::string> seen;
  for (const char* jobs : {"1", "2", "4"}) {
    folder.again({"--jobs", jobs});
    Json report = folder.report();
    report["wall_s"] = 0;
    for (Json& scene : report["scenes"]) scene["wall_s"] = 0;
    seen.push_back(report.dump());
  }
  EXPECT_EQ(seen[0], seen[1]);
  EXPECT_EQ(seen[0], seen[2]);
}

TEST(Snapshot, OnlyAReportIsReplacedAndAFolderWithoutScenesIsRefused) {
  const Accepted folder;
  EXPECT_EQ(folder.again({"--report", "scenes"}).code, 2) << "scenes is no report";
  EXPECT_TRUE(fs::exists(folder / "scenes/ball.toml"));
  fs::create_directory(folder / "empty");
  const Result empty = run(folder, {"snapshot", "empty"});
  EXPECT_EQ(empty.code, 2);
  EXPECT_THAT(empty.err, HasSubstr("[[output.still]]"));
  EXPECT_EQ(run(folder, {"snapshot", "nowhere"}).code, 3);
}

TEST(Snapshot, AnExpectationIsAValueWithATolerance) {
  const Folder folder;
  for (const char* wrong : {"\"12.3 m\"", "\"12.3 m +- 0.1 s\"", "\"12.3 +- 0.1 m\"", "\"12.3 m +- -0.1 m\""}) {
    folder.write("ball.toml", kBall + "[expect]\ntravel = " + wrong + "\n");
    const Result result = run(folder, {"check", "ball.toml"});
    EXPECT_EQ(result.code, 2) << wrong;
    EXPECT_THAT(result.out + result.err, HasSubstr("expect.travel")) << wrong;
  }
}

namespace {

/// What a script put at the end of the page leaves in document.body.dataset.result, as Chromium runs it.
std::string in_browser(const Folder& folder, const std::string& probe) {
  std::string page = contents(folder / "snapshot-report/report.html");
  page.insert(page.rfind("</body>"), "<script>" + probe + "</script>");
  folder.write("probe.html", page);
  const std::string command =
      "timeout 60 chromium --headless --no-sandbox --disable-gpu --user-data-dir=" + (folder / "profile").string() +
      " --virtual-time-budget=4000 --dump-dom file://" + (folder / "probe.html").string() + " >" + (folder / "dom.html").string() +
      " 2>/dev/null";
  if (std::system(command.c_str()) != 0) return "chromium failed";
  const std::string dom = contents(folder / "dom.html"), before = "data-result=\"";
  const std::size_t at = dom.find(before);
  if (at == std::string::npos) return "the script did not end";
  return dom.substr(at + before.size(), dom.find('"', at + before.size()) - at - before.size());
}

}  // namespace

TEST(SnapshotReport, WorksInABrowser) {
  if (std::system("command -v chromium >/dev/null") != 0) GTEST_SKIP() << "chromium is not installed: apt-get install chromium";
  const Accepted folder;
  folder.write("scenes/ball.toml", moved_ball());
  folder.again();
  const std::string result = in_browser(folder, R"(
    addEventListener('load', () => {
      const pictures = [...document.images], box = document.querySelector('.picture');
      const over = box.querySelector('.over'), slider = box.querySelector('input'), seen = [over.style.opacity];
      for (const value of [0, 100]) { slider.value = value; slider.dispatchEvent(new Event('input')); seen.push(over.style.opacity); }
      box.querySelector('button').click();
      setTimeout(() => {
        seen.push(over.style.opacity);
        setTimeout(() => {
          seen.push(over.style.opacity);
          const rows = document.querySelectorAll('tr.beyond').length;
          pictures[0].click();
          document.body.dataset.result = [pictures.length, pictures.every(p => p.naturalWidth === 160), rows > 0,
                                          pictures[0].closest('figure').className,
                                          document.querySelector('h2 a').getAttribute('href'), seen.join(' ')].join('|');
        }, 250);
      }, 300);
    });)");
  // expected, actual, difference, and the two that lie over each other; faded by half, then none, then whole, then blinking
  EXPECT_EQ(result, "5|true|true|large|../scenes/ball.toml|0.5 0 1 1 0");
  // the page needs nothing but itself
  const std::string page = contents(folder / "snapshot-report/report.html");
  for (const char* outside : {"src=\"http", "href=\"http", "@import", "src=\"pictures"})
    EXPECT_EQ(page.find(outside), std::string::npos);
}
