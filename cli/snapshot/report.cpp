#include "cli/snapshot/report.h"

#include <fmt/format.h>

#include <map>

#include "cli/output/json.h"
#include "cli/snapshot/xml.h"

namespace cli {
namespace {

bool fine(const Json& item) {
  return item["verdict"] == "same" || item["verdict"] == "updated";
}

std::string test_case(const std::string& scene, const std::string& name, const Json& item) {
  std::string out = fmt::format("    <testcase classname=\"{}\" name=\"{}\"", in_xml(scene), in_xml(name));
  if (fine(item)) return out + "/>\n";
  const std::string verdict = item["verdict"], why = item["why"];
  out += fmt::format(">\n      <failure type=\"{}\" message=\"{}\">{}", in_xml(verdict), in_xml(verdict + ": " + why), in_xml(why));
  if (item.contains("side_by_side")) out += "\n" + in_xml(item["side_by_side"].get<std::string>());
  return out + "</failure>\n    </testcase>\n";
}

}  // namespace

void count_verdicts(SnapshotReport& report) {
  std::map<std::string, int> counts;
  for (const char* always : {"same", "different", "new", "missing", "orphaned", "errors", "measures_same", "measures_off"})
    counts[always] = 0;
  bool same = true;
  for (const Json& scene : report["scenes"]) {
    counts["errors"] += static_cast<int>(scene["errors"].size());
    same = same && scene["errors"].empty();
    for (const Json& picture : scene["pictures"]) {
      ++counts[picture["verdict"]];
      same = same && fine(picture);
    }
    for (const Json& measure : scene["measures"]) {
      ++counts[fine(measure) ? "measures_same" : "measures_off"];
      same = same && fine(measure);
    }
  }
  counts["orphaned"] = static_cast<int>(report["orphans"].size());
  report["counts"] = counts;
  report["same"] = same && report["orphans"].empty();
}

std::string cause_of(const Json& scene) {
  bool same = false, different = false, off = false;
  for (const Json& picture : scene["pictures"]) {
    same |= picture["verdict"] == "same";
    different |= picture["verdict"] == "different";
  }
  for (const Json& measure : scene["measures"]) off |= !fine(measure);
  if (off && different) return "measures and pictures changed: look at the physics first";
  if (off && same) return "measures changed, pictures did not";
  if (different && !off && !scene["measures"].empty()) return "every pinned measure holds: look at the drawing first";
  return "";
}

std::string junit_xml(const SnapshotReport& report) {
  std::string suites;
  int all_tests = 0, all_failures = 0, all_errors = 0;
  for (const Json& scene : report["scenes"]) {
    const std::string name = scene["scene"];
    std::string cases;
    int tests = 0, failures = 0;
    for (const Json& picture : scene["pictures"]) {
      ++tests;
      failures += !fine(picture);
      cases += test_case(name, picture["name"], picture);
    }
    for (const Json& measure : scene["measures"]) {
      ++tests;
      failures += !fine(measure);
      cases += test_case(name, "expect " + measure["metric"].get<std::string>(), measure);
    }
    const int errors = static_cast<int>(scene["errors"].size());
    for (const Json& error : scene["errors"]) {
      const std::string what = error;
      cases += fmt::format("    <testcase classname=\"{}\" name=\"scene\">\n      <error message=\"{}\"/>\n    </testcase>\n",
                           in_xml(name), in_xml(what));
    }
    tests += errors;
    suites +=
        fmt::format("  <testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"{}\" time=\"{:.3f}\">\n{}  </testsuite>\n",
                    in_xml(name), tests, failures, errors, scene.value("wall_s", 0.0), cases);
    all_tests += tests, all_failures += failures, all_errors += errors;
  }
  if (!report["orphans"].empty()) {
    std::string cases;
    for (const Json& orphan : report["orphans"])
      cases += fmt::format(
          "    <testcase classname=\"orphans\" name=\"{}\">\n      <failure type=\"orphaned\" message=\"orphaned: no scene names "
          "{}\"/>\n"
          "    </testcase>\n",
          in_xml(orphan["name"].get<std::string>()), in_xml(orphan["file"].get<std::string>()));
    const std::size_t count = report["orphans"].size();
    suites += fmt::format("  <testsuite name=\"orphans\" tests=\"{0}\" failures=\"{0}\" errors=\"0\">\n{1}  </testsuite>\n", count,
                          cases);
    all_tests += static_cast<int>(count), all_failures += static_cast<int>(count);
  }
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"crashreel snapshot\" tests=\"{}\" failures=\"{}\" "
      "errors=\"{}\" time=\"{:.3f}\">\n{}</testsuites>\n",
      all_tests, all_failures, all_errors, report.value("wall_s", 0.0), suites);
}

}  // namespace cli
