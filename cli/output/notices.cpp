#include "cli/output/notices.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/output/json.h"

namespace cli {

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
  for (const std::string& warning : notes.warnings) ++warnings[warning];
}

std::vector<std::string> in_words(const Notices& notices) {
  std::vector<std::string> out;
  if (notices.unfinished > 0)
    out.push_back(fmt::format("{} of {} runs: still moving at the end, {} so far only. Give a longer simulation.duration.",
                              notices.unfinished, notices.runs, fmt::join(notices.so_far, " and ")));
  if (notices.warned == 0) return out;
  const auto fewer = [](const auto& a, const auto& b) { return a.second < b.second; };
  const auto& [text, count] = *std::max_element(notices.warnings.begin(), notices.warnings.end(), fewer);
  out.push_back(fmt::format("{} of {} runs carry a warning{}: {}.", notices.warned, notices.runs,
                            notices.warnings.size() > 1 ? fmt::format(", the commonest in {}", count) : "", text));
  return out;
}

void add_notices(const Notices& notices, Json& json) {
  json["unfinished"] = {{"runs", notices.unfinished}, {"measures", notices.so_far}};
  json["warnings"] = Json::array();
  for (const auto& [text, count] : notices.warnings) json["warnings"].push_back({{"warning", text}, {"runs", count}});
}

}  // namespace cli
