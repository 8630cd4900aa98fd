// study.csv and study.json. Columns and keys are a contract with other people's scripts: they grow, they are never renamed.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "cli/study/analysis.h"
#include "scenes/scene.h"

namespace cli::study {

std::string study_csv(const Study&);
nlohmann::ordered_json study_json(const scenes::Scene&, const Study&);
/// One line a quantity, for people.
std::string study_text(const scenes::Scene&, const Study&);

/// "A", "B" ... per setting of the ladder: equal letters had the same contacts in the same order. The finest is A.
std::vector<std::string> sequence_letters(const SeriesResult&);

}  // namespace cli::study
