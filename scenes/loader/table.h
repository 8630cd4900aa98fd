// The value tables: one line a key. The same lines read a scene, make the JSON Schema, answer "did you mean" and write the
// reference.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/loader/quantity.h"

namespace scenes {

enum class Type {
  boolean,
  integer,
  number,
  text,
  choice,
  path,
  vector2,
  vector3,   // "1 2 3 m" or ["1 m", "2 m", "30 cm"]
  inertia,   // three principal values or a symmetric 3x3 tensor
  schedule,  // a value, or [["0 s", value], ["1 s", value]]
  range,     // ["-30 deg", "45 deg"]
  numbers,   // a list of any length
  texts,     // a list of texts
  any,       // a value of whatever kind, or a list: its reader looks for itself
  colour,    // "#a03020" or [0.6, 0.2, 0.1]
  table,
  tables,
  map  // a section; a list of sections; sections by name of the user's choosing
};

/// What values are allowed, in SI.
struct Range {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool lower_open = false;
};
constexpr Range kAny{};
constexpr Range kPositive{0, std::numeric_limits<double>::infinity(), true};
constexpr Range kNotNegative{0};
constexpr Range kShare{0, 1};
constexpr Range at_least(double lower) {
  return {lower};
}
constexpr Range between(double lower, double upper) {
  return {lower, upper};
}
/// [m] Semi-axes: thinner or longer things take no part in an accident, and their moments of inertia could not be reckoned with.
constexpr Range kExtent = between(1e-4, 1e3);
/// [s] How long a picture may stay: what is longer is a slip, and would fill any disk.
constexpr double kLongestHold = 3600;

struct Section;
class Reader;

constexpr std::string_view kRequired = "required";

struct Key {
  std::string_view name;  // "*" in the section of a map: any name
  Type type;
  Dimension dimension = Dimension::none;
  std::string_view fallback;  // as in a scene file, with ' for "; empty: left out means derived or absent; kRequired
  std::string_view doc;       // a sentence
  Range range = kAny;
  std::string_view choices = {};     // "plane|none"
  const Section* section = nullptr;  // of table, tables and map
  std::string_view remedy = {};      // follows the message of a value out of range
  Range usual = kAny;                // what a bare number is guessed by; kAny: `range`
  const void* owner = nullptr;       // of a key bound to a field (bound.h): stands for the field's struct
  void (*fill)(Reader&, std::string_view key, void* object) = nullptr;  // reads the key into that field
};

struct Section {
  std::string_view name;    // as in paths of keys: "simulation", "person.segment"
  std::string_view header;  // as in a file: "[simulation]", "[[person]]"
  std::string_view doc;
  std::span<const Key> keys;
  const Key* find(std::string_view key) const;
};

/// The whole scene file; every other section hangs below it.
const Section& scene_section();

/// Every section once, in the order of the reference.
std::vector<const Section*> all_sections();

/// What a value of the key looks like, in words: "a speed, like \"1 km/h\"".
std::string describe_type(const Key&);
/// "0..1", "> 0 kg", or empty.
std::string describe_range(const Key&);

/// The reference of scenes/README.md: a heading and a table for each section, in Markdown.
std::string reference_markdown();

std::vector<std::string> split_choices(std::string_view choices);

}  // namespace scenes
