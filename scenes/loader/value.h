// The scene file as a tree of values that know where they were written. The only thing the readers see of TOML.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace scenes {

/// Where a value was written: "case.toml:41:11", or the override that set it.
struct Place {
  std::string file;
  int line = 0;  // 0: not in a file (an override, a default)
  int column = 0;
  std::string text() const;
};

struct Entry;

struct Value {
  enum class Kind { boolean, integer, real, text, array, table, other };
  Kind kind = Kind::other;
  bool boolean = false;
  double number = 0;         // integer and real
  bool plain_number = true;  // false: written as hexadecimal, octal or binary
  std::string text;
  std::vector<Value> items;    // array
  std::vector<Entry> entries;  // table, in the order of their keys
  Place place;

  bool is_number() const { return kind == Kind::integer || kind == Kind::real; }
  const Value* find(std::string_view key) const;
  Value* find(std::string_view key);
};

struct Entry {
  std::string key;
  Place place;
  Value value;
};

/// What an absent section reads as: every key has its default.
const Value& empty_table();

/// As it would be written in a scene: numbers short, texts in quotes, arrays in brackets; long ones are cut.
std::string written(const Value&);

/// The bytes of a file, at most what a scene can be. Throws SceneErrors when it cannot be read.
std::string read_text(const std::filesystem::path& file);
/// Reads a file into a tree. Throws SceneErrors with file:line:column for broken TOML, or when the file cannot be read.
Value parse_file(const std::filesystem::path& file);
Value parse_text(std::string_view toml, const std::string& name);

/// Applies "path.to.key=value" (--set): array elements by their `name` or index, sections with or without a plural s. The value is
/// TOML; what is not TOML is taken as text, so quotes may be left out: speed=50 km/h. Throws SceneErrors.
void apply_override(Value& root, const std::string& assignment);

/// The parts of "path.to.key".
std::vector<std::string> split_path(const std::string& path);
/// "person" of "persons": a path may name a list in the plural.
std::string singular(const std::string& word);
/// The element of a list of tables by its `name` or its number; nullptr when there is none.
Value* element_of(Value& list, const std::string& name_or_number);

/// What the elements of a list are called.
std::vector<std::string> names_in(const Value& list);

/// `over` on top of `under`: tables key by key, everything else replaced. For a scene's changes to a library file.
Value overlaid(const Value& under, const Value& over);

/// The candidate nearest to `word` by edit distance, or empty when none is near.
std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace scenes
