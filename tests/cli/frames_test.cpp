// Frame lists as render farms write them.
#include <gtest/gtest.h>

#include "tests/cli/program.h"

using namespace cli_tests;

namespace {

struct Case {
  std::string list;
  std::vector<std::string> files;
};

std::vector<std::string> drawn(const Folder& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "out"))
    names.push_back(entry.path().filename().string().substr(6, 5));
  std::sort(names.begin(), names.end());
  return names;
}

class FrameList : public testing::TestWithParam<Case> {};

// the ball's film has frames 0..3 at 10 frames a second (4 if its end is drawn); --from keeps what is asked for small
INSTANTIATE_TEST_SUITE_P(Written, FrameList,
                         testing::Values(Case{"2", {"00002"}}, Case{"1-2", {"00001", "00002"}}, Case{"0-3x2", {"00000", "00002"}},
                                         Case{"0-3:3", {"00000", "00003"}}, Case{"1:2", {"00001", "00002"}},
                                         Case{"-1", {"00000", "00001"}}, Case{"0,2-2,3", {"00000", "00002", "00003"}},
                                         Case{"2,1", {"00001", "00002"}}));

TEST_P(FrameList, DrawsTheseFramesUnderTheirNumbers) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  const Result result = run(folder, {"render", "ball.toml", "-o", "out", "--frames=" + GetParam().list, "--size", "64x64",
                                     "--quality", "draft", "--fps", "10"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(drawn(folder), GetParam().files);
}

TEST(FrameListWrong, IsRefusedWithExamples) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  for (const std::string list : {"a", "5-2", "1-9x0", "1,,2", "-", "1-2-3", "1.5", ""}) {
    const Result result = run(folder, {"render", "ball.toml", "-o", "out", "--frames=" + list});
    if (list.empty()) continue;  // an empty list is no list
    EXPECT_EQ(result.code, 2) << list;
    EXPECT_NE(result.err.find("10-20x5"), std::string::npos) << result.err;
  }
}

}  // namespace
