// `crashreel study --effects`: each effect of the plan switched off in turn. What changes, and what it saves.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "cli/study/analysis.h"
#include "cli/study/run.h"
#include "render/charts/page.h"

namespace cli::study {

struct EffectOff {
  std::string effect, reason;            // as in `crashreel plan`
  SettingResult result;                  // of the run without it
  std::map<std::string, double> change;  // per quantity, in its unit: without minus with
  double saved_s = 0;                    // computing time
};

struct EffectsStudy {
  SettingResult all;  // the scene as it stands, with an ensemble: a change below its spread says nothing
  std::vector<EffectOff> off;
  std::vector<std::string> quantities;  // measures first
  double spread(const std::string& quantity) const;
};

EffectsStudy study_effects(const scenes::Scene&, const RunWish&);

/// effect,quantity,value,without,change,spread,wall_s,saved_s,failure
std::string effects_csv(const EffectsStudy&);
nlohmann::ordered_json effects_json(const scenes::Scene&, const EffectsStudy&);
std::string effects_text(const scenes::Scene&, const EffectsStudy&);
render::charts::Page effects_page(const scenes::Scene&, const EffectsStudy&);

}  // namespace cli::study
