// JSON as every command writes it: keys in the order given, nothing in place of a number that is none.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>

namespace cli {

using Json = nlohmann::ordered_json;

inline Json number_json(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

}  // namespace cli
