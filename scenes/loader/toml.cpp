// TOML text -> Value. The only file that knows toml++.
namespace {
/// The parser finds itself where its authors thought it could not be ("[.a]"); to end the program there is no answer.
struct ParserLost {};
void parser_lost() {
  throw ParserLost();
}
}  // namespace
#define TOML_ASSERT(holds) (static_cast<bool>(holds) ? void() : parser_lost())
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

constexpr int kDeepestKey = 16;                              // parts; a scene's own keys have five at most
constexpr std::size_t kLargestFile = std::size_t{16} << 20;  // [byte] a scene is some kB

/// Refuses what the parser cannot stand, outside of strings and remarks: it follows a dotted key of any length until the stack
/// ends, and is undefined for letters beyond ASCII.
void check_before_parsing(std::string_view text, const std::string& name) {
  int line = 1, parts = 0;
  const auto refuse = [&](const std::string& why) { throw SceneErrors{{fmt::format("{}:{}: not TOML: {}", name, line, why)}}; };
  std::string_view quotes;  // what ends the string that is open
  for (std::size_t i = text.starts_with("\xef\xbb\xbf") ? 3 : 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n') ++line;
    if (!quotes.empty()) {
      if (c == '\\' && quotes[0] == '"') {
        if (i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) >= 0x80)
          refuse("a backslash before a letter beyond ASCII");
        if (i + 1 < text.size() && text[i + 1] != '\n') ++i;
      } else if (text.substr(i).starts_with(quotes) || (c == '\n' && quotes.size() == 1)) {
        i += quotes.size() - 1;
        quotes = {};
      }
    } else if (c == '"' || c == '\'') {
      const bool three = text.substr(i, 3) == std::string(3, c);
      quotes = c == '"' ? (three ? "\"\"\"" : "\"") : (three ? "'''" : "'");
      i += quotes.size() - 1;
    } else if (c == '#') {
      i = std::min(text.find('\n', i), text.size()) - 1;
    } else if (c == '.') {
      if (++parts >= kDeepestKey) refuse(fmt::format("a key of more than {} parts; no key of a scene has", kDeepestKey));
    } else if (std::string_view("=,[]{}\n").find(c) != std::string_view::npos) {
      parts = 0;
    } else if (static_cast<unsigned char>(c) >= 0x80) {
      refuse("a letter that is not ASCII; texts stand in quotes");
    }
  }
}

bool loses_parser(std::string_view text) {
  try {
    (void)toml::parse(text);
  } catch (const ParserLost&) {
    return true;
  } catch (const toml::parse_error&) {
  }
  return false;
}

/// The line at which the parser is lost: it reads forwards, so what comes before is no matter.
int line_that_loses_parser(std::string_view text) {
  std::vector<std::size_t> ends;  // of the lines
  for (std::size_t at = 0; at < text.size(); at = ends.back()) ends.push_back(std::min(text.find('\n', at), text.size() - 1) + 1);
  const auto lost =
      std::partition_point(ends.begin(), ends.end(), [&](std::size_t end) { return !loses_parser(text.substr(0, end)); });
  return static_cast<int>(lost - ends.begin()) + 1;
}

}  // namespace

Value parse_text(std::string_view toml_text, const std::string& name) {
  check_before_parsing(toml_text, name);
  try {
    return converted(toml::parse(toml_text, name), name);
  } catch (const toml::parse_error& error) {
    throw SceneErrors{{fmt::format("{}: not TOML: {}", place_of(error.source(), name).text(), error.description())}};
  } catch (const ParserLost&) {
    throw SceneErrors{{fmt::format("{}:{}: not TOML: a key or a value is not whole", name, line_that_loses_parser(toml_text))}};
  }
}

Value parse_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::error_code ignored;
  if (!in || std::filesystem::is_directory(file, ignored)) {
    throw SceneErrors{{fmt::format("{}: cannot be read as a scene file; check the path and its permissions", file.string())}};
  }
  // whatever it is, a disk or an endless device, no more of it is read than a scene can be
  std::string text;
  for (char piece[1 << 14]; in.read(piece, sizeof piece) || in.gcount() > 0;) {
    text.append(piece, static_cast<std::size_t>(in.gcount()));
    if (text.size() > kLargestFile)
      throw SceneErrors{{fmt::format("{}: is larger than {} MB, this is no scene file", file.string(), kLargestFile >> 20)}};
  }
  return parse_text(text, file.string());
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
  if (parts.size() > kDeepestKey) throw SceneErrors{{fmt::format("{}: the key has more than {} parts", place.text(), kDeepestKey)}};
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
