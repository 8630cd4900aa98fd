#include "cli/output/notices.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <regex>

#include "cli/output/json.h"

namespace cli {
namespace {

/// What it warns of: its text without its numbers. Digits within a name are part of it.
std::string kind_of(const std::string& warning) {
  static const std::regex kNumber(R"((^|[ (=])[-+]?\d[\d.]*(e[-+]?\d+)?)");
  return std::regex_replace(warning, kNumber, "$1#");
}

}  // namespace

bool is_so_far(const engine::Metric& metric, const std::vector<engine::Metric>& all,
               const std::vector<engine::AbsentMetric>& absent) {
  const auto on_wheels = [&](const engine::Metric& m) {
    return m.key == "quarter_turns" && m.object == metric.object && std::remainder(m.value, 4) == 0;
  };
  const bool of_roll = metric.key == "roll_distance_m" || metric.key == "quarter_turns" || metric.key == "ground_strikes";
  const bool rolls = of_roll && std::none_of(all.begin(), all.end(), on_wheels);
  const bool to_rest = metric.key == "throw_distance_m" || metric.key == "slide_m" || rolls;
  const auto no_rest = [&](const engine::AbsentMetric& a) { return a.key == "rest_s" && a.object == metric.object; };
  return to_rest && std::any_of(absent.begin(), absent.end(), no_rest);
}

std::string as_field(const RunNotes& notes) {
  std::string out;
  if (!notes.so_far.empty()) out = fmt::format("still moving at the end: {} so far", fmt::join(notes.so_far, " and "));
  for (const std::string& warning : notes.warnings) out += (out.empty() ? "warning: " : "; warning: ") + warning;
  return out;
}

void Notices::add(const RunNotes& notes) {
  ++runs;
  unfinished += !notes.so_far.empty();
  warned += !notes.warnings.empty();
  so_far.insert(notes.so_far.begin(), notes.so_far.end());
  std::set<std::string> kinds;  // a run that warns twice of one thing is one run
  for (const std::string& warning : notes.warnings) {
    if (!kinds.insert(kind_of(warning)).second) continue;
    Counted& counted = warnings.try_emplace(kind_of(warning), Counted{warning}).first->second;
    ++counted.runs;
    counted.alike = counted.alike && counted.text == warning;
  }
}

std::vector<std::string> in_words(const Notices& notices) {
  std::vector<std::string> out;
  if (notices.unfinished > 0)
    out.push_back(fmt::format("{} of {} runs: still moving at the end, {} so far only. Give a longer simulation.duration.",
                              notices.unfinished, notices.runs, fmt::join(notices.so_far, " and ")));
  if (notices.warned == 0) return out;
  const auto fewer = [](const auto& a, const auto& b) { return a.second.runs < b.second.runs; };
  const Notices::Counted& most = std::max_element(notices.warnings.begin(), notices.warnings.end(), fewer)->second;
  out.push_back(fmt::format("{} of {} runs carry a warning{}{}: {}.", notices.warned, notices.runs,
                            notices.warnings.size() > 1 ? fmt::format(", the commonest in {}", most.runs) : "",
                            most.alike ? "" : ", here with the numbers of one run", most.text));
  return out;
}

void add_notices(const Notices& notices, Json& json) {
  json["unfinished"] = {{"runs", notices.unfinished}, {"measures", notices.so_far}};
  json["warnings"] = Json::array();
  for (const auto& [kind, counted] : notices.warnings)
    json["warnings"].push_back({{"warning", counted.text}, {"runs", counted.runs}});
}

}  // namespace cli
