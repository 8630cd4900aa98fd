#include "cli/film_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <tuple>

#include "cli/camera_presets.h"
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
  const fs::path path(name);
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
      throw UsageError(fmt::format("-o is \"{}\": a pattern must hold one %05d in its file name and end in .png", name));
    }
    plan.job.container = Container::png_sequence;
  } else if (extension == ".png") {
    if (!stills)
      throw UsageError(
          fmt::format("-o is \"{}\": a single PNG needs --at TIME; for a sequence name a folder or frame_%05d.png", name));
    plan.job.container = Container::single_png;
  } else if (stills) {
    throw UsageError(fmt::format("-o is \"{}\": --at draws PNGs; name a file that ends in .png", name));
  } else if (extension == ".mp4") {
    plan.job.container = Container::mp4;
  } else if (extension == ".mkv") {
    plan.job.container = Container::mkv;
  } else if (extension.empty() || fs::is_directory(path)) {
    plan.job.output = path / "frame_%05d.png";
    plan.job.container = Container::png_sequence;
  } else {
    throw UsageError(fmt::format("-o is \"{}\": must end in .mp4, .mkv or .png, or name a folder", name));
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

/// With a camera the whole run is seen from there.
void choose_camera(const std::string& wanted, const scenes::Scene& scene, render::Stage& stage) {
  const auto named = [&wanted](const render::Camera& camera) { return camera.name == wanted; };
  if (std::none_of(stage.cameras.begin(), stage.cameras.end(), named)) {
    if (const auto preset = preset_camera(wanted, scene)) {
      stage.cameras.push_back(*preset);
    } else {
      std::vector<std::string> names;
      for (const render::Camera& camera : stage.cameras) names.push_back(camera.name);
      const std::vector<std::string> presets = preset_names();
      std::vector<std::string> all = names;
      all.insert(all.end(), presets.begin(), presets.end());
      const std::string near = scenes::nearest(wanted, all);
      throw UsageError(fmt::format("--camera is \"{}\": the scene has {}; presets: {}{}", wanted, fmt::join(names, ", "),
                                   fmt::join(presets, ", "), near.empty() ? "" : fmt::format("; did you mean {}?", near)));
    }
  }
  // the first camera is the one that films the whole run when there are no shots
  const auto chosen = std::find_if(stage.cameras.begin(), stage.cameras.end(), named);
  std::rotate(stage.cameras.begin(), chosen, chosen + 1);
  stage.shots.clear();
  stage.cards.clear();
}

/// The output with a camera's name in it, where several cameras write.
fs::path with_camera(const fs::path& output, Container container, const std::string& camera) {
  if (container == Container::png_sequence) return output.parent_path() / camera / output.filename();
  return output.parent_path() / (output.stem().string() + "_" + camera + output.extension().string());
}

/// A name that can stand in a file's name.
std::string as_file_name(std::string camera) {
  for (char& c : camera)
    if (c == '/' || c == '%' || c == '\0') c = '_';
  return camera;
}

void choose_times(const FilmArguments& wish, const scenes::Scene& scene, FilmPlan& plan) {
  const double duration = scene.model.settings.duration;
  for (const std::string& text : wish.at) {
    const double time = parse_time("--at", text);
    // the same moment twice is one picture
    if (std::find(plan.stills.begin(), plan.stills.end(), time) != plan.stills.end()) continue;
    plan.stills.push_back(time);
    if (time > duration) throw UsageError(fmt::format("--at is \"{}\": the scene ends at {} s", text, duration));
  }
  const bool cut = !wish.from.empty() || !wish.to.empty() || !wish.frames.empty();
  if (cut && !plan.stills.empty()) throw UsageError("--at draws stills; leave --from, --to and --frames away");
  plan.from = wish.from.empty() ? 0 : parse_time("--from", wish.from);
  plan.to = wish.to.empty() ? duration : parse_time("--to", wish.to);
  if (plan.to <= plan.from)
    throw UsageError(fmt::format("--from {} s to {} s holds no time; the scene lasts {} s", plan.from, plan.to, duration));
  if (!wish.frames.empty()) plan.frames = parse_frames("--frames", wish.frames);
}

/// The number of which the pattern's %0Nd makes `name`; one of no frame, -1, where it is too large.
std::optional<int> number_in(const std::string& name, const std::string& pattern) {
  const std::size_t percent = pattern.find('%');
  const std::string head = pattern.substr(0, percent);
  const std::string tail = pattern.substr(pattern.find('d', percent) + 1);
  if (name.size() <= head.size() + tail.size() || !name.starts_with(head) || !name.ends_with(tail)) return std::nullopt;
  const std::string middle = name.substr(head.size(), name.size() - head.size() - tail.size());
  if (middle.find_first_not_of("0123456789") != std::string::npos) return std::nullopt;
  int number = -1;
  std::from_chars(middle.data(), middle.data() + middle.size(), number);
  return number;
}

void refuse_existing_frames(const FilmPlan& plan) {
  if (plan.job.overwrite) return;
  std::optional<fs::path> first;
  look_at_frames(plan.job, [&](const fs::path& file, int) { first = first ? std::min(*first, file) : file; });
  if (first) throw UsageError(fmt::format("{} exists; give --overwrite to replace frames, or another -o", first->string()));
}

}  // namespace

