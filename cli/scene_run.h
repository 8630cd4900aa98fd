// What the commands that take a scene share: its arguments, loading it, running it.
#pragma once

#include <string>
#include <vector>

#include "cli/arguments.h"
#include "cli/progress.h"
#include "engine/plan.h"
#include "engine/recording.h"
#include "scenes/scene.h"

namespace cli {

struct SceneArguments {
  std::string scene;
  std::vector<std::string> set;      // path.to.key=value
  std::vector<std::string> effects;  // name=on|off|auto
  std::vector<std::string> allow;    // folders
  std::string progress = "auto";
  bool quiet = false;
  bool verbose = false;
  bool json = false;
};

/// --allow, which every command that reads scenes has.
void declare_allow(Arguments&, std::vector<std::string>& allow);
/// SCENE, --set, --allow, --json, --quiet, --verbose.
void declare_scene_file(Arguments&, SceneArguments&);
/// The same, and --effects NAME=on|off|auto.
void declare_scene(Arguments&, SceneArguments&);
/// --progress, for commands that take their time.
void declare_progress(Arguments&, SceneArguments&);
ShowProgress progress_of(const SceneArguments&);

/// Loads the scene (or that of a finished run whose folder is named, with the values it was run with), tells its warnings, and puts
/// program version and forced effects where every picture shows them.
/// With a ceiling [byte] no file that the scene names takes more memory than that while it is read.
scenes::Scene load_scene(const SceneArguments&, double memory_ceiling = 0);

/// Its title, or the name of its file without one, and what was changed in it: the head of printed results and of pages. A table
/// must not say 40 km/h over a run at 50.
std::string heading_of(const scenes::Scene&);

/// The plan of a loaded scene. Throws UsageError for an effect that does not exist.
engine::Plan plan_of(const scenes::Scene&);

/// Whether a run takes the time of each effect; --verbose does too.
enum class Costs { counted, timed };

/// Runs the scene with progress. A divergence is told on standard error; exit_code_of says how the program should end.
engine::Recording run_scene(const scenes::Scene&, const engine::Plan&, const SceneArguments&, Costs = Costs::counted);
int exit_code_of(const engine::Recording&);

/// What is odd about the run: what it told itself, what the scene leaves out, and who stands inside a vehicle as it begins.
std::vector<std::string> warnings_of(const scenes::Scene&, const engine::Recording&);

}  // namespace cli
