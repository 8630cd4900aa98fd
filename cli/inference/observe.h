// What a run shows where a piece of evidence was seen.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/measure/metrics.h"
#include "engine/model/model.h"
#include "engine/recording.h"
#include "scenes/inference.h"

namespace cli::inference {

/// In the units of Evidence::value, as many components; of a mark the root mean square distance [m] between the mark and the trace
/// of the run; of contact and no_contact 1 or 0. Nothing where the run has no such thing (nobody was thrown).
/// `metrics` are the run's measures.
std::optional<std::vector<double>> observe(const scenes::Evidence&, const engine::Model&, const engine::Recording&,
                                           const std::vector<engine::Metric>& metrics);

/// World x, y [m] of the centre of mass at the end of the run, of every person, vehicle and free body that rests then, or never
/// moved.
std::map<std::string, std::array<double, 2>> rest_places(const engine::Model&, const engine::Recording&,
                                                         const std::vector<engine::Metric>& metrics);

/// How far off a run is, in tolerances: the length of the vector of its components' residuals. What a run does not have at all is
/// kMissing tolerances off; a touch that was or was not counts kWrong.
constexpr double kMissing = 6;
constexpr double kWrong = 3;
double misfit(const scenes::Evidence&, const std::optional<std::vector<double>>& predicted);

}  // namespace cli::inference
