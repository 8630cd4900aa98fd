#include "tests/odd_scenes/generator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/plan.h"
#include "scenes/loader/quantity.h"

namespace odd {
namespace {

using scenes::Dimension;
using scenes::Key;
using scenes::Type;
using scenes::Value;

/// Draws of one seed.
struct Chance {
  std::mt19937_64 bits;
  double share() { return std::uniform_real_distribution<>(0, 1)(bits); }
  bool one_in(int n) { return below(n) == 0; }
  int below(int n) { return std::uniform_int_distribution<>(0, n - 1)(bits); }
  double normal() { return std::normal_distribution<>()(bits); }
};

/// What a quantity of this kind is in an accident, [SI]; oddness is measured from it.
double usual(Dimension dimension) {
  switch (dimension) {
    case Dimension::time:
      return 0.02;
    case Dimension::mass:
    case Dimension::speed:
    case Dimension::angular_speed:
    case Dimension::acceleration:
      return 10;
    case Dimension::force:
    case Dimension::damping:
      return 1e3;
    case Dimension::stiffness:
      return 1e5;
    case Dimension::torque:
    case Dimension::angular_stiffness:
      return 100;
    default:
      return 1;
  }
}

double odd_number(const Key& key, double present, Chance& chance) {
  const scenes::Range& range = key.range;
  const bool below = std::isfinite(range.lower), above = std::isfinite(range.upper);
  if (above && below && chance.one_in(2)) {
    // at an end, by an end, or anywhere between
    const double width = range.upper - range.lower;
    const double at[] = {range.lower, range.upper, range.lower + width * 1e-9, range.upper - width * 1e-9,
                         range.lower + width * chance.share()};
    return at[chance.below(5)];
  }
  if (chance.one_in(12)) return range.lower_open ? 1e-12 : std::clamp(0.0, range.lower, range.upper);
  const double size = present != 0 ? std::abs(present) : usual(key.dimension);
  const double decades = chance.one_in(8) ? 3 * chance.normal() : 0.6 * chance.normal();
  double value = size * std::pow(10, decades);
  if (!below && chance.one_in(2)) value = -value;
  return std::clamp(value, range.lower, range.upper);
}

std::string quantity(const Key& key, double value) {
  const std::string_view unit = scenes::si_unit(key.dimension);
  return unit.empty() ? fmt::format("{:.9g}", value) : fmt::format("'{:.9g} {}'", value, unit);
}

std::string odd_text(Chance& chance) {
  const char* texts[] = {"''",
                         "'a'",
                         "'<b>&amp;</b>'",
                         "\"\\u202eright to left\"",
                         "\"a\\u0000b\"",
                         "\"tab\\tnew\\nline\"",
                         "'%s%n%d'",
                         "'../../etc/passwd'",
                         "'äöü漢字🚗'",
                         "\"\\u0301\\u0301\\u0301\\u0301\""};
  if (chance.one_in(8)) return "'" + std::string(static_cast<std::size_t>(1 + chance.below(5000)), 'W') + "'";
  return texts[chance.below(static_cast<int>(std::size(texts)))];
}

/// TOML of an odd value for the key; nothing where its kind has none.
std::optional<std::string> odd_value(const Key& key, double present, Chance& chance) {
  const auto several = [&](int n) {
    std::vector<std::string> all;
    for (int i = 0; i < n; ++i) all.push_back(quantity(key, odd_number(key, present, chance)));
    return fmt::format("[{}]", fmt::join(all, ", "));
  };
  switch (key.type) {
    case Type::boolean:
      return chance.one_in(2) ? "true" : "false";
    case Type::integer:
      return fmt::format("{}", std::lround(std::clamp(odd_number(key, present, chance), -1e6, 1e6)));
    case Type::number:
      return quantity(key, odd_number(key, present, chance));
    case Type::text:
      return odd_text(chance);
    case Type::texts:
      return fmt::format("[{}, {}]", odd_text(chance), odd_text(chance));
    case Type::choice: {
      const auto choices = scenes::split_choices(key.choices);
      return "'" + choices[static_cast<std::size_t>(chance.below(static_cast<int>(choices.size())))] + "'";
    }
    case Type::vector2:
      return several(2);
    case Type::vector3:
      return several(3);
    case Type::inertia: {
      // principal moments as a body of some shape has them: none above the sum of the others
      const double size = std::pow(10, 2 * chance.normal()), x = chance.share(), y = chance.share(), z = chance.share();
      return fmt::format("'{:.9g} {:.9g} {:.9g} kg m^2'", size * (y + z) + 1e-9, size * (x + z) + 1e-9, size * (x + y) + 1e-9);
    }
    case Type::range: {
      double lower = odd_number(key, present, chance), upper = odd_number(key, present, chance);
      if (lower > upper) std::swap(lower, upper);
      return fmt::format("[{}, {}]", quantity(key, lower), quantity(key, upper));
    }
    case Type::schedule: {
      if (chance.one_in(2)) return quantity(key, odd_number(key, present, chance));
      std::vector<std::string> knots;
      double time = 0;
      for (int i = 0, n = 1 + chance.below(4); i < n; ++i, time += 0.02 * chance.share())
        knots.push_back(fmt::format("['{:.6g} s', {}]", time, quantity(key, odd_number(key, present, chance))));
      return fmt::format("[{}]", fmt::join(knots, ", "));
    }
    case Type::numbers:
      return several(1 + chance.below(5));
    case Type::colour:
      return fmt::format("'#{:06x}'", chance.below(0x1000000));
    default:
      return std::nullopt;
  }
}

double present_number(const Key& key, const Value* value) {
  if (!value) return 0;
  if (value->is_number()) return value->number;
  if (value->kind != Value::Kind::text) return 0;
  const scenes::Quantities found = scenes::parse_quantities(value->text, key.dimension);
  double size = 0;
  if (found.problem.empty())
    for (const double x : found.values) size = std::max(size, std::abs(x));
  return size;
}

}  // namespace

Generator::Generator(const std::vector<Base>& bases) {
  for (const Base& base : bases) {
    Loaded loaded{base.file, {}};
    collect(scenes::scene_section(), scenes::parse_file(base.file), "", loaded.places);
    bases_.push_back(std::move(loaded));
    weights_.push_back(base.weight);
  }
}

void Generator::collect(const scenes::Section& section, const Value& table, const std::string& path,
                        std::vector<Place>& out) const {
  for (const Key& key : section.keys) {
    const std::string name = path + std::string(key.name);
    const Value* present = key.name == "*" ? nullptr : table.find(key.name);
    switch (key.type) {
      case Type::table:
        collect(*key.section, present ? *present : scenes::empty_table(), name + ".", out);
        break;
      case Type::tables:
        for (std::size_t i = 0; present && i < present->items.size(); ++i)
          collect(*key.section, present->items[i], fmt::format("{}.{}.", name, i), out);
        break;
      case Type::map:
        for (std::size_t i = 0; present && i < present->entries.size(); ++i)
          collect(*key.section, present->entries[i].value, fmt::format("{}.{}.", name, present->entries[i].key), out);
        break;
      default:
        if (key.name == "*" && section.name == "simulation.effects") {
          for (const engine::PlanLine& line : engine::compile({}).lines) out.push_back({path + line.effect, &key, 0});
        } else if (key.name == "*") {
          for (const scenes::Entry& entry : table.entries)
            out.push_back({path + entry.key, &key, present_number(key, &entry.value)});
        } else if (key.name != "duration" && key.name != "description") {
          out.push_back({name, &key, present_number(key, present)});
        }
    }
  }
}

OddScene Generator::make(std::uint64_t seed, double duration) const {
  Chance chance{std::mt19937_64(seed)};
  std::discrete_distribution<std::size_t> choose(weights_.begin(), weights_.end());
  const Loaded& base = bases_[choose(chance.bits)];
  OddScene out{base.file, {}, {}};
  for (int i = 0, n = 1 + chance.below(8); i < n; ++i) {
    const Place& place = base.places[static_cast<std::size_t>(chance.below(static_cast<int>(base.places.size())))];
    // a step of a nanosecond is valid and takes a day
    if (place.key->name == "step") {
      out.overrides.push_back(fmt::format("{}='{:.6g} ms'", place.path, std::pow(10, -1.5 + 3.2 * chance.share())));
    } else if (const auto value = odd_value(*place.key, place.present, chance)) {
      out.overrides.push_back(place.path + "=" + *value);
    }
  }
  const std::string lasts = fmt::format("simulation.duration='{:.6g} s'", duration);
  // what the loader refuses goes, until it agrees
  for (;;) {
    std::vector<std::string> all = out.overrides;
    all.push_back(lasts);
    try {
      out.scene = scenes::load(scenes::read_scene_file(base.file), all, meshes_);
      out.overrides = std::move(all);
      return out;
    } catch (const scenes::SceneErrors& errors) {
      if (out.overrides.empty()) throw;
      const std::size_t erased = std::erase_if(out.overrides, [&](const std::string& text) {
        return std::any_of(errors.lines.begin(), errors.lines.end(),
                           [&](const std::string& line) { return line.find(text) != line.npos; });
      });
      if (erased == 0) out.overrides.erase(out.overrides.begin() + chance.below(static_cast<int>(out.overrides.size())));
    }
  }
}

}  // namespace odd
