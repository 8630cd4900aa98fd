#include "cli/film_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <tuple>

#include "cli/exit.h"
#include "cli/output/whole_file.h"
#include "scenes/loader/value.h"

namespace cli {
namespace {

namespace fs = std::filesystem;
using render::Container;

constexpr double kLargestRate = 1000;  // [1/s] frames
constexpr int kMostWorkers = 256;

/// Where the pictures go is read off the name: OUT.mp4, a pattern, one PNG, a folder.
void choose_container(const FilmArguments& wish, const scenes::Scene& scene, FilmPlan& plan) {
  const bool stills = !plan.stills.empty();
  const std::string fallback = scene.path.stem().string() + (stills ? ".png" : ".mp4");
  const std::string name = wish.output.empty() ? fallback : wish.output;
  const fs::path path = name;
  const std::string extension = path.extension().string();
  plan.job.output = path;
  if (name.find('%') != std::string::npos) {
    if (stills) throw UsageError("--at draws single PNGs; name one file, like -o still.png");
    // only %d and %0Nd, once: the name becomes a format
    const std::string file = path.filename().string();
    const std::size_t percent = file.find('%');
    const std::size_t end = percent == std::string::npos ? percent : file.find_first_not_of("0123456789", percent + 1);
    if (end == std::string::npos || file[end] != 'd' || file.find('%', end) != std::string::npos || end - percent > 3 ||
        extension != ".png") {
      throw UsageError(fmt::format("-o is \"{}\", a pattern must hold one %05d in its file name and end in .png", name));
    }
    plan.job.container = Container::png_sequence;
  } else if (extension == ".png") {
    if (!stills)
      throw UsageError(
          fmt::format("-o is \"{}\", a single PNG needs --at TIME; for a sequence name a folder or frame_%05d.png", name));
    plan.job.container = Container::single_png;
  } else if (stills) {
    throw UsageError(fmt::format("-o is \"{}\", --at draws PNGs; name a file that ends in .png", name));
  } else if (extension == ".mp4") {
    plan.job.container = Container::mp4;
  } else if (extension == ".mkv") {
    plan.job.container = Container::mkv;
  } else if (extension.empty() || fs::is_directory(path)) {
    plan.job.output = path / "frame_%05d.png";
    plan.job.container = Container::png_sequence;
  } else {
    throw UsageError(fmt::format("-o is \"{}\", must end in .mp4, .mkv or .png, or name a folder", name));
  }
}

void choose_size(const FilmArguments& wish, const scenes::Scene& scene, FilmPlan& plan) {
  render::FilmJob& job = plan.job;
  job.width = scene.output.width;
  job.height = scene.output.height;
  if (!wish.size.empty()) std::tie(job.width, job.height) = parse_size("--size", wish.size);
  const bool odd = job.width % 2 != 0 || job.height % 2 != 0;
  if (odd && job.container == Container::mp4) {
    const int width = job.width + job.width % 2;
    const int height = job.height + job.height % 2;
    throw UsageError(fmt::format("{} is {}x{}, H.264 needs an even width and height; take {}x{}, or PNGs",
                                 wish.size.empty() ? "the scene's output size" : "--size", job.width, job.height, width, height));
  }
}

/// With --camera the whole run is seen from there.
void choose_camera(const FilmArguments& wish, scenes::Scene& scene) {
  if (wish.camera.empty()) return;
  std::vector<std::string> names;
  for (const render::Camera& camera : scene.stage.cameras) names.push_back(camera.name);
  if (std::find(names.begin(), names.end(), wish.camera) == names.end()) {
    const std::string near = scenes::nearest(wish.camera, names);
    throw UsageError(fmt::format("--camera is \"{}\", the scene has {}{}", wish.camera, fmt::join(names, ", "),
                                 near.empty() ? "" : fmt::format("; did you mean {}?", near)));
  }
  // the first camera is the one that films the whole run when there are no shots
  const auto chosen = std::find_if(scene.stage.cameras.begin(), scene.stage.cameras.end(),
                                   [&wish](const render::Camera& camera) { return camera.name == wish.camera; });
  std::rotate(scene.stage.cameras.begin(), chosen, chosen + 1);
  scene.stage.shots.clear();
  scene.stage.cards.clear();
}

void choose_times(const FilmArguments& wish, const scenes::Scene& scene, FilmPlan& plan) {
  const double duration = scene.model.settings.duration;
  for (const std::string& text : wish.at) {
    plan.stills.push_back(parse_time("--at", text));
    if (plan.stills.back() > duration) throw UsageError(fmt::format("--at is \"{}\", the scene ends at {} s", text, duration));
  }
  const bool cut = !wish.from.empty() || !wish.to.empty() || !wish.frames.empty();
  if (cut && !plan.stills.empty()) throw UsageError("--at draws stills; leave --from, --to and --frames away");
  plan.from = wish.from.empty() ? 0 : parse_time("--from", wish.from);
  plan.to = wish.to.empty() ? duration : parse_time("--to", wish.to);
  if (plan.to <= plan.from)
    throw UsageError(fmt::format("--from {} s to {} s holds no time; the scene lasts {} s", plan.from, plan.to, duration));
  if (!wish.frames.empty()) plan.frames = parse_frames("--frames", wish.frames);
}

/// Whether `name` is what the pattern's %0Nd makes of some number.
bool matches(const std::string& name, const std::string& pattern) {
  const std::size_t percent = pattern.find('%');
  const std::string head = pattern.substr(0, percent);
  const std::string tail = pattern.substr(pattern.find('d', percent) + 1);
  if (name.size() <= head.size() + tail.size() || !name.starts_with(head) || !name.ends_with(tail)) return false;
  const std::string middle = name.substr(head.size(), name.size() - head.size() - tail.size());
  return middle.find_first_not_of("0123456789") == std::string::npos;
}

void refuse_existing_frames(const FilmPlan& plan) {
  if (plan.job.overwrite) return;
  if (const std::vector<fs::path> there = frames_there(plan.job); !there.empty())
    throw UsageError(fmt::format("{} exists; give --overwrite to replace frames, or another -o", there.front().string()));
}

}  // namespace

std::vector<fs::path> frames_there(const render::FilmJob& job) {
  const fs::path folder = job.output.parent_path();
  std::vector<fs::path> out;
  std::error_code missing;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.empty() ? "." : folder, missing)) {
    const fs::path name = entry.path().filename();
    if (matches(name.string(), job.output.filename().string())) out.push_back(folder / name);
  }
  std::sort(out.begin(), out.end());
  return out;
}

