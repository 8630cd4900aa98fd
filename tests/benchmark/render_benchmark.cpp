// Frames a second, end to end, of a shipped scene; what workers, a standing camera and quality are worth; memory of a heavy mesh.
//   benchmark_render SCENE.toml [FRAMES [ROWS]]     ROWS: part of the names of the rows to be measured, "1080p", "mesh"
//   benchmark_render SCENE.toml FRAMES --beside PROGRAM ITS_SCENE.toml
//       the same stills and films by this crashreel and by another ("env CRASHREEL_HOME=... crashreel"), by turns
// Rates depend on the machine and on what else it does; ratios to the yardstick (plain_renderer.h) in the same run do so less.
#include <fmt/format.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>

#include "beside.h"
#include "engine/simulate.h"
#include "plain_renderer.h"
#include "render/arrange.h"
#include "render/error.h"
#include "render/film.h"
#include "render/gl/context.h"
#include "render/image/png.h"
#include "render/surface/tessellate.h"
#include "render/video/encoder.h"
#include "scenes/scene.h"

namespace {

using namespace render;
using Clock = std::chrono::steady_clock;

struct Bench {
  scenes::Scene scene;
  engine::Recording run;
  int frames;
};

double seconds(const std::function<void()>& work) {
  const auto start = Clock::now();
  work();
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Frames a second from the camera, worker start and encoder's end included.
double film_rate(const Bench& b, const std::string& camera, int width, int height, Quality quality, int workers,
                 Container container) {
  std::vector<Moment> moments;
  for (int i = 0; i < b.frames; ++i) moments.push_back({0.05 + i / 60.0, camera, 1});
  FilmJob job;
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("benchmark_render_{}", getpid());
  std::filesystem::create_directories(folder);
  job.output = folder / (container == Container::mp4 ? "film.mp4" : "frame_%05d.png");
  job.container = container;
  job.width = width;
  job.height = height;
  job.quality = quality;
  job.workers = workers;
  job.overwrite = true;
  const double t = seconds([&] { make_film(b.scene.stage, b.run, Film(moments), job); });
  std::filesystem::remove_all(folder);
  return b.frames / t;
}

/// The yardstick's frames a second, H.264 included, all in one process. In a child, so that GL stays out of here.
double plain_rate(const Bench& b, const std::string& camera, int width, int height) {
  int ends[2];
  if (pipe(ends) != 0) return 0;
  const pid_t child = fork();
  if (child == 0) {
    const auto film = std::filesystem::temp_directory_path() / fmt::format("benchmark_plain_{}.mp4", getpid());
    const int frames = std::max(8, b.frames / 4);
    Image image;
    std::vector<std::uint8_t> i420(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3 / 2);
    const double t = seconds([&] {
      PlainRenderer renderer(width, height);
      VideoEncoder encoder(film, width, height, 60, {}, {});
      for (int i = 0; i < frames; ++i) {
        renderer.draw(arrange(b.scene.stage, b.run, {0.05 + i / 60.0, camera, 1}, static_cast<double>(width) / height), image);
        if (const char* shown = std::getenv("BENCHMARK_SHOW"); shown && i == frames / 2) write_png(shown, image, {});
        rgba_to_i420(image, i420.data());
        encoder.append(i420.data());
      }
      encoder.finish();
    });
    std::filesystem::remove(film);
    const double rate = frames / t;
    _exit(write(ends[1], &rate, sizeof rate) == sizeof rate ? 0 : 1);
  }
  double rate = 0;
  if (read(ends[0], &rate, sizeof rate) != sizeof rate) rate = 0;
  close(ends[0]);
  close(ends[1]);
  waitpid(child, nullptr, 0);
  return rate;
}

/// Peak memory [MiB] of a process that draws a closed mesh of about a million triangles at 1080p, and milliseconds of its second
/// frame.
void heavy_mesh() {
  load_gl();  // before the fork, as for a film
  int ends[2];
  if (pipe(ends) != 0) return;
  const pid_t child = fork();
  if (child == 0) {
    constexpr int kCells = 289;  // 12 * 289^2 = 1,002,252 triangles
    auto mesh = std::make_shared<Mesh>();
    Tessellation t = tessellate({{2.2, 0.9, 0.7}, 3.5}, kCells);
    mesh->positions = std::move(t.positions);
    mesh->normals = std::move(t.normals);
    mesh->indices = std::move(t.indices);
    mesh->parts = {{0, static_cast<std::uint32_t>(mesh->indices.size()), 0}};
    Material paint;
    paint.kind = MaterialKind::paint;
    paint.colour = {0.5f, 0.03f, 0.03f};
    mesh->materials = {paint};
    Stage stage;
    MeshActor actor;
    actor.body = -1;
    actor.X_BM.p = {0, 0, 0.9};
    actor.mesh = mesh;
    stage.meshes.push_back(actor);
    Camera camera;
    camera.name = "camera";
    stage.cameras.push_back(camera);
    engine::Recording still;
    still.snapshots.resize(1);
    Renderer renderer(1920, 1080, Quality::standard);
    Image image;
    const DrawList list = arrange(stage, still, {0, "camera", 1}, 16.0 / 9);
    renderer.draw(list, image);
    const double ms = 1e3 * seconds([&] { renderer.draw(list, image); });
    _exit(write(ends[1], &ms, sizeof ms) == sizeof ms ? 0 : 1);
  }
  double ms = 0;
  const bool told = read(ends[0], &ms, sizeof ms) == sizeof ms;
  close(ends[0]);
  close(ends[1]);
  rusage use{};
  int status = 0;
  wait4(child, &status, 0, &use);
  if (told)
    fmt::print("1,002,252 triangles at 1080p: {:.0f} ms a frame, peak {:.0f} MiB (limit 1536)\n", ms,
               static_cast<double>(use.ru_maxrss) / 1024);
}

/// That this process may use: taskset leaves it fewer.
int cores_at_hand() {
  cpu_set_t set;
  return sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 1;
}

/// The targets of one machine with four cores at rest, or two of them (taskset), as absolute figures; elsewhere the multiples of
/// the yardstick count.
void table(const Bench& b, const std::string& fixed, const std::string& moving, const std::string& wanted) {
  const int cores = cores_at_hand();
  fmt::print("{:22} {:>9} {:>9} {:>7} {:>9} {:>8} {:>12}\n", "frames/s, end to end", "1 worker", fmt::format("{} workers", cores),
             "ratio", "yardstick", "times it", fmt::format("must, {} idle", cores == 2 ? 2 : 4));
  struct Row {
    const char* name;
    const std::string& camera;
    int width, height;
    Quality quality;
    Container container;
    double must_of_4, must_of_2 = 0;
  };
  const Row rows[] = {{"720p moving", moving, 1280, 720, Quality::standard, Container::mp4, 65},
                      {"720p moving, draft", moving, 1280, 720, Quality::draft, Container::mp4, 100},
                      {"720p fixed", fixed, 1280, 720, Quality::standard, Container::mp4, 0},
                      {"1080p moving", moving, 1920, 1080, Quality::standard, Container::mp4, 35, 20},
                      {"1080p fixed", fixed, 1920, 1080, Quality::standard, Container::mp4, 50, 26},
                      {"1080p moving, PNG", moving, 1920, 1080, Quality::standard, Container::png_sequence, 35},
                      {"2160p moving", moving, 3840, 2160, Quality::standard, Container::mp4, 11}};
  for (const Row& r : rows) {
    if (std::string(r.name).find(wanted) == std::string::npos) continue;
    const double one = film_rate(b, r.camera, r.width, r.height, r.quality, 1, r.container);
    const double many = film_rate(b, r.camera, r.width, r.height, r.quality, cores, r.container);
    const double must = cores == 2 ? r.must_of_2 : r.must_of_4;
    const double plain = plain_rate(b, r.camera, r.width, r.height);
    fmt::print("{:22} {:9.1f} {:9.1f} {:7.2f} {:9.1f} {:8.2f} {:>12}\n", r.name, one, many, many / one, plain, many / plain,
               must > 0 ? fmt::format("{:.0f}", must) : "");
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "usage: benchmark_render SCENE.toml [FRAMES [ROWS | --beside PROGRAM ITS_SCENE.toml]]\n");
    return 2;
  }
  try {
    Bench b{scenes::load(argv[1]), {}, argc > 2 ? std::atoi(argv[2]) : 60};
    b.run = engine::simulate(b.scene.model);
    std::string cameras[] = {b.scene.stage.cameras.front().name, b.scene.stage.cameras.front().name}, &fixed = cameras[0],
                &moving = cameras[1];
    for (const Camera& c : b.scene.stage.cameras) {
      if (c.kind == CameraKind::follow || c.kind == CameraKind::orbit) moving = c.name;
      if (c.kind == CameraKind::fixed && c.follow.empty()) fixed = c.name;
    }
    fmt::print("{}: fixed camera {}, moving camera {}, {} frames each\n", argv[1], fixed, moving, b.frames);
    if (argc == 6 && std::string(argv[3]) == "--beside") {
      benchmark::beside(argv[1], b.frames, cameras, argv[4], argv[5]);
      return 0;
    }
    table(b, fixed, moving, argc > 3 ? argv[3] : "");
    if (std::string("mesh").find(argc > 3 ? argv[3] : "") != std::string::npos) heavy_mesh();
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 1;
  }
  return 0;
}
