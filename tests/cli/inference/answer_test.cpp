// One run of an ensemble: did anything meet?
#include <gtest/gtest.h>

#include "cli/inference/ensemble.h"
#include "tests/cli/program.h"

namespace cli_tests {
namespace {

/// Rigid collisions have no event of their own in a recording. A share of runs that avoid the accident counted two cars that
/// collide by Default-Auto, and somebody struck by a log, as if they had never met.
TEST(Answer, CountsEveryMeeting) {
  const Folder folder;
  const std::string start = "[simulation]\nduration = \"0.3 s\"\n";
  const std::string cars =
      start + "[[vehicle]]\nname = \"a\"\nmodel = \"sedan\"\nspeed = \"15 m/s\"\n[[vehicle]]\nname = \"b\"\nmodel = \"sedan\"\n";
  const std::string log = start +
                          "[[person]]\nname = \"p\"\n[[body]]\nname = \"log\"\nmass = \"8 kg\"\naxes = \"0.1 0.1 0.4 m\"\n"
                          "velocity = \"8 0 1 m/s\"\n";
  const auto touched = [&](const std::string& scene) {
    folder.write("a.toml", scene);
    return cli::inference::answer(scenes::load(folder / "a.toml"), {}).touched;
  };
  EXPECT_TRUE(touched(cars + "position = \"6 0 m\"\n"));
  EXPECT_FALSE(touched(cars + "position = \"26 0 m\"\n"));
  EXPECT_TRUE(touched(log + "position = \"-1.5 0 1.3 m\"\n"));
  EXPECT_FALSE(touched(log + "position = \"-1.5 3 1.3 m\"\n"));
}

}  // namespace
}  // namespace cli_tests
