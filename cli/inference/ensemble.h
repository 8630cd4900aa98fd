// Many runs of one scene with other inputs: in processes side by side that share the loaded meshes, each run kept on the disk as
// soon as it is done, so that a job broken off goes on where it stood. Runs do not share their way to the first touch: who waits
// costs nothing there, and of the flagship's 280 ms it is three.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/output/lock.h"
#include "cli/output/notices.h"
#include "cli/progress.h"
#include "scenes/scene.h"

namespace cli::inference {

/// What came of one run.
struct Answer {
  std::string status = "ok";                                  // else why there is none: "diverged at 0.431 s, body ..."
  std::map<std::string, double> outputs;                      // measures by name ("throw_distance_m", "delta_v_mps red")
  std::vector<std::optional<std::vector<double>>> predicted;  // of each piece of evidence
  std::map<std::string, std::array<double, 2>> rests;         // [m] where each person, vehicle and free body came to rest
  bool touched = false;                                       // a vehicle or a person met something or somebody
  RunNotes notes;
  bool ok() const { return status == "ok"; }
};

struct EnsembleWish {
  std::filesystem::path folder;  // runs lie in folder/runs
  int jobs = 1;
  ShowProgress show = ShowProgress::automatic;
  std::string verb = "sample";
  std::string part;  // "3-of-8": a job beside others of the same folder, with a journal of its own
};

class Ensemble {
 public:
  /// `scene` as loaded, with its overrides. Answers of earlier jobs with the same scene and program are taken over, those of all
  /// parts too. Throws MachineError.
  Ensemble(const scenes::Scene& scene, EnsembleWish wish);

  /// Answers in the order of the runs; each run is its overrides on top of the scene's. A run that was done before is not done
  /// again. Throws Interrupted; what is done by then is kept. `stage` says beside the progress which part of the job this is.
  std::vector<Answer> run(const std::vector<std::vector<std::string>>& runs, const std::string& stage = "");

 private:
  void recall();
  std::string recall(const std::filesystem::path& journal);
  void keep(const std::string& name, const Answer&);

  scenes::Scene scene_;
  EnsembleWish wish_;
  std::filesystem::path journal_;
  std::map<std::string, Answer> known_;  // by overrides
};

/// Holds off other jobs that would write the same results into the folder.
class FolderLock {
 public:
  /// Parts of one plan do not hold each other off.
  explicit FolderLock(const std::filesystem::path& folder, const std::string& part = "");

 private:
  OutputLock lock_;
};

/// One run on this process' core. What is wrong with the inputs stands in the status.
Answer answer(const scenes::Scene& scene, const std::vector<std::string>& overrides);

/// A line of text that holds an answer, and back; nothing when the line is damaged or none of these.
std::string as_line(const std::string& name, const Answer&);
std::optional<std::pair<std::string, Answer>> from_line(const std::string& line);

}  // namespace cli::inference
