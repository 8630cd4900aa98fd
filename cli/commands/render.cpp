// crashreel render SCENE: simulate, then draw.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/camera_presets.h"
#include "cli/command.h"
#include "cli/disk_room.h"
#include "cli/estimate.h"
#include "cli/exit.h"
#include "cli/film_plan.h"
#include "cli/foresight.h"
#include "cli/output/fingerprint.h"
#include "cli/output/json.h"
#include "cli/output/lock.h"
#include "cli/output/whole_file.h"
#include "cli/process.h"
#include "cli/resume.h"
#include "cli/scene_run.h"
#include "cli/timings.h"
#include "engine/measure/impacts.h"
#include "render/renderer.h"

namespace cli {
namespace {

struct RenderWish {
  SceneArguments scene;
  FilmArguments film;
  bool list_cameras = false;
  bool dry_run = false;
  bool timings = false;
  std::string gl = "osmesa";
  std::string max_memory;
};

/// What the command leaves behind.
struct Drawn {
  std::vector<std::string> files;
  int frames = 0;
  render::FilmCost cost{};
};

void list_cameras(const scenes::Scene& scene, bool json) {
  constexpr const char* kKinds[] = {"fixed", "follow", "orbit", "top", "eye", "path"};
  nlohmann::ordered_json cameras = nlohmann::ordered_json::array();
  for (const render::Camera& camera : scene.stage.cameras) {
    cameras.push_back({{"name", camera.name}, {"kind", kKinds[static_cast<int>(camera.kind)]}, {"follow", camera.follow}});
    if (!json)
      fmt::print("{:<16} {}{}\n", camera.name, kKinds[static_cast<int>(camera.kind)],
                 camera.follow.empty() ? "" : " " + camera.follow);
  }
  if (json)
    fmt::print("{}\n", json_text(cameras));
  else
    fmt::print(stderr, "besides these every scene has {}\n", fmt::join(preset_names(), ", "));
}

/// The scene as one view shows it.
scenes::Scene seen_by(const View& view, const scenes::Scene& scene) {
  scenes::Scene out = scene;
  out.stage = view.stage;
  return out;
}

int tell_estimates(const scenes::Scene& scene, const std::vector<View>& views, bool json) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const View& view : views) {
    const render::FilmJob& job = view.plan.job;
    const Estimate estimate = estimate_film(seen_by(view, scene), plan_of(scene), view.plan);
    all.push_back({{"output", job.output.string()},
                   {"frames", estimate.frames},
                   {"width", job.width},
                   {"height", job.height},
                   {"fps", job.fps}});
    all.back().update(estimate_json(estimate));
    if (!json)
      fmt::print("{}: {} frames of {}x{}, {}\n", job.output.string(), estimate.frames, job.width, job.height,
                 estimate_text(estimate, scene.model.settings.step));
  }
  if (json) fmt::print("{}\n", json_text(all.size() == 1 ? all.front() : all));
  return kDone;
}

Drawn draw_stills(const FilmPlan& plan, const engine::Model& model, const render::Stage& stage, const engine::Recording& recording,
                  ShowProgress show) {
  const double aspect = static_cast<double>(plan.job.width) / plan.job.height;
  Drawn drawn;
  if (std::any_of(plan.stills.begin(), plan.stills.end(), [&](double time) { return time > recording.end_time() + 5e-4; }))
    fmt::print(stderr, "crashreel: warning: the run ends at {:.3f} s; a picture of a later time shows its end\n",
               recording.end_time());
  for (const double time : plan.stills) {
    render::FilmJob job = plan.job;
    job.output = still_file(plan, time);
    const render::Moment moment = still_of(plan, stage, time);
    if (show != ShowProgress::never && is_empty_picture(model, stage, recording, moment, aspect))
      fmt::print(stderr, "crashreel: warning: at {:.3f} s camera {} shows no vehicle, person or body\n", time, moment.camera);
    if (!plan.resume || !is_finished(job.output, moment, job))
      add(render::make_film(stage, recording, render::Film({moment}), job), drawn.cost);
    drawn.files.push_back(job.output.string());
    ++drawn.frames;
  }
  return drawn;
}

render::FilmCost draw_frames(const render::Film& film, const render::FilmJob& job, const render::Stage& stage,
                             const engine::Recording& recording, ShowProgress show) {
  if (film.empty()) return {};  // all of it was there
  Progress progress("draw", "frames", film.size(), show);
  const render::FilmCost cost =
      render::make_film(stage, recording, film, job, [&](const render::FilmProgress& now) { progress.at(now.frames_done); });
  progress.finish(film.size());
  return cost;
}

