// What a study says, in words for someone who has never halved a step.
#pragma once

#include <string>
#include <vector>

#include "cli/study/analysis.h"
#include "scenes/scene.h"

namespace cli::study {

/// "a band of ± 3 mm in place of ± 6 mm costs 2.0 times the time", or what stands in the way of a better answer.
std::string cost_in_words(const Study&, const std::string& quantity);

/// How good the scene's own answer is, whether minute changes matter, and whether a cheaper setting would do.
std::vector<std::string> findings(const Study&, const Judgement&);

/// Which program and scene a page comes from.
std::string provenance_of(const scenes::Scene&);

/// A number with a unit a reader grasps: "5.6 mm", "12.2 m", "0.3 deg".
std::string with_unit(double value, const std::string& unit);
/// With the digits that an uncertainty leaves, and one more.
std::string with_digits(double value, double uncertainty);

}  // namespace cli::study
