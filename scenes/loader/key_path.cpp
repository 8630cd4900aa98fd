#include "scenes/loader/key_path.h"

#include <fmt/format.h>

namespace scenes {
namespace {

std::string unknown(const Section& section, const std::string& part) {
  std::vector<std::string> names;
  for (const Key& key : section.keys) names.emplace_back(key.name);
  const std::string near = nearest(part, names);
  return fmt::format("names no key: {} has no \"{}\"{}", section.header, part,
                     near.empty() ? "" : fmt::format("; did you mean \"{}\"?", near));
}

std::string no_element(const Value* list, const std::string& kind, const std::string& part) {
  const std::vector<std::string> names = list ? names_in(*list) : std::vector<std::string>{};
  return fmt::format("names no {0} of the scene: none is called or numbered \"{1}\"{2}", kind, part,
                     names.empty() ? "" : fmt::format("; it has {}", fmt::join(names, ", ")));
}

std::string no_variable(const Value* variables, const std::string& part) {
  std::vector<std::string> names;
  if (variables)
    for (const Entry& entry : variables->entries) names.push_back(entry.key);
  return fmt::format("names no variable: [variables] has no \"{}\"; {}", part,
                     names.empty() ? "write it there" : fmt::format("it has {}", fmt::join(names, ", ")));
}

}  // namespace

KeyOfPath key_of_path(const Value& root, const std::string& path) {
  const std::vector<std::string> parts = split_path(path);
  const Section* section = &scene_section();
  const Value* value = &root;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    std::string part = parts[i];
    const Key* key = section->find(part);
    if (!key && (key = section->find(singular(part)))) key = key->section ? (part = singular(part), key) : nullptr;
    if (!key) return {nullptr, nullptr, unknown(*section, parts[i])};
    const Value* parent = value;
    value = value ? value->find(part) : nullptr;
    if (!key->section) {
      if (i + 1 == parts.size()) {
        if (section->name == "variables" && !value) return {nullptr, nullptr, no_variable(parent, part)};
        return {key, value, ""};
      }
      return {nullptr, nullptr,
              fmt::format("goes on after {}, which has no keys of its own; let a variable stand for a component", part)};
    }
    section = key->section;
    if (key->type == Type::table) continue;
    if (++i >= parts.size()) break;
    if (key->type == Type::tables) {
      Value* list = const_cast<Value*>(value);
      value = list ? element_of(*list, parts[i]) : nullptr;
      if (!value) return {nullptr, nullptr, no_element(list, part, parts[i])};
    } else {
      value = value ? value->find(parts[i]) : nullptr;
    }
  }
  return {nullptr, nullptr, "names a section, not a value"};
}

}  // namespace scenes
