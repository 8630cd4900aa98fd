// JSON as every command writes it: keys in the order given, nothing in place of a number that is none.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

namespace cli {

using Json = nlohmann::ordered_json;

/// As text, in lines that are indented by `indent` or, below zero, in one. Names of files and values of the command line may be no
/// UTF-8: what is none of it is written as U+FFFD.
template <class AnyJson>
std::string json_text(const AnyJson& json, int indent = 2) {
  return json.dump(indent, ' ', false, AnyJson::error_handler_t::replace);
}

inline Json number_json(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

}  // namespace cli
