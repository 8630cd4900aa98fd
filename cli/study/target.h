// `--target throw_distance=0.05m`: the cheapest setting that holds it, as lines to paste into the scene.
#pragma once

#include <string>

#include "cli/study/analysis.h"

namespace cli::study {

struct Target {
  std::string quantity;  // as typed: a metric key with or without its unit
  double width = 0;      // in the unit of the key
};

/// "throw_distance=0.05m", "throw_distance_m=5 cm". Throws UsageError.
Target parse_target(const std::string&);

/// Refuses a target that is none of the run's measures, by their names. Throws UsageError.
void check_target(const Target&, const std::vector<std::string>& names);

/// The answer in sentences. `setting` is null if no setting holds it.
struct TargetAnswer {
  const SettingResult* setting = nullptr;
  std::string text;
};
TargetAnswer search(const Study&, const Target&);

/// Overrides as a scene has them: "[simulation]\nstep = \"0.5 ms\"".
std::string as_scene_lines(const std::vector<std::string>& overrides);

}  // namespace cli::study
