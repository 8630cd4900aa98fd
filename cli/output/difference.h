// The figures of a comparison of pictures, for scripts and for people.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "render/image/compare.h"

namespace cli {

/// {"pixels_differing": 3, ... "psnr_dB": null for equal pictures}
nlohmann::ordered_json difference_json(const render::Difference&);
nlohmann::ordered_json limits_json(const render::Limits&);
/// All on one line, each figure with its limit.
std::string difference_text(const render::Difference&, const render::Limits&);
/// Throws UsageError for a name no measure has.
void set_limit(render::Limits&, const std::string& name, double value);

}  // namespace cli
