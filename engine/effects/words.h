// Counts, numbers and names in the reasons of a plan.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/model/model.h"

namespace engine {

/// "no wheel", "1 wheel", "4 wheels"; `many` where an s is not enough.
std::string counted(std::size_t count, std::string_view one, std::string_view many = {});

/// Three digits, without an exponent where one can do without.
std::string number(double value);

/// "a", "a and b", "a, b and 3 more".
std::string listed(const std::vector<std::string>& names);

/// "0.2 m above it", "at it", "0.01 m below it".
std::string height_in_words(double height);

/// Moving bodies with a hyper-ellipsoid, in words: "14 segments of pedestrian", "1 free body"; empty when there are none.
std::string round_bodies(const Model&);

}  // namespace engine
