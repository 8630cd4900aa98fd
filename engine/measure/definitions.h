// Every measure, defined once: what code, `crashreel explain`, reference, figures and summary.json say of it is read from here.
#pragma once

#include <span>
#include <string>

namespace engine {

struct Definition {
  const char* key;         // of summary.json: "throw_distance_m"
  const char* unit;        // "m"; empty: none
  const char* title;       // as captions say it: "throw distance"
  const char* definition;  // in the words of the field, with its source
  const char* absent;      // when a run does not define it
  const char* sureness;    // what it hangs on, and how sure it is
  bool main = false;       // one of those that a screen of results shows
  bool direction = false;  // [deg] of which a whole turn more is the same
};

/// All of them, in the order of reports.
std::span<const Definition> definitions();

/// Null for a name that is none's.
const Definition* definition_of(const std::string& key);

/// Of a direction that of its values, whole turns apart, which is nearest to `near`; every other value as it is. `key` may be
/// followed by whose it is.
double turned_to(const std::string& key, double value, double near);

}  // namespace engine
