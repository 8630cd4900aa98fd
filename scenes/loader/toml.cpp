// TOML text -> Value. The only file that knows toml++.
#include <toml++/toml.h>

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "scenes/error.h"
#include "scenes/loader/value.h"

namespace scenes {
namespace {

Place place_of(const toml::source_region& region, const std::string& file) {
  return {file, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

Value converted(const toml::node& node, const std::string& file);

Value converted_table(const toml::table& table, const std::string& file) {
  Value out;
  out.kind = Value::Kind::table;
  for (const auto& [key, child] : table) {
    out.entries.push_back({std::string(key.str()), place_of(key.source(), file), converted(child, file)});
  }
  return out;
}

Value converted(const toml::node& node, const std::string& file) {
  Value out;
  if (const auto* table = node.as_table()) {
    out = converted_table(*table, file);
  } else if (const auto* array = node.as_array()) {
    out.kind = Value::Kind::array;
    for (const toml::node& item : *array) out.items.push_back(converted(item, file));
  } else if (const auto* text = node.as_string()) {
    out.kind = Value::Kind::text;
    out.text = text->get();
  } else if (const auto* integer = node.as_integer()) {
    out.kind = Value::Kind::integer;
    out.number = static_cast<double>(integer->get());
    out.plain_number = integer->flags() == toml::value_flags::none;
  } else if (const auto* real = node.as_floating_point()) {
    out.kind = Value::Kind::real;
    out.number = real->get();
  } else if (const auto* boolean = node.as_boolean()) {
    out.kind = Value::Kind::boolean;
    out.boolean = boolean->get();
  }
  out.place = place_of(node.source(), file);
  return out;
}

}  // namespace

Value parse_text(std::string_view toml_text, const std::string& name) {
  try {
    return converted(toml::parse(toml_text, name), name);
  } catch (const toml::parse_error& error) {
    throw SceneErrors{{fmt::format("{}: not TOML: {}", place_of(error.source(), name).text(), error.description())}};
  }
}

Value parse_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::error_code ignored;
  if (!in || std::filesystem::is_directory(file, ignored)) {
    throw SceneErrors{{fmt::format("{}: cannot be read as a scene file; check the path and its permissions", file.string())}};
  }
  std::ostringstream text;
  text << in.rdbuf();
  return parse_text(text.str(), file.string());
}

namespace {

/// Finds the element of an array of tables by its `name` or its number.
Value* element(Value& array, const std::string& key) {
  for (Value& item : array.items) {
    const Value* name = item.find("name");
    if (name && name->kind == Value::Kind::text && name->text == key) return &item;
  }
  if (key.empty() || key.find_first_not_of("0123456789") != std::string::npos || key.size() > 6) return nullptr;
  const std::size_t number = std::stoul(key);
  return number < array.items.size() ? &array.items[number] : nullptr;
}

/// The value an override gives, every part of it placed at the override itself.
void place_everywhere(Value& value, const Place& place) {
  value.place = place;
  for (Value& item : value.items) place_everywhere(item, place);
  for (Entry& entry : value.entries) {
    entry.place = place;
    place_everywhere(entry.value, place);
  }
}

Value override_value(const std::string& text, const Place& place) {
  Value value;
  try {
    const Value table = parse_text("v = " + text, "");
    if (table.entries.size() == 1) value = table.entries.front().value;
  } catch (const SceneErrors&) {
    value.kind = Value::Kind::other;
  }
  // "0x10", "nan" and "1e999" stay numbers and are refused where they are read; "50 km/h" is a text whose quotes were left out
  if (value.kind == Value::Kind::other) {
    value.kind = Value::Kind::text;
    value.text = text;
  }
  place_everywhere(value, place);
  return value;
}

std::string singular(const std::string& word) {
  if (word.size() > 3 && word.ends_with("ies")) return word.substr(0, word.size() - 3) + "y";
  return word.size() > 1 && word.back() == 's' ? word.substr(0, word.size() - 1) : word;
}

std::vector<std::string> split(const std::string& path) {
  std::vector<std::string> parts;
  std::stringstream stream(path);
  for (std::string part; std::getline(stream, part, '.');) parts.push_back(part);
  return parts;
}

}  // namespace

void apply_override(Value& root, const std::string& assignment) {
  const Place place{"--set " + assignment};
  const auto equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw SceneErrors{{fmt::format("{}: must be path.to.key=value; write --set simulation.step='0.5 ms'", place.text())}};
  }
  const std::vector<std::string> parts = split(assignment.substr(0, equals));
  Value* at = &root;
  for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
    if (at->kind == Value::Kind::array) {
      Value* found = element(*at, parts[i]);
      if (!found)
        throw SceneErrors{{fmt::format("{}: there is no {} named or numbered \"{}\"", place.text(), parts[i - 1], parts[i])}};
      at = found;
      continue;
    }
    Value* child = at->find(parts[i]);
    // persons.pedestrian.speed reads naturally for what the file writes as [[person]]
    if (!child) child = at->find(singular(parts[i]));
    if (!child) {
      Value table;
      table.kind = Value::Kind::table;
      table.place = place;
      at->entries.push_back({parts[i], place, table});
      child = &at->entries.back().value;
    }
    if (child->kind != Value::Kind::table && child->kind != Value::Kind::array) {
      throw SceneErrors{{fmt::format("{}: {} is {}, it has no keys of its own", place.text(), parts[i], written(*child))}};
    }
    at = child;
  }
  Value value = override_value(assignment.substr(equals + 1), place);
  if (at->kind == Value::Kind::array) {
    Value* found = element(*at, parts.back());
    if (!found) throw SceneErrors{{fmt::format("{}: there is no element \"{}\"", place.text(), parts.back())}};
    *found = std::move(value);
  } else if (Value* old = at->find(parts.back())) {
    *old = std::move(value);
  } else {
    at->entries.push_back({parts.back(), place, std::move(value)});
  }
}

}  // namespace scenes