/// --resume: every frame goes to the disk first and stays there until the film of them is whole.
render::FilmCost draw_film_by_frames(const render::Film& film, const FilmPlan& plan, const render::Stage& stage,
                                     const engine::Recording& recording, ShowProgress show) {
  const render::FilmJob frames = frames_job(plan.job);
  const auto clear = [&frames] {
    clear_parts(frames.output.parent_path(), [&frames](const std::string& name) { return is_frame_of(frames, name); });
  };
  clear();
  render::FilmCost cost;
  if (!film_is_finished(plan.job)) {
    make_writable_folder(frames.output.parent_path());
    cost = draw_frames(unfinished(film, frames), frames, stage, recording, show);
    render::join_film(stage, recording, film, frames, plan.job);
  }
  clear();  // of workers that died
  remove_frames(frames, show == ShowProgress::never);
  return cost;
}

Drawn draw_film(const FilmPlan& plan, const render::Stage& stage, const engine::Recording& recording, ShowProgress show) {
  const render::Film film = frames_of(plan, stage, recording.end_time());
  if (film.empty()) {
    throw UsageError(fmt::format("no frame lies in the part asked for; the run ends at {:.3f} s and its film has {} frames",
                                 recording.end_time(), render::Film(stage, recording.end_time(), plan.job.fps).size()));
  }
  Drawn drawn{{plan.job.output.string()}, film.size()};
  const bool sequence = !render::is_video(plan.job.container);
  if (sequence && plan.resume && plan.whole) refuse_surplus(film, plan.job);
  if (!sequence && plan.resume)
    drawn.cost = draw_film_by_frames(film, plan, stage, recording, show);
  else
    drawn.cost = draw_frames(plan.resume ? unfinished(film, plan.job) : film, plan.job, stage, recording, show);
  if (sequence && plan.whole && plan.job.overwrite) remove_surplus(film, plan.job, show == ShowProgress::never);
  return drawn;
}

/// What can be gone on with when the program is stopped.
std::string kept_of(const FilmPlan& plan) {
  const bool video = render::is_video(plan.job.container);
  if (plan.resume) return "finished frames are kept, and the same command goes on from there";
  if (video) return "nothing was kept; with --resume a film keeps its finished frames";
  return "finished pictures are kept; with --resume in place of --overwrite the same command draws the rest";
}

void hold_to_memory(std::vector<View>& views, double ceiling, const scenes::Scene& scene, bool quiet) {
  for (View& view : views)
    cli::hold_to_memory(estimate_film(seen_by(view, scene), plan_of(scene), view.plan), ceiling, view.plan.job.workers, quiet);
}

/// Pictures of a view if the run takes its whole time; none of a film too long to be drawn, whose run may still end early.
int most_frames(const View& view, double duration) {
  if (!view.plan.stills.empty()) return 0;
  try {
    return frames_of(view.plan, view.stage, duration).size();
  } catch (const render::FilmTooLong&) {
    return 0;
  }
}

/// A disk that is full is told before the run. It is a guess, so the work is done all the same.
void tell_room(const std::vector<View>& views, double duration) {
  for (const View& view : views) {
    const bool keeps_frames = view.plan.resume && render::is_video(view.plan.job.container);
    const render::FilmJob& film = view.plan.job;
    if (const auto told = short_of_room(keeps_frames ? frames_job(film) : film, most_frames(view, duration)))
      fmt::print(stderr, "crashreel: warning: {}\n", *told);
  }
}

/// Of films: stills show no cards.
void tell_crowded_cards(const std::vector<View>& views) {
  for (const View& view : views)
    if (view.plan.stills.empty())
      for (const std::string& crowded : crowded_cards(view.stage, view.plan.job.width, view.plan.job.height))
        fmt::print(stderr, "crashreel: warning: {}\n", crowded);
}

/// Folders made and held against other runs.
std::vector<std::unique_ptr<OutputLock>> held(const std::vector<View>& views) {
  std::vector<std::unique_ptr<OutputLock>> locks;
  for (const View& view : views) {
    const FilmPlan& plan = view.plan;
    prepare_output(plan);
    locks.push_back(
        std::make_unique<OutputLock>(plan.job.output, [&plan](const std::string& name) { return is_file_of(plan, name); }));
    refuse_existing_files(plan);  // another run may have held the lock, and be done
  }
  return locks;
}

