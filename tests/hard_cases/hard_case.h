// What every hard case shares: its scene at a step and scheme, run twice, judged for what must always hold, and printed as a row.
#pragma once

#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "engine/simulate.h"

namespace hard_cases {

/// As in a scene file: "2 ms", "rk4".
struct Setting {
  const char* step;
  const char* scheme;
};
std::ostream& operator<<(std::ostream&, const Setting&);

/// 2, 1 and 0.5 ms with either scheme.
inline constexpr Setting kSettings[] = {{"2 ms", "stepping"}, {"1 ms", "stepping"}, {"0.5 ms", "stepping"},
                                        {"2 ms", "rk4"},      {"1 ms", "rk4"},      {"0.5 ms", "rk4"}};

struct Outcome {
  engine::Model model;
  engine::Recording recording;
  double wall_s = 0;  // [s] of the first of its two runs
  std::string setting;

  const engine::Diagnostics& diagnostics() const { return recording.diagnostics; }
  const engine::BodyState& last(int body) const { return recording.snapshots.back().bodies[static_cast<std::size_t>(body)]; }
};

/// The model of tests/hard_cases/SCENE.toml (or a path from the root of the tree, with a slash) with `overrides` as on the command
/// line of the program.
engine::Model model_of(const std::string& scene, std::vector<std::string> overrides);

/// Runs it twice. Fails the test when the runs differ in a bit, when anything is not finite, or when the run ends in a failure.
Outcome run(engine::Model, const std::string& setting);
Outcome run(const std::string& scene, const Setting&, std::vector<std::string> overrides = {},
            const std::function<void(engine::Model&)>& change = {});

/// Prints "case  setting  wall time  figures" (printf's way); `tests/run --hard-cases` shows these rows.
[[gnu::format(printf, 3, 4)]] void row(const char* name, const Outcome&, const char* figures, ...);
[[gnu::format(printf, 3, 4)]] void row(const char* name, const std::string& setting, const char* figures, ...);

/// Mechanical energy [J] of a snapshot.
double energy(const engine::Snapshot&);

struct Rises {
  double largest = 0;  // [J] between two snapshots
  double sum = 0;      // [J] of all
};

/// Rises of the mechanical energy from snapshot to snapshot.
Rises rises(const engine::Recording&);

double degrees(double radians);

}  // namespace hard_cases
