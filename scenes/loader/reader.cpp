#include "scenes/loader/reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <tuple>

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

/// sRGB 0..1 to linear, IEC 61966-2-1.
float linear(double c) { return static_cast<float>(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4)); }

std::string range_message(const Key& key) {
  return fmt::format("must {}{}{}", key.range.lower_open || std::isinf(key.range.upper) ? "be " : "lie in ", describe_range(key),
                     key.remedy.empty() ? "" : "; " + std::string(key.remedy));
}

}  // namespace

std::vector<std::string> Errors::sorted(std::vector<Finding> findings) {
  // files stay in the order in which they were first complained of: the scene before its library
  std::vector<std::string> files;
  for (const Finding& f : findings)
    if (std::find(files.begin(), files.end(), f.place.file) == files.end()) files.push_back(f.place.file);
  const auto rank = [&](const Finding& f) {
    return std::tuple(std::find(files.begin(), files.end(), f.place.file) - files.begin(), f.place.line, f.place.column);
  };
  std::stable_sort(findings.begin(), findings.end(), [&](const Finding& a, const Finding& b) { return rank(a) < rank(b); });
  std::vector<std::string> out;
  for (const Finding& f : findings) {
    std::string line = f.place.text() + ": " + f.what;
    if (std::find(out.begin(), out.end(), line) == out.end()) out.push_back(std::move(line));
  }
  return out;
}

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
    errors.add(entry.place, fmt::format("{} is not a known key{}", this->path(entry.key),
                                        guess.empty() ? fmt::format("; {} is described in scenes/README.md", section.header)
                                                      : fmt::format("; did you mean \"{}\"?", guess)));
  }
  for (const Key& key : section.keys) {
    if (key.fallback == kRequired && !table.find(key.name)) {
      errors.add(table.place, fmt::format("{} is missing; {} needs {}", this->path(key.name), section.header, describe_type(key)));
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

void Reader::bad(const Value& value, const std::string& path, const std::string& what) {
  errors_->add(value.place, fmt::format("{} is {}, {}", path, kind_in_words(value), what));
}

void Reader::fail(std::string_view key, const std::string& what) {
  if (const Value* value = table_->find(key)) {
    bad(*value, path(key), what);
  } else {
    errors_->add(table_->place, fmt::format("{} {}", path(key), what));
  }
}

void Reader::fail_here(const std::string& what) { errors_->add(table_->place, fmt::format("{} {}", path_, what)); }

void Reader::warn(std::string_view key, const std::string& what) {
  errors_->warn(place(key), fmt::format("{} {}", path(key), what));
}

bool Reader::boolean(std::string_view key) {
  const Key* line;
  const Value* value = get(key, line);
  if (!value) return false;
  if (value->kind != Value::Kind::boolean) bad(*value, path(key), "must be true or false");
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
      errors_->add(value.place, fmt::format("{} = {} needs a unit: write {}", at, written(value), unit_examples(value.number, key.dimension)));
      return 0;
    }
    number = value.number;
  } else if (value.kind == Value::Kind::text) {
    const Quantity quantity = parse_quantity(value.text, key.dimension);
    if (!quantity.problem.empty()) {
      bad(value, at, quantity.problem);
      return 0;
    }
    number = quantity.value;
  } else {
    bad(value, at, fmt::format("must be {}", describe_type(key)));
    return 0;
  }
  const bool low = key.range.lower_open ? !(number > key.range.lower) : !(number >= key.range.lower);
  if (low || !(number <= key.range.upper)) bad(value, at, range_message(key));
  return number;
}

double Reader::number(std::string_view key) {
  const Key* line;
  const Value* value = get(key, line);
  return value ? read_number(*value, *line, path(key)) : 0;
}

