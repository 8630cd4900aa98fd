// What is wrong with a scene, collected while it is read.
#include <algorithm>
#include <tuple>

#include "scenes/loader/reader.h"

namespace scenes {

void Errors::add(const Place& place, const std::string& what, const std::string& code) {
  found_.push_back({place.file, place.line, place.column, code, what});
}

void Errors::add_of(const std::string& path, const Place& place, const std::string& what, const std::string& code) {
  const std::string value = path + " " + place.text();
  if (std::find(told_.begin(), told_.end(), value) != told_.end()) return;
  told_.push_back(value);
  add(place, what, code);
}

void Errors::warn(const Place& place, const std::string& what) {
  odd_.push_back({place.file, place.line, place.column, "warning", what});
}

std::vector<std::string> Errors::warnings() const {
  std::vector<std::string> out;
  for (const Finding& f : sorted(odd_)) out.push_back(f.text());
  return out;
}

std::vector<Finding> Errors::sorted(std::vector<Finding> findings) {
  // files stay in the order in which they were first complained of: the scene before its library
  std::vector<std::string> files;
  for (const Finding& f : findings)
    if (std::find(files.begin(), files.end(), f.file) == files.end()) files.push_back(f.file);
  const auto rank = [&](const Finding& f) {
    return std::tuple(std::find(files.begin(), files.end(), f.file) - files.begin(), f.line, f.column);
  };
  std::stable_sort(findings.begin(), findings.end(), [&](const Finding& a, const Finding& b) { return rank(a) < rank(b); });
  std::vector<Finding> out;
  for (const Finding& f : findings) {
    const auto same = [&](const Finding& other) { return other.text() == f.text(); };
    if (std::none_of(out.begin(), out.end(), same)) out.push_back(f);
  }
  return out;
}

}  // namespace scenes
