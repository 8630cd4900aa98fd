#include "scenes/loader/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/loader/figure.h"

namespace scenes {

const Key* Section::find(std::string_view key) const {
  for (const Key& line : keys)
    if (line.name == key || line.name == "*") return &line;
  return nullptr;
}

std::vector<std::string> split_choices(std::string_view choices) {
  std::vector<std::string> out;
  while (!choices.empty()) {
    const auto bar = choices.find('|');
    out.emplace_back(choices.substr(0, bar));
    if (bar == std::string_view::npos) break;
    choices.remove_prefix(bar + 1);
  }
  return out;
}

namespace {

void collect(const Section& section, std::vector<const Section*>& out) {
  if (std::find(out.begin(), out.end(), &section) != out.end()) return;
  out.push_back(&section);
  for (const Key& key : section.keys)
    if (key.section) collect(*key.section, out);
}

std::string quantity_in_words(Dimension d) {
  return d == Dimension::none ? "a number" : fmt::format("{}, like \"1 {}\"", name_of(d), usual_unit(d));
}

}  // namespace

std::vector<const Section*> all_sections() {
  std::vector<const Section*> out;
  collect(scene_section(), out);
  collect(kFigureSection, out);
  collect(kPoseSection, out);
  return out;
}

std::string describe_type(const Key& key) {
  const std::string unit = key.dimension == Dimension::none ? "" : " " + std::string(usual_unit(key.dimension));
  switch (key.type) {
    case Type::boolean:
      return "true or false";
    case Type::integer:
      return "a whole number";
    case Type::number:
      return quantity_in_words(key.dimension);
    case Type::text:
      return "a text";
    case Type::choice:
      return fmt::format("one of \"{}\"", fmt::join(split_choices(key.choices), "\", \""));
    case Type::path:
      return "a path";
    case Type::vector2:
      return unit.empty() ? "two numbers, like [1, 2]" : fmt::format("two values, like \"1 2{}\"", unit);
    case Type::vector3:
      return unit.empty() ? "three numbers, like [1, 2, 3]" : fmt::format("three values, like \"1 2 3{}\"", unit);
    case Type::inertia:
      return "three principal moments, like \"1 2 2 kg m^2\", or a symmetric 3x3 tensor";
    case Type::schedule:
      return quantity_in_words(key.dimension) + ", or a table over time";
    case Type::range:
      return fmt::format("two values, like \"-1 1{}\"", unit);
    case Type::numbers:
      return quantity_in_words(key.dimension) + ", or a list of them";
    case Type::texts:
      return "a list of texts";
    case Type::any:
      return "a value or a list";
    case Type::colour:
      return "a colour, like \"#a03020\"";
    case Type::table:
      return "a table";
    case Type::tables:
      return "a list of tables";
    case Type::map:
      return "tables by name";
  }
  return {};
}

std::string describe_range(const Key& key) {
  const Range& r = key.range;
  const bool angle = key.dimension == Dimension::angle;  // nobody thinks in radians
  const std::string unit = angle ? " deg" : key.dimension == Dimension::none ? "" : " " + std::string(si_unit(key.dimension));
  const auto limit = [angle](double value) {
    return angle ? fmt::format("{:.4g}", value * 180 / std::numbers::pi) : fmt::format("{}", value);
  };
  if (std::isinf(r.lower) && std::isinf(r.upper)) return {};
  if (std::isinf(r.upper)) return fmt::format("{} {}{}", r.lower_open ? "greater than" : "at least", limit(r.lower), unit);
  if (r.lower_open) return fmt::format("greater than {} and at most {}{}", limit(r.lower), limit(r.upper), unit);
  return fmt::format("{}..{}{}", limit(r.lower), limit(r.upper), unit);
}

std::string reference_markdown() {
  std::string out;
  for (const Section* section : all_sections()) {
    out += fmt::format("### `{}`\n\n{}\n\n| key | value | default | meaning |\n|---|---|---|---|\n", section->header, section->doc);
    for (const Key& key : section->keys) {
      std::string fallback(key.fallback);
      std::replace(fallback.begin(), fallback.end(), '\'', '"');
      std::string type =
          key.type == Type::choice ? fmt::format("`{}`", fmt::join(split_choices(key.choices), "`, `")) : describe_type(key);
      if (const std::string range = describe_range(key); !range.empty()) type += "; " + range;
      out += fmt::format("| `{}` | {} | {} | {} |\n", key.name == "*" ? "(any name)" : key.name, type,
                         fallback.empty()        ? ""
                         : fallback == kRequired ? "required"
                                                 : "`" + fallback + "`",
                         key.doc);
    }
    out += "\n";
  }
  return out;
}

}  // namespace scenes
