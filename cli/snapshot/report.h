// What a snapshot test found, as files: report.json, junit.xml and report.html, one page that needs no other file.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace cli {

/// The whole of report.json: {"schema": 1, "version", "folder", "same", "counts": {verdict: number}, "wall_s", "scenes": [...],
/// "orphans": [{"name", "file"}]}. `scenes` as check.h says.
using SnapshotReport = nlohmann::ordered_json;

/// Adds "counts" and "same" to a report that has its scenes and orphans.
void count_verdicts(SnapshotReport&);

std::string junit_xml(const SnapshotReport&);
/// `folder`: where the report's pictures are found to be put into the page.
std::string report_html(const SnapshotReport&, const std::filesystem::path& folder);

/// Whether the scene's pinned measures tell its physics from its drawing: a sentence, empty where it has nothing to say.
std::string cause_of(const nlohmann::ordered_json& scene);

}  // namespace cli
