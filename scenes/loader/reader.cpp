#include "scenes/loader/reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <map>

namespace scenes {
namespace {

std::string kind_in_words(const Value& value) {
  return value.kind == Value::Kind::table ? "a table" : written(value);
}

/// The default of a key as a value: the text of the table read as TOML, with ' for ".
const Value* fallback_of(const Key& key) {
  if (key.fallback.empty() || key.fallback == kRequired) return nullptr;
  static std::map<const Key*, Value> cache;
  const auto [at, fresh] = cache.try_emplace(&key);
  if (fresh) at->second = parse_text("v = " + std::string(key.fallback), "default").entries.front().value;
  return &at->second;
}

/// The number with the units it may have been meant in. Where the usual unit would put it out of the key's range, those that would
/// not.
std::string units_meant(double number, const Key& key) {
  const bool guessed = std::isfinite(key.usual.upper);
  const Range& range = guessed ? key.usual : key.range;
  return unit_examples(number, key.dimension, range.lower, range.upper);
}

/// Sections by other words for what they hold.
std::string_view section_meant(std::string_view word) {
  static constexpr std::array<std::string_view, 2> kWords[] = {
      {"pedestrian", "[[person]]"},  {"human", "[[person]]"},  {"cyclist", "[[person]]"}, {"rider", "[[person]]"},
      {"car", "[[vehicle]]"},        {"truck", "[[vehicle]]"}, {"bus", "[[vehicle]]"},    {"bicycle", "[[vehicle]]"},
      {"motorcycle", "[[vehicle]]"}, {"object", "[[body]]"},   {"barrier", "[[body]]"},   {"wall", "[[body]]"},
      {"collision", "[[impact]]"}};
  for (const auto& [other, section] : kWords)
    if (other == word) return section;
  return "";
}

/// After a key no other is near to: the section it is, where it stands elsewhere; else the keys of this one, where they fit a line.
std::string remedy_of_unknown(const std::string& key, const Section& section) {
  for (const Section* other : all_sections())
    if (!key.empty() && std::string_view(other->name).ends_with("." + key)) return fmt::format("; did you mean {}?", other->header);
  if (section.name.empty() && !section_meant(key).empty()) return fmt::format("; did you mean {}?", section_meant(key));
  constexpr std::size_t kAtMost = 12;
  if (section.name.empty() || section.keys.size() > kAtMost || section.find("*"))
    return fmt::format("; the keys {} are in scenes/README.md",
                       section.name.empty() ? "at the top of the file" : fmt::format("of {}", section.header));
  std::vector<std::string_view> names;
  for (const Key& known : section.keys) names.push_back(known.name);
  return fmt::format("; {} has {}", section.header, fmt::join(names, ", "));
}

std::string range_message(const Key& key) {
  return fmt::format("must {}{}{}", key.range.lower_open || std::isinf(key.range.upper) ? "be " : "lie in ", describe_range(key),
                     key.remedy.empty() ? "" : "; " + std::string(key.remedy));
}

}  // namespace

std::string element_path(const std::string& list_path, const Value& element, std::size_t number) {
  const Value* name = element.find("name");
  return list_path + "." + (name && name->kind == Value::Kind::text && !name->text.empty() ? name->text : std::to_string(number));
}

Reader::Reader(const Value& table, const Section& section, std::string path, Errors& errors)
    : table_(&table), section_(&section), path_(std::move(path)), errors_(&errors) {
  std::vector<std::string> known;
  for (const Key& key : section.keys) known.emplace_back(key.name);
  for (const Entry& entry : table.entries) {
    if (section.find(entry.key)) continue;
    const std::string guess = nearest(entry.key, known);
    errors.add(entry.place,
               fmt::format("{} is not a known key{}", this->path(entry.key),
                           guess.empty() ? remedy_of_unknown(entry.key, section) : fmt::format("; did you mean \"{}\"?", guess)),
               "unknown_key");
  }
  for (const Key& key : section.keys) {
    if (key.fallback == kRequired && !table.find(key.name)) {
      errors.add(table.place, fmt::format("{} is missing; {} needs {}", this->path(key.name), section.header, describe_type(key)),
                 "missing_key");
    }
  }
}

const Value* Reader::get(std::string_view key, const Key*& line) const {
  line = section_->find(key);
  assert(line && "readers ask only for keys of their section's table");
  const Value* value = table_->find(key);
  return value ? value : fallback_of(*line);
}

const Place& Reader::place(std::string_view key) const {
  const Value* value = table_->find(key);
  return value ? value->place : table_->place;
}

void Reader::bad(const Value& value, const std::string& path, const std::string& what, const std::string& code) {
  errors_->add_of(path, value.place, fmt::format("{} is {}: {}", path, kind_in_words(value), what), code);
}

void Reader::fail(std::string_view key, const std::string& what) {
  if (const Value* value = table_->find(key)) {
    bad(*value, path(key), what);
  } else {
    errors_->add(table_->place, fmt::format("{} {}", path(key), what));
  }
}

void Reader::fail_here(const std::string& what) {
  errors_->add(table_->place, fmt::format("{} {}", path_, what));
}

void Reader::warn(std::string_view key, const std::string& what) {
  errors_->warn(place(key), fmt::format("{} {}", path(key), what));
}

bool Reader::boolean(std::string_view key) {
  const Key* line;
  const Value* value = get(key, line);
  if (!value) return false;
  if (value->kind != Value::Kind::boolean) bad(*value, path(key), "must be true or false", "type");
  return value->boolean;
}

double Reader::read_number(const Value& value, const Key& key, const std::string& at) {
  double number = 0;
  if (value.is_number()) {
    if (!value.plain_number || !std::isfinite(value.number)) {
      bad(value, at, "must be a finite decimal number");
      return 0;
    }
    if (key.dimension != Dimension::none && value.number != 0) {
      errors_->add_of(at, value.place,
                      fmt::format("{} = {} needs a unit: write {}", at, written(value), units_meant(value.number, key)), "unit");
      return 0;
    }
    number = value.number;
  } else if (value.kind == Value::Kind::text) {
    const Quantity quantity = parse_quantity(value.text, key.dimension);
    if (!quantity.problem.empty()) {
      const bool bare = quantity.bare.has_value();
      bad(value, at, bare ? fmt::format("needs a unit: write {}", units_meant(*quantity.bare, key)) : quantity.problem, "unit");
      return 0;
    }
    number = quantity.value;
  } else {
    bad(value, at, fmt::format("must be {}", describe_type(key)), "type");
    return 0;
  }
  const bool low = key.range.lower_open ? !(number > key.range.lower) : !(number >= key.range.lower);
  if (low || !(number <= key.range.upper)) bad(value, at, range_message(key), "range");
  return number;
}

double Reader::number(std::string_view key) {
  const Key* line;
  const Value* value = get(key, line);
  return value ? read_number(*value, *line, path(key)) : 0;
}

int Reader::integer(std::string_view key) {
  const Key* line;
  const Value* value = get(key, line);
  if (!value) return 0;
  const double number = read_number(*value, *line, path(key));
  if (number != std::floor(number) || std::abs(number) > 1e9) {
    bad(*value, path(key), "must be a whole number");
    return 0;
  }
  return static_cast<int>(number);
}

std::string Reader::text(std::string_view key) {
  const Key* line;
  const Value* value = get(key, line);
  if (!value) return {};
  if (value->kind != Value::Kind::text) {
    bad(*value, path(key), "must be a text in quotes", "type");
    return {};
  }
  return value->text;
}

int Reader::choice(std::string_view key) {
  const Key* line;
  const Value* value = get(key, line);
  const std::vector<std::string> choices = split_choices(line->choices);
  if (!value) return 0;
  for (std::size_t i = 0; i < choices.size(); ++i)
    if (value->kind == Value::Kind::text && value->text == choices[i]) return static_cast<int>(i);
  const std::string guess = value->kind == Value::Kind::text ? nearest(value->text, choices) : "";
  bad(*value, path(key),
      fmt::format("must be one of \"{}\"{}", fmt::join(choices, "\", \""),
                  guess.empty() ? "" : fmt::format("; did you mean \"{}\"?", guess)),
      "choice");
  return 0;
}

bool Reader::read_numbers(const Value& value, const Key& key, const std::string& at, std::vector<double>& out) {
  if (value.kind == Value::Kind::text) {
    const Quantities quantities = parse_quantities(value.text, key.dimension);
    if (!quantities.problem.empty()) {
      bad(value, at, quantities.problem, "unit");
      return false;
    }
    out = quantities.values;
    for (double number : out) {
      if (number < key.range.lower || (key.range.lower_open && number == key.range.lower) || number > key.range.upper) {
        bad(value, at, range_message(key), "range");
        return false;
      }
    }
    return true;
  }
  if (value.kind != Value::Kind::array) {
    bad(value, at, fmt::format("must be {}", describe_type(key)), "type");
    return false;
  }
  const std::size_t before = errors_->count();
  for (std::size_t i = 0; i < value.items.size(); ++i)
    out.push_back(read_number(value.items[i], key, fmt::format("{}[{}]", at, i)));
  return errors_->count() == before;
}

engine::Vec3 Reader::vector(std::string_view key) {
  const Key* line;
  const Value* value = get(key, line);
  std::vector<double> numbers;
  if (!value || !read_numbers(*value, *line, path(key), numbers)) return engine::Vec3::Zero();
  const std::size_t wanted = line->type == Type::vector2 ? 2 : 3;
  if (numbers.size() != wanted) {
    bad(*value, path(key), fmt::format("must have {} components, has {}", wanted, numbers.size()));
    return engine::Vec3::Zero();
  }
  return {numbers[0], numbers[1], wanted == 3 ? numbers[2] : 0};
}

std::vector<double> Reader::numbers(std::string_view key) {
  const Key* line;
  const Value* value = get(key, line);
  std::vector<double> out;
  if (!value) return out;
  // one value stands for a list of one
  if (value->is_number()) return {read_number(*value, *line, path(key))};
  if (value->kind == Value::Kind::text) {
    const Quantity single = parse_quantity(value->text, line->dimension);
    if (single.problem.empty()) return {read_number(*value, *line, path(key))};
  }
  if (!read_numbers(*value, *line, path(key), out)) out.clear();
  return out;
}

std::array<double, 2> Reader::range(std::string_view key) {
  const Key* line;
  const Value* value = get(key, line);
  std::vector<double> numbers;
  if (!value || !read_numbers(*value, *line, path(key), numbers)) return {0, 0};
  if (numbers.size() != 2 || numbers[0] > numbers[1]) {
    bad(*value, path(key), "must be two values, the lower one first");
    return {0, 0};
  }
  return {numbers[0], numbers[1]};
}

std::vector<std::string> Reader::texts(std::string_view key) {
  const Key* line;
  const Value* value = get(key, line);
  std::vector<std::string> out;
  if (!value) return out;
  if (value->kind != Value::Kind::array) bad(*value, path(key), "must be a list of texts, like [\"head\", \"hips\"]");
  for (const Value& item : value->items) {
    if (item.kind != Value::Kind::text) bad(item, path(key), "must be a text in quotes");
    out.push_back(item.text);
  }
  return out;
}

}  // namespace scenes
