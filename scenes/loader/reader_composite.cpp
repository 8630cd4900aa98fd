// Values made of several: schedules, inertia tensors, colours, and tables within tables.
#include <fmt/format.h>

#include <cassert>

#include "engine/math/functions.h"
#include "scenes/loader/reader.h"

namespace scenes {
namespace {

/// sRGB 0..1 to linear, IEC 61966-2-1.
float linear(double c) {
  return static_cast<float>(c <= 0.04045 ? c / 12.92 : engine::math::pow((c + 0.055) / 1.055, 2.4));
}

}  // namespace

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
