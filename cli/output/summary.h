// summary.json, and the same in a few readable lines. Keys are a contract with other people's scripts: grow them, never rename
// them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "engine/measure/metrics.h"
#include "engine/plan.h"
#include "engine/recording.h"
#include "scenes/scene.h"

namespace cli {

nlohmann::ordered_json summary_json(const scenes::Scene&, const engine::Recording&, const std::vector<engine::Metric>&);
/// The plan alone, as it stands in summary.json.
nlohmann::ordered_json plan_json(const std::vector<engine::PlanLine>&);
/// What the scene's scheme leaves to one solve a step, and whether anything remains for its stages; empty: it leaves nothing.
std::string scheme_in_words(const engine::Model&, const engine::Plan&);
/// That a step took more than a second of processor time, and about which bodies it was; empty: none did.
std::string slow_step(const engine::Recording&);
/// Main metrics, energy, diagnostics and cost, for people.
std::string summary_text(const scenes::Scene&, const engine::Recording&, const std::vector<engine::Metric>&);

}  // namespace cli
