// A study as one page for print: what it means in sentences, work-precision diagram, answer against step, uncertainty, table.
#pragma once

#include <string>

#include "cli/study/analysis.h"
#include "render/charts/page.h"
#include "scenes/scene.h"

namespace cli::study {

render::charts::Page page_of(const scenes::Scene&, const Study&);

/// "halving the band from 6 to 3 mm costs 2.0 times the time", or why no step can.
std::string cost_in_words(const Study&, const std::string& quantity);

/// A number with a unit a reader grasps: "5.6 mm", "12.2 m", "0.3 deg".
std::string with_unit(double value, const std::string& unit);

}  // namespace cli::study