void refuse_existing_files(const FilmPlan& plan) {
  // what is there may be a part of this very run: looked at when its fingerprint is known
  const bool replace = plan.job.overwrite || plan.resume;
  if (plan.job.container == Container::png_sequence && !replace) refuse_existing_frames(plan);
  if (render::is_video(plan.job.container)) refuse_existing(plan.job.output, replace);
  for (const double time : plan.stills) refuse_existing(still_file(plan, time), replace);
}

bool is_frame_of(const render::FilmJob& job, const std::string& name) {
  return number_in(name, job.output.filename().string()).has_value();
}

bool is_file_of(const FilmPlan& plan, const std::string& name) {
  const std::string output = plan.job.output.filename().string();
  if (plan.job.container == Container::png_sequence) return is_frame_of(plan.job, name);
  if (render::is_video(plan.job.container)) return name == output || name == output + ".whole";
  return std::any_of(plan.stills.begin(), plan.stills.end(),
                     [&](double time) { return still_file(plan, time).filename() == name; });
}

void look_at_frames(const render::FilmJob& job, const std::function<void(const fs::path&, int)>& look) {
  const fs::path folder = job.output.parent_path();
  std::error_code missing;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.empty() ? "." : folder, missing)) {
    const fs::path name = entry.path().filename();
    if (const auto number = number_in(name.string(), job.output.filename().string())) look(folder / name, *number);
  }
}