std::optional<double> Reader::number_if(std::string_view key) {
  if (!has(key) && (!section_->find(key) || !fallback_of(*section_->find(key)))) return std::nullopt;
  return number(key);
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
    bad(*value, path(key), "must be a text in quotes");
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
  bad(*value, path(key), fmt::format("must be one of \"{}\"{}", fmt::join(choices, "\", \""), guess.empty() ? "" : fmt::format("; did you mean \"{}\"?", guess)));
  return 0;
}

bool Reader::read_numbers(const Value& value, const Key& key, const std::string& at, std::vector<double>& out) {
  if (value.kind == Value::Kind::text) {
    const Quantities quantities = parse_quantities(value.text, key.dimension);
    if (!quantities.problem.empty()) {
      bad(value, at, quantities.problem);
      return false;
    }
    out = quantities.values;
    for (double number : out) {
      if (number < key.range.lower || (key.range.lower_open && number == key.range.lower) || number > key.range.upper) {
        bad(value, at, range_message(key));
        return false;
      }
    }
    return true;
  }
  if (value.kind != Value::Kind::array) {
    bad(value, at, fmt::format("must be {}", describe_type(key)));
    return false;
  }
  const std::size_t before = errors_->count();
  for (std::size_t i = 0; i < value.items.size(); ++i) out.push_back(read_number(value.items[i], key, fmt::format("{}[{}]", at, i)));
  return errors_->count() == before;
}

std::optional<engine::Vec3> Reader::vector_if(std::string_view key) {
  const Key* line;
  const Value* value = get(key, line);
  std::vector<double> numbers;
  if (!value) return std::nullopt;
  if (!read_numbers(*value, *line, path(key), numbers)) return engine::Vec3::Zero();
  const std::size_t wanted = line->type == Type::vector2 ? 2 : 3;
  if (numbers.size() != wanted) {
    bad(*value, path(key), fmt::format("must have {} components, has {}", wanted, numbers.size()));
    return engine::Vec3::Zero();
  }
  return engine::Vec3{numbers[0], numbers[1], wanted == 3 ? numbers[2] : 0};
}

engine::Vec3 Reader::vector(std::string_view key) { return vector_if(key).value_or(engine::Vec3::Zero()); }

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

engine::Schedule Reader::schedule(std::string_view key) {
  const Key* line;
  const Value* value = get(key, line);
  if (!value) return 0.0;
  if (value->kind != Value::Kind::array) return read_number(*value, *line, path(key));
  static constexpr Key kTime{"time", Type::number, Dimension::time, "", "", kNotNegative};
  std::vector<engine::Schedule::Knot> knots;
  for (std::size_t i = 0; i < value->items.size(); ++i) {
    const Value& item = value->items[i];
    const std::string at = fmt::format("{}[{}]", path(key), i);
    if (item.kind != Value::Kind::array || item.items.size() != 2) {
      bad(item, at, "must be a pair of a time and a value, like [\"1 s\", 0.3]");
      return 0.0;
    }
    knots.push_back({read_number(item.items[0], kTime, at + "[0]"), read_number(item.items[1], *line, at + "[1]")});
    if (i > 0 && knots[i].time < knots[i - 1].time) bad(item.items[0], at + "[0]", "must not be earlier than the time before it");
  }
  if (knots.empty()) {
    bad(*value, path(key), "must have at least one pair of a time and a value");
    return 0.0;
  }
  return engine::Schedule(std::move(knots));
}

