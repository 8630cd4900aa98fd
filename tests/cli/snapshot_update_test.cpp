// crashreel snapshot --update: only what was looked at is replaced.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pty.h>

#include "tests/cli/snapshot_folder.h"

using namespace cli_tests;
using testing::HasSubstr;

namespace {

/// Runs the program on a terminal of its own and types. All it wrote there.
std::string at_terminal(const Folder& folder, const std::vector<std::string>& arguments, const std::string& typed) {
  int terminal = -1;
  const pid_t child = forkpty(&terminal, nullptr, nullptr, nullptr);
  if (child == 0) {
    std::vector<char*> list = {const_cast<char*>(program())};
    for (const std::string& argument : arguments) list.push_back(const_cast<char*>(argument.c_str()));
    list.push_back(nullptr);
    if (chdir(folder.path().c_str()) == 0) execv(program(), list.data());
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
  ASSERT_EQ(access("/dev/ptmx", R_OK | W_OK), 0) << "this machine gives no terminals";
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
