// Runs trials in parallel: one forked process a trial, one core each. What they leave is a file each; a process that dies takes its
// trial with it, not the study.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "cli/progress.h"
#include "cli/study/trial.h"

namespace cli::study {

/// Cores this process may use.
int available_cores();

/// Outcomes in the order of the trials. Those whose file lies in `folder` already are not run again. Throws MachineError when a
/// worker dies or cannot start.
std::vector<Outcome> run_all(const std::vector<Trial>&, const std::filesystem::path& folder, int jobs, ShowProgress);

}  // namespace cli::study
