// One drawn picture, or one measure of a run, against what is expected of it.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/snapshot/baselines.h"
#include "engine/measure/metrics.h"
#include "render/image/image.h"
#include "scenes/scene.h"

namespace cli {

/// Which pictures go into the report, and where to.
struct Keeping {
  std::filesystem::path report;
  std::filesystem::path below;   // the folder in it
  bool all_that_differ = false;  // those within the limits too, for who wants the bits of today
};

/// The entry of a picture in report.json (check.h). Pictures to look at are written where `Keeping` says.
nlohmann::ordered_json judge(const scenes::Scene&, const Still&, const render::Image& actual, const Keeping&);

/// The entry of a measure in report.json.
nlohmann::ordered_json judge_measure(const scenes::Expectation&, const std::vector<engine::Metric>& found);

}  // namespace cli
