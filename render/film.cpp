// One worker process a core: nothing is shared but the ring, and one that dies takes no other with it. Frame i is
// drawn by worker i mod n into slot i mod 2n of a ring in shared memory; the parent takes frames in order. A worker that dies is
// replaced and its frame drawn again.
#include "render/film.h"

#include <fmt/format.h>
#include <malloc.h>
#include <semaphore.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <ctime>
#include <new>
#include <optional>
#include <set>
#include <thread>

#include "render/error.h"
#include "render/gl/context.h"
#include "render/image/png.h"
#include "render/painter.h"
#include "render/parallel.h"
#include "render/surface/skin.h"
#include "render/video/encoder.h"
#include "render/workers.h"

namespace render {
namespace {

constexpr int kKeptPieces = 32 << 20, kKept = 256 << 20;  // [bytes] the most the C library allows; of a worker
constexpr int kDeathsAllowed = 3;                         // of one worker at one frame
constexpr int kTold = 3;                                  // exit code of a worker whose slot says what went wrong

/// Sleeps until somebody posts, at most 10 ms: who posts may be dead. Between processes, in shared memory.
void sleep_on(sem_t& bell) {
  timespec until{};
  clock_gettime(CLOCK_REALTIME, &until);
  until.tv_nsec += 10'000'000;
  if (until.tv_nsec >= 1'000'000'000) {
    ++until.tv_sec;
    until.tv_nsec -= 1'000'000'000;
  }
  sem_timedwait(&bell, &until);  // interrupted, late or posted: the caller looks again
}

struct Slot {
  std::atomic<int> frame{-1};  // the frame that lies here, drawn
  std::atomic<int> taken{-1};  // the last frame the parent has taken from here
  char error[480] = "";        // what the worker could not do
  FrameCost cost{};            // of the frame that lies here
  sem_t drawn, free;           // rung when `frame` or `taken` changes
  Slot() {
    sem_init(&drawn, 1, 0);
    sem_init(&free, 1, 0);
  }
};

/// Shared anonymous memory that goes with its owner.
class SharedMemory {
 public:
  explicit SharedMemory(std::size_t size) : size_(size) {
    data_ = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (data_ == MAP_FAILED)
      throw RenderError(fmt::format("cannot share {} MB between drawing processes: {}", size >> 20, std::strerror(errno)));
  }
  ~SharedMemory() { munmap(data_, size_); }
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;
  std::uint8_t* data() const { return static_cast<std::uint8_t*>(data_); }

 private:
  void* data_ = nullptr;
  std::size_t size_ = 0;
};

struct Job {
  const Stage& stage;
  const engine::Recording& recording;
  const Film& film;
  const FilmJob& job;
  int workers, slots;
  std::size_t frame_bytes;
  Slot* ring;
  std::uint8_t* pictures;
};

/// The picture as the encoder wants it, or as a file.
void hand_over(const Job& j, const Image& image, int i) {
  std::uint8_t* const place = j.pictures + j.frame_bytes * static_cast<std::size_t>(i % j.slots);
  if (j.job.container == Container::mp4)
    rgba_to_i420(image, place);
  else if (j.job.container == Container::mkv)
    std::copy(image.rgba.begin(), image.rgba.end(), place);
  else
    write_png(frame_path(j.job, j.film.number(i)), image, frame_metadata(j.job, j.film[i]));
}

FrameCost draw_frame(const Job& j, Painter& painter, Image& image, int i) {
  painter.paint(j.stage, j.recording, j.film[i], image);
  FrameCost cost = painter.cost();
  Stopwatch watch(cost);
  hand_over(j, image, i);
  watch.lap(Pass::convert);
  return cost;
}

/// A worker's life: its frames from `first` on, in steps of the number of workers.
int work(const Job& j, int first) {
  int at = first;
  try {
    Painter painter(j.job.width, j.job.height, j.job.quality);
    Image image;
    for (; at < j.film.size(); at += j.workers) {
      Slot& slot = j.ring[at % j.slots];
      while (at >= j.slots && slot.taken.load() < at - j.slots) sleep_on(slot.free);
      slot.cost = draw_frame(j, painter, image, at);
      slot.frame.store(at);
      sem_post(&slot.drawn);
    }
    return 0;
  } catch (const std::exception& e) {
    Slot& slot = j.ring[at % j.slots];
    std::strncpy(slot.error, e.what(), sizeof slot.error - 1);
    return kTold;
  }
}

/// The drawing processes of a film; they go with it.
class Team {
 public:
  explicit Team(const Job& job) : job_(job) {
    for (int w = 0; w < job.workers; ++w) workers_.push_back(started(w));
  }

