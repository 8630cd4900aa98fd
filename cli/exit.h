// How the program ends: exit codes, and the errors that lead to them.
#pragma once

#include <stdexcept>

namespace cli {

enum ExitCode : int {
  kDone = 0,
  kComparisonSaysNo = 1,
  kAuthorErred = 2,    // the scene's author, or whoever typed the command
  kMachineFailed = 3,  // missing file, no GL, encoder, disk full
  kModelDiverged = 4,
};

/// The command line asks for what cannot be: the message says what and the remedy. Exit code 2.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The machine failed: what was being done, to which path, why. Exit code 3.
struct MachineError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace cli
