// Baselines are replaced only by what somebody has looked at: by name, or after a yes on the terminal.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/snapshot/report.h"

namespace cli {

/// Throws UsageError for a pattern that fits no scene, picture or orphan of the report: nobody has looked at what is not there.
void refuse_names_nothing_has(const std::vector<std::string>& patterns, const SnapshotReport&);

/// Replaces the baselines that fit one of the patterns and removes orphans that do; without patterns asks for each on the terminal.
/// `folder`: of the report and its pictures. What was replaced gets the verdict "updated"; with patterns, orphans nobody named
/// leave the report, as pictures nobody named were never in it.
void update_baselines(const std::vector<std::string>& patterns, const std::filesystem::path& folder, SnapshotReport&);

}  // namespace cli