void declare_film(Arguments& arguments, FilmArguments& film) {
  arguments.option(
      "-o,--output", film.output, "OUT",
      "OUT.mp4, OUT.mkv (lossless), a folder or pattern (frame_%05d.png), or one PNG with --at; default: the scene's name");
  arguments.repeatable("--at", film.at, "TIME", "draw a still at this simulated time: 0.2s, 200ms; without unit: seconds");
  arguments.repeatable(
      "--camera", film.cameras, "NAME",
      "the whole run from this camera of the scene, or top, side, front, follow, driver (of the vehicle that nears the person "
      "on foot fastest, else the fastest); several: an output each");
  arguments.option("--eye", film.eye, "\"X Y Z m\"", "a camera of one's own: where it stands, in world axes");
  arguments.option("--look-at", film.look_at, "\"X Y Z m\"", "what it looks at; default: the middle of what the scene holds");
  arguments.option("--lens", film.lens, "\"35 mm\"", "its focal length, as on a 36 x 24 mm film");
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

namespace {

/// `camera` is the one that stands in the output's name, empty: none does.
FilmPlan plan_film(const FilmArguments& wish, const scenes::Scene& scene, const render::Stage& stage, const std::string& camera) {
  FilmPlan plan;
  choose_times(wish, scene, plan);
  choose_container(wish, scene, plan);
  if (!camera.empty()) plan.job.output = with_camera(plan.job.output, plan.job.container, as_file_name(camera));
  choose_size(wish, scene, plan);
  plan.job.fps = wish.fps.empty() ? scene.output.fps : parse_number("--fps", wish.fps, 1, kLargestRate);
  plan.job.quality = quality_of(wish.quality.empty() ? scene.output.quality : wish.quality);
  plan.job.workers = wish.jobs.empty() ? 0 : parse_integer("--jobs", wish.jobs, 1, kMostWorkers);
  plan.job.overwrite = wish.overwrite;
  plan.job.metadata = {{"title", scene.stage.title},
                       {"version", fmt::format("crashreel {}", CRASHREEL_VERSION)},
                       {"scene", scene.path.filename().string()},
                       {"scene_sha256", scene.sha256}};
  plan.resume = wish.resume;
  plan.whole = wish.frames.empty() && wish.from.empty() && wish.to.empty();
  if (wish.resume && wish.overwrite) throw UsageError("--resume keeps what --overwrite replaces; give one of them");
  refuse_existing_files(plan);
  // refuses a film too long for its rate
  if (plan.stills.empty()) render::Film(stage, scene.model.settings.duration, plan.job.fps);
  return plan;
}

}  // namespace

std::vector<View> plan_views(const FilmArguments& wish, const scenes::Scene& scene) {
  std::vector<std::string> cameras = wish.cameras;
  render::Stage stage = scene.stage;
  const std::string own = "eye";
  if (!wish.eye.empty()) {
    std::erase_if(stage.cameras, [&own](const render::Camera& camera) { return camera.name == own; });
    stage.cameras.push_back(camera_at(own, wish.eye, wish.look_at, wish.lens, scene));
    cameras.push_back(own);
  } else if (!wish.look_at.empty() || !wish.lens.empty()) {
    throw UsageError("--look-at and --lens belong to --eye: give the camera's place as well");
  }
  std::vector<View> out;
  if (cameras.empty()) out.push_back({plan_film(wish, scene, stage, ""), stage});
  for (const std::string& camera : cameras) {
    if (std::count(cameras.begin(), cameras.end(), camera) > 1)
      throw UsageError(fmt::format("--camera {} is given twice; once is enough", camera));
    View view{{}, stage};
    choose_camera(camera, scene, view.stage);
    view.plan = plan_film(wish, scene, view.stage, cameras.size() > 1 ? camera : "");
    out.push_back(std::move(view));
  }
  return out;
}

render::FilmJob film_job(const std::string& output, const scenes::Scene& scene) {
  FilmArguments wish;
  wish.output = output;
  FilmPlan plan;
  choose_container(wish, scene, plan);
  std::tie(plan.job.width, plan.job.height) = std::pair(scene.output.width, scene.output.height);
  return plan.job;
}

void prepare_output(const FilmPlan& plan) {
  make_writable_folder(plan.job.output.parent_path());
}

render::Film frames_of(const FilmPlan& plan, const render::Stage& stage, double end_time) {
  const render::Film whole(stage, end_time, plan.job.fps);
  const render::Film shown = whole.between(plan.from, plan.to);
  if (plan.frames.empty()) return shown;
  std::vector<render::FrameInterval> listed;
  for (const FrameRange& range : plan.frames) {
    const int last = range.last < 0 ? whole.size() - 1 : std::min(range.last, whole.size() - 1);
    if (range.step == 1 && last >= range.first) listed.push_back({range.first, last});
    if (range.step == 1) continue;
    for (long frame = range.first; frame <= last; frame += range.step)
      listed.push_back({static_cast<int>(frame), static_cast<int>(frame)});
  }
  return shown.part(std::move(listed));
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
