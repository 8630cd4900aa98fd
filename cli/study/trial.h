// One run of a study: which, and what came of it. A finished trial lies in a small file named by its fingerprint, so that a study
// broken off goes on where it stood.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/study/quantities.h"
#include "scenes/scene.h"

namespace cli::study {

struct Trial {
  scenes::SceneFile scene;
  std::vector<std::string> overrides;
  int member = 0;                                       // of the ensemble; 0: as it is; negative: a draw of the start on its grid
  double cost = 1;                                      // expected, in any unit: long trials go first
  bool timed = true;                                    // repeated until its time is known
  std::string fingerprint;                              // of scene, overrides, member and program
  std::string assets;                                   // hash of the files the scene read when that was made
  std::shared_ptr<scenes::MeshShelf> meshes = nullptr;  // the scene's
};

struct Outcome {
  std::vector<Quantity> quantities;
  std::vector<std::string> contacts;  // first touches in order
  std::vector<double> wall_s;         // repetitions, warm, as on a core of its own
  double instructions = 0;            // 0: cannot be counted here
  long steps = 0;                     // with those divided to place impacts
  double end_s = 0;                   // simulated
  std::string failure;                // empty: none
  std::string recording;              // its hash, as `simulate` prints it
};

/// What the trial's answer depends on; `loaded` is the scene with the trial's overrides, `program` its build ID.
std::string fingerprint_of(const Trial&, const scenes::Scene& loaded, const std::string& program);

/// Runs the trial on the calling process' core until its time is known: at least three repetitions if it is short.
Outcome run(const Trial&);

void store(const Outcome&, const std::filesystem::path& file);
/// Nothing if the file is missing or not whole.
bool recall(const std::filesystem::path& file, Outcome&);

}  // namespace cli::study
