// JSON Schema (draft 2020-12) of the scene format, generated from the value tables. Editors complete and check with it.
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

#include "scenes/loader/table.h"
#include "scenes/scene.h"

namespace scenes {
namespace {

using nlohmann::json;

json schema_of(const Section&);

/// A plain number, or a text with a unit; the number zero needs none.
json scalar(const Key& key) {
  // a quantity has a digit; an expression may be a variable's name alone
  if (key.dimension != Dimension::none) return json::array({{{"type", "string"}, {"pattern", "[0-9a-z]"}}, {{"const", 0}}});
  json number{{"type", key.type == Type::integer ? "integer" : "number"}};
  if (std::isfinite(key.range.lower)) number[key.range.lower_open ? "exclusiveMinimum" : "minimum"] = key.range.lower;
  if (std::isfinite(key.range.upper)) number["maximum"] = key.range.upper;
  return json::array({number, {{"type", "string"}, {"pattern", "^[-+]?[0-9.][0-9.eE+-]* *%?$|[a-z(]"}}});
}

json list_of(json items, int least, int most) {
  return {{"type", "array"}, {"items", {{"anyOf", std::move(items)}}}, {"minItems", least}, {"maxItems", most}};
}

json value_schema(const Key& key) {
  const json text{{"type", "string"}};
  switch (key.type) {
    case Type::boolean:
      return {{"type", "boolean"}};
    case Type::integer:
    case Type::number:
      return {{"anyOf", scalar(key)}};
    case Type::text:
    case Type::path:
      return text;
    case Type::choice:
      return {{"enum", split_choices(key.choices)}};
    case Type::vector2:
      return {{"anyOf", {text, list_of(scalar(key), 2, 2)}}};
    case Type::vector3:
    case Type::colour:
      return {{"anyOf", {text, list_of(scalar(key), 3, 3)}}};
    case Type::range:
      return {{"anyOf", {text, list_of(scalar(key), 2, 2)}}};
    case Type::inertia: {
      json components = scalar(key);
      components.push_back({{"type", "array"}, {"items", {{"anyOf", scalar(key)}}}});
      components.push_back(text);
      return {{"anyOf", {text, list_of(components, 3, 3)}}};
    }
    case Type::schedule: {
      json out = scalar(key);
      out.push_back({{"type", "array"}, {"items", {{"type", "array"}, {"minItems", 2}, {"maxItems", 2}}}, {"minItems", 1}});
      return {{"anyOf", out}};
    }
    case Type::numbers: {
      json out = scalar(key);
      out.push_back({{"type", "array"}, {"items", {{"anyOf", scalar(key)}}}});
      return {{"anyOf", out}};
    }
    case Type::texts:
      return {{"type", "array"}, {"items", text}};
    case Type::any:
      return {{"type", {"string", "number", "array"}}};
    case Type::table:
      return schema_of(*key.section);
    case Type::tables:
      return {{"type", "array"}, {"items", schema_of(*key.section)}};
    case Type::map:
      return {{"type", "object"}, {"additionalProperties", schema_of(*key.section)}};
  }
  return {};
}

json schema_of(const Section& section) {
  json out{{"type", "object"}, {"description", section.doc}, {"additionalProperties", false}};
  json required = json::array();
  for (const Key& key : section.keys) {
    json value = value_schema(key);
    value["description"] = key.doc;
    if (key.fallback == kRequired) {
      required.push_back(key.name);
    } else if (!key.fallback.empty()) {
      std::string fallback(key.fallback);
      std::replace(fallback.begin(), fallback.end(), '\'', '"');
      value["default"] = json::parse(fallback);
    }
    if (key.name == "*") {
      out["additionalProperties"] = std::move(value);
    } else {
      out["properties"][std::string(key.name)] = std::move(value);
    }
  }
  if (!required.empty()) out["required"] = std::move(required);
  return out;
}

}  // namespace

std::string json_schema() {
  json out = schema_of(scene_section());
  out["$schema"] = "https://json-schema.org/draft/2020-12/schema";
  out["title"] = "crashreel scene";
  return out.dump(2) + "\n";
}

}  // namespace scenes
