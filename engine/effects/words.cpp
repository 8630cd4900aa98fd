#include "engine/effects/words.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace engine {

std::string counted(std::size_t count, std::string_view one, std::string_view many) {
  std::string out = count == 0 ? "no" : std::to_string(count);
  out += ' ';
  if (count <= 1) return out.append(one);
  if (!many.empty()) return out.append(many);
  return out.append(one).append("s");
}

std::string number(double value) {
  char text[32];
  const double size = std::abs(value);
  const bool plain = size == 0 || (size >= 1e-4 && size < 1e7);
  const bool whole = plain && size >= 1000;
  const auto end = whole ? std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, 0).ptr
                         : std::to_chars(text, text + sizeof text, value, std::chars_format::general, 3).ptr;
  return {text, end};
}

std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 3;
  std::string out;
  const std::size_t shown = names.size() > kMost ? kMost - 1 : names.size();
  for (std::size_t i = 0; i < shown; ++i) {
    if (i > 0) out += i + 1 == names.size() ? " and " : ", ";
    out += names[i];
  }
  if (shown < names.size()) out += " and " + std::to_string(names.size() - shown) + " more";
  return out;
}

std::string height_in_words(double height) {
  if (std::abs(height) < 5e-4) return "at it";
  return number(std::abs(height)) + (height > 0 ? " m above it" : " m below it");
}

std::string round_bodies(const Model& model) {
  std::size_t segments = 0, free = 0;
  std::vector<std::string> persons;
  for (const Person& person : model.persons) persons.push_back(person.name);
  for (const Body& body : model.bodies)
    if (is_round(body) && !body.fixed) ++(body.person >= 0 ? segments : free);
  std::string out;
  if (segments > 0) out = counted(segments, "segment") + " of " + listed(persons);
  if (free > 0) out += (out.empty() ? "" : " and ") + counted(free, "free body", "free bodies");
  return out;
}

}  // namespace engine
