// What a job will cost, before it starts: found by doing a little of it.
#pragma once

#include <sys/resource.h>

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "cli/film_plan.h"
#include "engine/plan.h"
#include "scenes/scene.h"

namespace cli {

struct Estimate {
  long steps = 0;         // at most: a run may come to rest before its time
  int frames = 0;         // at most, likewise
  double seconds = 0;     // of the clock, on this machine as busy as it is now
  double disk = 0;        // [byte] of what is written
  double recording = 0;   // [byte] of memory: what the simulation keeps
  double worker = 0;      // [byte] of memory: one drawing process, 0 without pictures
  double shared = 0;      // [byte] of memory: pictures on their way, per drawing process
  int workers = 0;        // drawing processes
  bool simulated = true;  // the whole run was simulated for this; else steps, frames and the rest are stretched from its beginning

  double memory() const { return recording + workers * (worker + shared); }
};

/// Simulates for at most two seconds of the clock.
Estimate estimate_results(const scenes::Scene&, const engine::Plan&);
/// The same, and draws three frames into a folder for temporary files.
Estimate estimate_film(const scenes::Scene&, const engine::Plan&, const FilmPlan&);

/// "at most 400 steps of 0.001 s, about 70 MB of memory, 210 kB on the disk, 3.1 s".
std::string estimate_text(const Estimate&, double step);
/// steps, simulated, memory_bytes, disk_bytes, seconds, workers.
nlohmann::ordered_json estimate_json(const Estimate&);

/// "1.2 GB", as --max-memory reads it.
std::string bytes_text(double bytes);
/// "2 GB", "512 MB", "1.5GiB". Throws UsageError.
double parse_bytes(const std::string& option, const std::string& text);

/// While it lives, what the scene's author wrote (meshes, pictures) takes no more memory than --max-memory, or than any sound scene
/// needs where that is less: what the job needs is then told from the estimate, which draws three frames without the limit.
class LoadingLimit {
 public:
  /// [byte]; 0: no limit.
  explicit LoadingLimit(double ceiling);
  ~LoadingLimit();
  LoadingLimit(const LoadingLimit&) = delete;
  LoadingLimit& operator=(const LoadingLimit&) = delete;

 private:
  rlimit before_{};
  bool held_ = false;
};

/// Holds this process, and each it starts, to so many bytes of memory for good. Throws MachineError.
void limit_memory(double bytes);

/// Holds this process and those it starts to the ceiling; what then does not fit ends with "not enough memory". Before it, throws
/// UsageError when the estimate says that the job does not fit, and lowers `workers` where fewer drawing processes do.
void hold_to_memory(const Estimate&, double ceiling, int& workers, bool quiet);

}  // namespace cli