  /// Waits until frame i lies in its slot; draws it again if its worker died.
  void await(int i) {
    Worker& worker = workers_[static_cast<std::size_t>(i % job_.workers)];
    Slot& slot = job_.ring[i % job_.slots];
    int deaths = 0;
    while (slot.frame.load() != i) {
      int status = 0;
      // a worker may deliver frame i - workers and die at this one before we look at it: then nobody is left for it
      if (worker.has_ended(status)) {
        if (slot.frame.load() == i) break;
        if (WIFEXITED(status) && WEXITSTATUS(status) == kTold) throw RenderError(slot.error);
        if (++deaths > kDeathsAllowed)
          throw RenderError(fmt::format("drawing frame {} failed {} times ({})", i, kDeathsAllowed + 1, ending(status)));
        worker = started(i);
      }
      if (job_.job.look_around) job_.job.look_around();
      sleep_on(slot.drawn);
    }
  }

 private:
  Worker started(int first) const {
    return Worker([this, first] { return work(job_, first); });
  }
  const Job& job_;
  std::vector<Worker> workers_;
};

/// Lists and pictures come and go with each frame, here and in the workers: their memory stays, else each page is cleared anew.
void keep_memory() {
  mallopt(M_MMAP_THRESHOLD, kKeptPieces);
  mallopt(M_TRIM_THRESHOLD, kKept);
}

/// What every worker would have to build by itself.
void prepare(const Stage& stage) {
  for (const PersonActor& person : stage.persons)
    if (person.look == PersonLook::skin) person.skin();
  std::set<const Mesh*> meshes;
  for (const MeshActor& actor : stage.meshes) meshes.insert(actor.mesh.get());
  for (const WheelActor& actor : stage.wheels) meshes.insert(actor.mesh.get());
  for (const PersonActor& person : stage.persons)
    if (person.look == PersonLook::skin) meshes.insert(person.skin()->mesh.get());
  const std::vector<const Mesh*> all(meshes.begin(), meshes.end());
  in_parallel(all.size(), [&all](std::size_t i) { all[i]->levels(); });
  load_gl();
  malloc_trim(0);  // what building has let go of would count as every worker's own
}

void refuse_existing(const FilmJob& job, const Film& film) {
  if (job.overwrite) return;
  const int files = is_video(job.container) ? 1 : film.size();
  for (int i = 0; i < files; ++i) {
    const std::filesystem::path path = is_video(job.container) ? job.output : frame_path(job, film.number(i));
    if (std::filesystem::exists(path)) throw RenderError(path.string() + " exists already: remove it or add --overwrite");
  }
}

}  // namespace

std::filesystem::path frame_path(const FilmJob& job, int number) {
  if (job.container == Container::single_png) return job.output;
  // the pattern has one %0Nd: replaced by hand, user text never reaches printf
  const std::string pattern = job.output.string();
  const std::size_t percent = pattern.rfind('%'), d = pattern.find('d', percent == std::string::npos ? 0 : percent);
  if (percent == std::string::npos || d == std::string::npos)
    throw RenderError("a PNG sequence needs a pattern like frame_%05d.png, not " + pattern);
  const std::string digits = pattern.substr(percent + 1, d - percent - 1);
  const int width = digits.empty() ? 1 : std::atoi(digits.c_str());
  return pattern.substr(0, percent) + fmt::format("{:0{}}", number, std::clamp(width, 1, 12)) + pattern.substr(d + 1);
}

std::map<std::string, std::string> frame_metadata(const FilmJob& job, const Moment& moment) {
  std::map<std::string, std::string> out = job.metadata;
  out["time_s"] = fmt::format("{:.6f}", moment.time);
  out["camera"] = moment.second.empty() ? moment.camera : moment.camera + " and " + moment.second;
  return out;
}

FilmCost make_film(const Stage& stage, const engine::Recording& recording, const Film& film, const FilmJob& job,
                   const std::function<void(const FilmProgress&)>& progress) {
  const auto start = std::chrono::steady_clock::now();
  refuse_existing(job, film);
  keep_memory();
  const int frames = film.size();
  if (frames == 0) throw RenderError("there is no frame to draw: check --from, --to and --frames against the length of the film");
  prepare(stage);
  const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  const int workers = std::min(job.workers > 0 ? job.workers : cores, frames);
  const int slots = 2 * workers;
  const std::size_t pixels = static_cast<std::size_t>(job.width) * static_cast<std::size_t>(job.height);
  const std::size_t frame_bytes = job.container == Container::mp4   ? pixels * 3 / 2
                                  : job.container == Container::mkv ? pixels * 4
                                                                    : 0;
  std::optional<VideoEncoder> encoder;

  const std::size_t head = (sizeof(Slot) * static_cast<std::size_t>(slots) + 4095) / 4096 * 4096;
  const SharedMemory shared(head + frame_bytes * static_cast<std::size_t>(slots));
  Slot* ring = reinterpret_cast<Slot*>(shared.data());
  for (int s = 0; s < slots; ++s) new (ring + s) Slot;
  const Job j{stage, recording, film, job, workers, slots, frame_bytes, ring, shared.data() + head};
  FilmCost cost;
  cost.workers = workers;
  Team team(j);
  const double parent_ms = processor_ms();
  // after the fork: the encoder brings threads of its own, and a child of a process with threads may inherit a lock they hold
  if (is_video(job.container))
    encoder.emplace(job.output, job.width, job.height, job.fps, job.metadata, story_of(stage, recording, film, job.fps));
  for (int i = 0; i < frames; ++i) {
    team.await(i);
    if (encoder) encoder->append(j.pictures + frame_bytes * static_cast<std::size_t>(i % slots));
    add(ring[i % slots].cost, i < workers ? cost.first : cost.later);
    ++(i < workers ? cost.first_frames : cost.later_frames);
    ring[i % slots].taken.store(i);
    sem_post(&ring[i % slots].free);
    if (progress) progress({i + 1, frames});
  }
  if (encoder) encoder->finish();
  cost.encode_ms = processor_ms() - parent_ms;
  cost.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return cost;
}

void join_film(const Stage& stage, const engine::Recording& recording, const Film& film, const FilmJob& drawn, const FilmJob& job) {
  VideoEncoder encoder(job.output, job.width, job.height, job.fps, job.metadata, story_of(stage, recording, film, job.fps));
  std::vector<std::uint8_t> i420(static_cast<std::size_t>(job.width) * static_cast<std::size_t>(job.height) * 3 / 2);
  for (int i = 0; i < film.size(); ++i) {
    if (job.look_around) job.look_around();
    const std::filesystem::path picture = frame_path(drawn, film.number(i));
    const Image image = read_png(picture);
    if (image.width != job.width || image.height != job.height)
      throw RenderError(
          fmt::format("{} is {}x{}, not a frame of {}", picture.string(), image.width, image.height, job.output.string()));
    if (job.container == Container::mp4) rgba_to_i420(image, i420.data());
    encoder.append(job.container == Container::mp4 ? i420.data() : image.rgba.data());
  }
  encoder.finish();
}

}  // namespace render
