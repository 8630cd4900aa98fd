// A scene's study from its series to judged results.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/progress.h"
#include "cli/study/analysis.h"

namespace cli::study {

struct RunWish {
  StudyOptions options;
  std::vector<std::string> inputs;  // "vehicle.car.speed=39 km/h..41 km/h"
  std::filesystem::path folder;     // finished trials lie in its folder runs
  int jobs = 1;
  bool timed = true;  // false: each run once, its time is that of the first go
  ShowProgress show = ShowProgress::automatic;
};

/// Runs every setting with its ensemble, in parallel; what has been run before is not run again.
std::vector<SettingResult> run_settings(const scenes::Scene&, const std::vector<Setting>&, const RunWish&);

/// Refuses inputs that are no rising range round the scene's own value, name no value of the scene, or that the scene does not
/// take. Throws UsageError in words of
/// --input.
void check_inputs(const scenes::Scene&, const std::vector<std::string>& inputs);

/// Runs and judges everything that means something for the scene. Throws UsageError for an input that is no range.
Study run_study(const scenes::Scene&, const RunWish&);

}  // namespace cli::study
