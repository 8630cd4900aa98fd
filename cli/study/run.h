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
  ShowProgress show = ShowProgress::automatic;
};

/// Runs and judges everything that means something for the scene. Throws UsageError for an input that is no range.
Study run_study(const scenes::Scene&, const RunWish&);

}  // namespace cli::study