engine::Mat3 Reader::inertia(std::string_view key) {
  const Key* line;
  const Value* value = get(key, line);
  engine::Mat3 out = engine::Mat3::Zero();
  if (!value) return out;
  const bool tensor = value->kind == Value::Kind::array && value->items.size() == 3 && value->items[0].kind == Value::Kind::array;
  Key component = *line;
  component.range = kAny;
  if (!tensor) {
    std::vector<double> numbers;
    if (!read_numbers(*value, component, path(key), numbers)) return engine::Mat3::Identity();
    if (numbers.size() == 3) return engine::Vec3(numbers[0], numbers[1], numbers[2]).asDiagonal();
    bad(*value, path(key), "must be three principal moments or a 3x3 tensor");
    return engine::Mat3::Identity();
  }
  for (int i = 0; i < 3; ++i) {
    std::vector<double> row;
    const std::string at = fmt::format("{}[{}]", path(key), i);
    if (!read_numbers(value->items[static_cast<std::size_t>(i)], component, at, row)) return engine::Mat3::Identity();
    if (row.size() != 3) {
      bad(value->items[static_cast<std::size_t>(i)], at, "must have 3 components");
      return engine::Mat3::Identity();
    }
    out.row(i) << row[0], row[1], row[2];
  }
  if (!out.isApprox(out.transpose(), 1e-9)) bad(*value, path(key), "must be symmetric");
  return out;
}

std::array<float, 3> Reader::colour(std::string_view key) {
  const Key* line;
  const Value* value = get(key, line);
  if (!value) return {0.6f, 0.6f, 0.6f};
  if (value->kind == Value::Kind::text) {
    const std::string& t = value->text;
    if (t.size() == 7 && t[0] == '#' && t.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos) {
      const auto byte = [&](std::size_t at) { return linear(std::stoi(t.substr(at, 2), nullptr, 16) / 255.0); };
      return {byte(1), byte(3), byte(5)};
    }
  } else if (value->kind == Value::Kind::array && value->items.size() == 3) {
    std::vector<double> rgb;
    Key component = *line;
    component.range = kShare;
    if (!read_numbers(*value, component, path(key), rgb)) return {0.6f, 0.6f, 0.6f};
    return {linear(rgb[0]), linear(rgb[1]), linear(rgb[2])};
  }
  bad(*value, path(key), "must be a colour, like \"#a03020\" or [0.63, 0.19, 0.13]");
  return {0.6f, 0.6f, 0.6f};
}

std::optional<Reader> Reader::table(std::string_view key) {
  const Key* line = section_->find(key);
  assert(line && line->section && "a table of the section's table");
  const Value* value = table_->find(key);
  if (!value) return std::nullopt;
  if (value->kind != Value::Kind::table) {
    bad(*value, path(key), fmt::format("must be a table, written under {}", line->section->header));
    return std::nullopt;
  }
  return Reader(*value, *line->section, path(key), *errors_);
}

std::vector<Reader> Reader::tables(std::string_view key) {
  const Key* line = section_->find(key);
  assert(line && line->section && "a list of tables of the section's table");
  const Value* value = table_->find(key);
  std::vector<Reader> out;
  if (!value) return out;
  if (value->kind != Value::Kind::array) {
    bad(*value, path(key), fmt::format("must be a list of tables, each written under {}", line->section->header));
    return out;
  }
  for (std::size_t i = 0; i < value->items.size(); ++i) {
    const Value& item = value->items[i];
    if (item.kind == Value::Kind::table) {
      out.emplace_back(item, *line->section, element_path(path(key), item, i), *errors_);
    } else {
      bad(item, fmt::format("{}.{}", path(key), i), fmt::format("must be a table, written under {}", line->section->header));
    }
  }
  return out;
}

std::vector<std::pair<std::string, Reader>> Reader::map(std::string_view key) {
  const Key* line = section_->find(key);
  assert(line && line->section && "a map of the section's table");
  const Value* value = table_->find(key);
  std::vector<std::pair<std::string, Reader>> out;
  if (!value) return out;
  if (value->kind != Value::Kind::table) {
    bad(*value, path(key), fmt::format("must be a table, written under {}", line->section->header));
    return out;
  }
  for (const Entry& entry : value->entries) {
    if (entry.value.kind == Value::Kind::table) {
      out.emplace_back(entry.key, Reader(entry.value, *line->section, path(key) + "." + entry.key, *errors_));
    } else {
      bad(entry.value, path(key) + "." + entry.key, fmt::format("must be a table, written under {}", line->section->header));
    }
  }
  return out;
}

}  // namespace scenes