void mark_with_fingerprints(std::vector<View>& views, const scenes::Scene& scene, const Arguments& arguments,
                            const engine::Recording& recording) {
  for (View& view : views) {
    const bool video = render::is_video(view.plan.job.container) && view.plan.stills.empty();
    view.plan.job.metadata["fingerprint"] =
        fingerprint(video ? ResultKind::whole : ResultKind::frame, scene, arguments, engine::hash(recording));
  }
}

/// All views of one recording, one after the other.
Drawn draw_views(const std::vector<View>& views, const engine::Model& model, const engine::Recording& recording,
                 ShowProgress show) {
  Drawn all;
  for (const View& view : views) {
    render::Stage stage = view.stage;
    if (recording.failure) stage.warnings.push_back(fmt::format("the model diverged at {:.3f} s", recording.failure->time));
    const Drawn drawn = view.plan.stills.empty() ? draw_film(view.plan, stage, recording, show)
                                                 : draw_stills(view.plan, model, stage, recording, show);
    all.files.insert(all.files.end(), drawn.files.begin(), drawn.files.end());
    all.frames += drawn.frames;
    add(drawn.cost, all.cost);
  }
  return all;
}

void tell_drawn(const RenderWish& wish, const render::FilmJob& job, const Drawn& drawn, const engine::Recording& recording,
                double seconds) {
  if (wish.scene.json) {
    nlohmann::ordered_json out = {{"files", drawn.files},
                                  {"frames", drawn.frames},
                                  {"width", job.width},
                                  {"height", job.height},
                                  {"fps", job.fps},
                                  {"simulated_s", recording.end_time()},
                                  {"simulate_wall_s", recording.wall_s},
                                  {"wall_s", seconds}};
    if (wish.timings) out["timings"] = timings_json(drawn.cost);
    fmt::print("{}\n", json_text(out));
    return;
  }
  if (wish.timings) fmt::print("{}", timings_text(drawn.cost));
  fmt::print("{}: {} frame{}, {}x{}, {:.1f} s\n", fmt::join(drawn.files, ", "), drawn.frames, drawn.frames == 1 ? "" : "s",
             job.width, job.height, seconds);
}

int render_scene(const RenderWish& wish, const Arguments& arguments) {
  render::choose_gl(wish.gl);
  const double start = clock_seconds();
  const double ceiling = wish.max_memory.empty() ? 0 : parse_bytes("--max-memory", wish.max_memory);
  const scenes::Scene scene = load_scene(wish.scene, ceiling);
  if (wish.list_cameras) {
    list_cameras(scene, wish.scene.json);
    return kDone;
  }
  // what cannot be drawn or written is told before the work, not after it
  std::vector<View> views = plan_views(wish.film, scene);
  for (View& view : views) view.plan.job.look_around = check_interrupted;
  if (wish.dry_run) return tell_estimates(scene, views, wish.scene.json);
  if (ceiling > 0) hold_to_memory(views, ceiling, scene, wish.scene.quiet);
  const auto locks = held(views);
  tell_when_stopped(kept_of(views.front().plan));
  if (!wish.scene.quiet) {
    tell_room(views, scene.model.settings.duration);
    tell_crowded_cards(views);
  }

  engine::Recording recording = run_scene(scene, plan_of(scene), wish.scene);
  recording.events = engine::told_events(scene.model, recording);
  mark_with_fingerprints(views, scene, arguments, recording);
  const Drawn drawn = draw_views(views, scene.model, recording, progress_of(wish.scene));
  tell_drawn(wish, views.front().plan.job, drawn, recording, clock_seconds() - start);
  return exit_code_of(recording);
}

}  // namespace

std::function<int()> declare_render(Arguments& arguments) {
  const auto wish = std::make_shared<RenderWish>();
  declare_scene(arguments, wish->scene);
  declare_progress(arguments, wish->scene);
  declare_film(arguments, wish->film);
  arguments.flag("--list-cameras", wish->list_cameras, "name the scene's cameras and stop");
  arguments.choice("--gl", wish->gl, {"osmesa", "egl"}, "which OpenGL draws: OSMesa, or EGL without a surface");
  arguments.flag("--timings", wish->timings, "print where the processor time of a frame goes, by pass");
  arguments.flag("--dry-run", wish->dry_run, "print the frames, steps, bytes and seconds to expect, and stop");
  arguments.option("--max-memory", wish->max_memory, "SIZE",
                   "take no more memory than this (2 GB): fewer processes, or an error before the start");
  return [wish, arguments] { return render_scene(*wish, arguments); };
}

}  // namespace cli
