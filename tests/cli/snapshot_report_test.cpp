// The report of crashreel snapshot: for machines, and as a page in a browser.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/snapshot_folder.h"

using namespace cli_tests;
using testing::HasSubstr;

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

namespace {

/// What a script put at the end of the page leaves in document.body.dataset.result, as Chromium runs it.
std::string in_browser(const Folder& folder, const std::string& probe) {
  std::string page = contents(folder / "snapshot-report/report.html");
  page.insert(page.rfind("</body>"), "<script>" + probe + "</script>");
  folder.write("probe.html", page);
  const std::string command =
      "timeout 60 chromium --headless --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking "
      "--disable-component-update --disable-sync --user-data-dir=" +
      (folder / "profile").string() + " --virtual-time-budget=4000 --dump-dom file://" + (folder / "probe.html").string() + " >" +
      (folder / "dom.html").string() + " 2>/dev/null";
  if (std::system(command.c_str()) != 0) return "chromium failed";
  const std::string dom = contents(folder / "dom.html"), before = "data-result=\"";
  const std::size_t at = dom.find(before);
  if (at == std::string::npos) return "the script did not end";
  return dom.substr(at + before.size(), dom.find('"', at + before.size()) - at - before.size());
}

}  // namespace

TEST(SnapshotReport, WorksInABrowser) {
  ASSERT_EQ(std::system("command -v chromium >/dev/null"), 0) << "chromium is not installed: apt-get install chromium";
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