void declare_film(Arguments& arguments, FilmArguments& film) {
  arguments.option(
      "-o,--output", film.output, "OUT",
      "OUT.mp4, OUT.mkv (lossless), a folder or pattern (frame_%05d.png), or one PNG with --at; default: the scene's name");
  arguments.repeatable("--at", film.at, "TIME", "draw a still at this simulated time: 0.2s");
  arguments.option("--camera", film.camera, "NAME", "the whole run from this camera instead of the scene's shots");
  arguments.option("--from", film.from, "TIME", "leave out what comes before this simulated time");
  arguments.option("--to", film.to, "TIME", "leave out what comes after it");
  arguments.option("--frames", film.frames, "LIST", "only these frames of the film, counted from 0: 7, 1-100, 1-100x5, 10-, lists");
  arguments.option("--fps", film.fps, "N", "frames a second");
  arguments.option("--size", film.size, "WxH", "pixels");
  arguments.choice("--quality", film.quality, {"draft", "standard", "fine"}, "looks against time");
  arguments.option("-j,--jobs", film.jobs, "N", "processes that draw; default: one a core");
  arguments.flag("--overwrite", film.overwrite, "replace files that exist");
  arguments.flag("--resume", film.resume, "begin, or go on where the same command was stopped; keeps every finished frame");
}

FilmPlan plan_film(const FilmArguments& wish, scenes::Scene& scene) {
  FilmPlan plan;
  choose_camera(wish, scene);
  choose_times(wish, scene, plan);
  choose_container(wish, scene, plan);
  choose_size(wish, scene, plan);
  plan.job.fps = wish.fps.empty() ? scene.output.fps : parse_number("--fps", wish.fps, 1, kLargestRate);
  plan.job.quality = quality_of(wish.quality.empty() ? scene.output.quality : wish.quality);
  plan.job.workers = wish.jobs.empty() ? 0 : parse_integer("--jobs", wish.jobs, 1, kMostWorkers);
  plan.job.overwrite = wish.overwrite;
  plan.job.metadata = {{"title", scene.title},
                       {"version", fmt::format("crashreel {}", CRASHREEL_VERSION)},
                       {"scene", scene.path.filename().string()},
                       {"scene_sha256", scene.sha256}};
  plan.resume = wish.resume;
  plan.whole = wish.frames.empty() && wish.from.empty() && wish.to.empty();
  if (wish.resume && wish.overwrite) throw UsageError("--resume keeps what --overwrite replaces; give one of them");
  // what is there may be a part of this very run: looked at when its fingerprint is known
  const bool replace = wish.overwrite || wish.resume;
  if (plan.job.container == Container::png_sequence && !replace) refuse_existing_frames(plan);
  if (render::is_video(plan.job.container)) refuse_existing(plan.job.output, replace);
  for (const double time : plan.stills) refuse_existing(still_file(plan, time), replace);
  return plan;
}

void prepare_output(const FilmPlan& plan) {
  make_writable_folder(plan.job.output.parent_path());
}

Selection frames_of(const FilmPlan& plan, const render::Stage& stage, const engine::Recording& recording) {
  const std::vector<render::Moment> all = render::film(stage, recording, plan.job.fps);
  constexpr double kRounding = 1e-9;  // [s] frame times are sums of 1/fps
  Selection out;
  for (int i = 0; i < static_cast<int>(all.size()); ++i) {
    const render::Moment& moment = all[static_cast<std::size_t>(i)];
    const bool listed = plan.frames.empty() || std::any_of(plan.frames.begin(), plan.frames.end(),
                                                           [i](const FrameRange& range) { return range.holds(i); });
    if (!listed || moment.time < plan.from - kRounding || moment.time > plan.to + kRounding) continue;
    out.numbers.push_back(i);
    out.moments.push_back(moment);
  }
  return out;
}

render::Moment still_of(const FilmPlan&, const render::Stage& stage, double time) {
  for (const render::Shot& shot : stage.shots) {
    if (time >= shot.from && time <= shot.to) return {time, shot.camera, 1, shot.layout, shot.second};
  }
  return {time, stage.cameras.front().name, 1};
}

fs::path still_file(const FilmPlan& plan, double time) {
  if (plan.stills.size() == 1) return plan.job.output;
  const fs::path& output = plan.job.output;
  return output.parent_path() / fmt::format("{}_{:.3f}s{}", output.stem().string(), time, output.extension().string());
}

render::Quality quality_of(const std::string& name) {
  if (name == "draft") return render::Quality::draft;
  return name == "fine" ? render::Quality::fine : render::Quality::standard;
}

}  // namespace cli
