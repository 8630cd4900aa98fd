// Which frames a render command asks for, and into which files: worked out and checked before anything is simulated or drawn.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cli/arguments.h"
#include "cli/parse.h"
#include "render/film.h"
#include "render/frames.h"
#include "scenes/scene.h"

namespace cli {

struct FilmArguments {
  std::string output;
  std::string size;
  std::string fps;
  std::vector<std::string> cameras;
  std::string eye, look_at, lens;  // a camera of the command line
  std::string from;
  std::string to;
  std::string frames;
  std::string quality;
  std::string jobs;
  std::vector<std::string> at;
  bool overwrite = false;
  bool resume = false;
};

void declare_film(Arguments&, FilmArguments&);

/// The request, read and checked against the scene. Times in simulated seconds.
struct FilmPlan {
  render::FilmJob job;         // output, container, size, rate, quality, workers
  std::vector<double> stills;  // --at; empty: a film
  double from = 0;
  double to = 0;
  std::vector<FrameRange> frames;  // --frames; empty: all
  bool resume = false;             // keep what is finished
  bool whole = true;               // nothing was asked to be left out
};

/// What one camera shows, or the scene's shots: one simulation serves them all.
struct View {
  FilmPlan plan;
  render::Stage stage;
};

/// One view a camera asked for; one of the scene's shots where none was. Where there are several, each has the camera's name in its
/// output: OUT_side.mp4, OUT_side_0.200s.png, OUT/side/frame_00000.png. Throws UsageError; refuses what exists. With --camera the
/// scene's shots give way to the whole run from that camera.
std::vector<View> plan_views(const FilmArguments&, const scenes::Scene&);

/// The film that `render` makes of the scene when nothing but -o is given (empty: not even that): its files, kind and size.
render::FilmJob film_job(const std::string& output, const scenes::Scene&);

/// Makes the folders the film goes into. Throws MachineError when they cannot be written.
void prepare_output(const FilmPlan&);

/// Throws UsageError when a file of the job is there and may not be replaced.
void refuse_existing_files(const FilmPlan&);

/// Whether a name is one that the job's pattern makes.
bool is_frame_of(const render::FilmJob&, const std::string& name);
/// Whether a name is that of a file the job writes.
bool is_file_of(const FilmPlan&, const std::string& name);

/// Shows every file that the job's pattern could have made, whoever made it, with its number.
void look_at_frames(const render::FilmJob&, const std::function<void(const std::filesystem::path&, int number)>& look);

/// The frames asked for, of a run that ends at `end_time` [s].
render::Film frames_of(const FilmPlan&, const render::Stage&, double end_time);

/// The moment of a still: seen as the film would show that time.
render::Moment still_of(const FilmPlan&, const render::Stage&, double time);
/// "draft", "standard" or "fine".
render::Quality quality_of(const std::string& name);
/// The file of one still: the output itself, or with the time in its name where there are several.
std::filesystem::path still_file(const FilmPlan&, double time);

}  // namespace cli
