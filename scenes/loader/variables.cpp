#include "scenes/loader/variables.h"

#include <fmt/format.h>

#include "scenes/loader/expression.h"

namespace scenes {
namespace {

const Key kVariablesKeys[] = {
    {"*", Type::any, Dimension::none, "",
     "A quantity (`\"40 km/h\"`, `0.7`) or an expression over others (`\"-0.432 s * speed\"`): + - * / ^, parentheses, sqrt abs "
     "min max sin cos tan. `g` is 9.81 m/s^2 here. Every number of the scene may be such an expression."},
};

bool is_numeric(Type type) {
  switch (type) {
    case Type::integer:
    case Type::number:
    case Type::vector2:
    case Type::vector3:
    case Type::inertia:
    case Type::schedule:
    case Type::range:
    case Type::numbers:
      return true;
    default:
      return false;
  }
}

struct Resolver {
  Variables& variables;
  Errors& errors;

  void scalar(Value& value, Dimension dimension, const std::string& path) {
    if (value.kind != Value::Kind::text || !is_expression(value.text, variables)) return;
    if (parse_quantity(value.text, dimension).problem.empty()) return;  // "0.5 / s"
    std::string problem;
    const Measured result = variables.evaluate(value.text, problem);
    if (problem.empty() && !(result.powers == powers_of(dimension)))
      problem = fmt::format("is {}, must be {}", in_words(result.powers), name_of(dimension));
    if (!problem.empty()) {
      errors.add(value.place, fmt::format("{} = {} {}", path, written(value), problem));
      return;
    }
    if (dimension == Dimension::none) {
      value.kind = Value::Kind::real;
      value.number = result.value;
    } else {
      value.text = fmt::format("{} {}", result.value, si_unit(dimension));
    }
  }

  /// "x, y, z" becomes a list of three.
  static void split_at_commas(Value& value) {
    std::vector<Value> items;
    int depth = 0;
    std::string part;
    for (const char c : value.text + ",") {
      depth += c == '(' ? 1 : c == ')' ? -1 : 0;
      if (c != ',' || depth > 0) {
        part += c;
        continue;
      }
      Value item = value;
      item.text = part.substr(std::min(part.find_first_not_of(' '), part.size()));
      if (item.text == "0") {  // needs no unit anywhere
        item.kind = Value::Kind::integer;
        item.number = 0;
      }
      items.push_back(std::move(item));
      part.clear();
    }
    value.kind = Value::Kind::array;
    value.items = std::move(items);
    value.text.clear();
  }

  void resolve(Value& value, const Key& key, const std::string& path) {
    const bool several = key.type != Type::number && key.type != Type::integer && key.type != Type::schedule;
    if (several && value.kind == Value::Kind::text && value.text.find(',') != std::string::npos &&
        is_expression(value.text, variables))
      split_at_commas(value);
    if (value.kind == Value::Kind::array) {
      for (std::size_t i = 0; i < value.items.size(); ++i) {
        Value& item = value.items[i];
        const bool knot = key.type == Type::schedule && item.kind == Value::Kind::array && item.items.size() == 2;
        const std::string at = fmt::format("{}[{}]", path, i);
        if (knot) {
          scalar(item.items[0], Dimension::time, at);
          scalar(item.items[1], key.dimension, at);
        } else {
          resolve(item, key, at);
        }
      }
      return;
    }
    scalar(value, key.dimension, path);
  }

  void walk(Value& table, const Section& section, const std::string& path) {
    if (table.kind != Value::Kind::table) return;
    for (Entry& entry : table.entries) {
      const Key* key = section.find(entry.key);
      if (!key) continue;
      const std::string at = path.empty() ? entry.key : path + "." + entry.key;
      if (key->type == Type::table) {
        walk(entry.value, *key->section, at);
      } else if (key->type == Type::map) {
        for (Entry& named : entry.value.entries) walk(named.value, *key->section, at + "." + named.key);
      } else if (key->type == Type::tables) {
        for (std::size_t i = 0; i < entry.value.items.size(); ++i)
          walk(entry.value.items[i], *key->section, element_path(at, entry.value.items[i], i));
      } else if (is_numeric(key->type)) {
        resolve(entry.value, *key, at);
      }
    }
  }
};

}  // namespace

const Section kVariablesSection{"variables", "[variables]", "Names for quantities that several values of the scene follow from.",
                                kVariablesKeys};

void resolve_variables(Value& root, Errors& errors) {
  const Value* found = root.find("variables");
  // a copy: the tree is changed while it is read
  const Value table = found && found->kind == Value::Kind::table ? *found : empty_table();
  Variables variables(table);
  for (const Entry& entry : table.entries) {
    if (unit_named(entry.key) || entry.key == "g")
      errors.add(entry.place, fmt::format("variables.{} has the name of a unit; take a longer one", entry.key));
    std::string problem;
    if (entry.value.kind == Value::Kind::text || entry.value.is_number())
      variables.value_of(entry.key, problem);
    else
      problem = "must be a quantity, like \"40 km/h\", or an expression";
    if (!problem.empty())
      errors.add(entry.value.place, fmt::format("variables.{} = {} {}", entry.key, written(entry.value), problem));
  }
  Variables fresh(table);
  Resolver{fresh, errors}.walk(root, scene_section(), "");
  if (!errors.empty()) throw SceneErrors(errors.findings());  // what follows from a wrong value would be told as well
  for (const Entry& entry : table.entries) {
    bool used = fresh.used().contains(entry.key);
    for (const Entry& other : table.entries)
      used = used || (other.key != entry.key && other.value.kind == Value::Kind::text &&
                      other.value.text.find(entry.key) != std::string::npos);
    if (!used) errors.warn(entry.place, fmt::format("variables.{} is named by no value of the scene", entry.key));
  }
}

}  // namespace scenes
