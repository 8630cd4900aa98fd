// Where the time of a film's frames goes, for --timings.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "render/cost.h"

namespace cli {

/// Two jobs' costs as one.
void add(const render::FilmCost&, render::FilmCost& sum);
/// A table: milliseconds of processor time a frame by pass, and what the clock says.
std::string timings_text(const render::FilmCost&);
/// frames, workers, wall_s, frame_ms by pass, first_frame_ms.
nlohmann::ordered_json timings_json(const render::FilmCost&);

}  // namespace cli
