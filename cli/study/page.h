// A study as one page for print: what it means in sentences, work-precision diagram, answer against step, uncertainty, table.
#pragma once

#include "cli/study/analysis.h"
#include "render/charts/page.h"
#include "scenes/scene.h"

namespace cli::study {

render::charts::Page page_of(const scenes::Scene&, const Study&);

}  // namespace cli::study
