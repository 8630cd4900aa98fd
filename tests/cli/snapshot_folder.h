// A folder with one scene and its accepted baseline, for tests of crashreel snapshot.
#pragma once

#include <nlohmann/json.hpp>

#include "tests/cli/program.h"

namespace cli_tests {

namespace fs = std::filesystem;
using Json = nlohmann::json;

inline const std::string kStill = R"(
[snapshot]
width = 160
height = 90
[[output.still]]
time = "0.1 s"
camera = "side"
)";
// a quarter of a second of free fall from 0.2 m of air: half way it has gone on by 0.4 m at 1 m/s less what friction took
inline const std::string kName = "ball_side_0.1s";

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
inline std::string moved_ball() {
  return ball_with("0 0 0.3 m", "0.03 0 0.3 m") + kStill;
}

}  // namespace cli_tests
