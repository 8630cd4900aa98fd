#include "beside.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <thread>
#include <vector>

namespace benchmark {
namespace {

double total(const rusage& use) {
  const auto time = [](const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
  return time(use.ru_utime) + time(use.ru_stime);
}

/// [s of a core] of all programs that have ended.
double spent() {
  rusage use{};
  getrusage(RUSAGE_CHILDREN, &use);
  return total(use);
}

/// What a crashreel says of a film it made: frames a second, processor time of a frame [ms]; and what the whole program took.
struct Told {
  double rate = 0, ms = 0, program_s = 0;
};
Told told_by(const std::string& program, const std::string& scene, const std::string& film) {
  const auto out = std::filesystem::temp_directory_path() / fmt::format("benchmark_beside_{}.mp4", getpid());
  FILE* words =
      popen(fmt::format("{} render {} {} --timings -q --overwrite -o {}", program, scene, film, out.string()).c_str(), "r");
  if (!words) throw std::runtime_error("cannot run " + program);
  Told told;
  const double before = spent();
  char line[256];
  while (std::fgets(line, sizeof line, words)) {
    if (const char* at = std::strstr(line, "of the clock,")) told.rate = std::atof(at + std::strlen("of the clock,"));
    if (std::strncmp(line, "together", 8) == 0) told.ms = std::atof(line + 8);
  }
  std::filesystem::remove(out);
  if (pclose(words) != 0 || told.rate == 0) throw std::runtime_error(program + " made no film of " + scene);
  told.program_s = spent() - before;
  return told;
}

std::string own_program() {
  return (std::filesystem::read_symlink("/proc/self/exe").parent_path() / "../crashreel").string();
}

/// [s of a core]
double simulation(const std::string& program, const std::string& scene) {
  const auto out = std::filesystem::temp_directory_path() / fmt::format("benchmark_beside_{}", getpid());
  const double before = spent();
  if (std::system(fmt::format("{} simulate {} -q --overwrite -o {} >/dev/null", program, scene, out.string()).c_str()) != 0)
    throw std::runtime_error(program + " does not simulate " + scene);
  std::filesystem::remove_all(out);
  return spent() - before;
}

double median(std::vector<double> of) {
  std::nth_element(of.begin(), of.begin() + of.size() / 2, of.end());
  return of[of.size() / 2];
}

void films(const std::string& scene, int frames, const std::string (&cameras)[2], const std::string& other,
           const std::string& its_scene) {
  const std::string mine = own_program();
  const unsigned cores = std::thread::hardware_concurrency();
  const double without[] = {simulation(mine, scene), simulation(other, its_scene)};
  fmt::print("{:16} {:>9} {:>9} {:>7} {:>12} {:>9} {:>7} {:>11} {:>9} {:>7}\n", "", "frames/s", "beside", "ratio", "film, core s",
             "beside", "ratio", "frame, ms", "beside", "ratio");
  for (const char* size : {"1280x720", "1920x1080"})
    for (const int moving : {1, 0}) {
      const std::string film =
          fmt::format("--camera {} --from 0s --to {}s --fps 60 --size {} -j {}", cameras[moving], frames / 60.0, size, cores);
      std::vector<double> rate[2], film_s[2], ms[2];
      for (int round = 0; round < 5; ++round)
        for (const int which : {0, 1}) {
          const Told told = which == 0 ? told_by(mine, scene, film) : told_by(other, its_scene, film);
          rate[which].push_back(told.rate);
          film_s[which].push_back(told.program_s - without[which]);
          ms[which].push_back(told.ms);
        }
      const double r[] = {median(rate[0]), median(rate[1])}, f[] = {median(film_s[0]), median(film_s[1])},
                   m[] = {median(ms[0]), median(ms[1])};
      fmt::print("{:9} {:6} {:9.1f} {:9.1f} {:7.2f} {:12.2f} {:9.2f} {:7.2f} {:11.1f} {:9.1f} {:7.2f}\n", size,
                 moving ? "moving" : "fixed", r[0], r[1], r[0] / r[1], f[0], f[1], f[1] / f[0], m[0], m[1], m[1] / m[0]);
      std::fflush(stdout);
    }
}

/// What a still costs from the program's start to its end.
struct Still {
  double mb = 0, s = 0, processor_s = 0;  // largest of its processes; of the clock
};
Still still_by(const std::string& program, const std::string& scene, const char* size) {
  sync();
  if (FILE* caches = std::fopen("/proc/sys/vm/drop_caches", "w")) {
    std::fputs("3", caches);
    std::fclose(caches);
  }
  const auto out = std::filesystem::temp_directory_path() / fmt::format("benchmark_still_{}.png", getpid());
  const std::string command =
      fmt::format("{} render {} --at 0.2s --size {} -q --overwrite -o {} >/dev/null", program, scene, size, out.string());
  Still told;
  rusage use{};
  int status = 0;
  const auto start = std::chrono::steady_clock::now();
  const pid_t child = fork();
  if (child == 0) {
    execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    _exit(127);
  }
  wait4(child, &status, 0, &use);
  told.s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::filesystem::remove(out);
  if (status != 0) throw std::runtime_error(program + " made no still of " + scene);
  told.mb = static_cast<double>(use.ru_maxrss) * 1024 / 1e6;
  told.processor_s = total(use);
  return told;
}

void stills(const std::string& scene, const std::string& other, const std::string& its_scene) {
  fmt::print("{:16} {:>9} {:>9} {:>7} {:>11} {:>9} {:>12} {:>9}\n", "still", "MB", "beside", "ratio", "s, cold", "beside",
             "s of a core", "beside");
  for (const char* size : {"64x64", "1280x720", "1920x1080", "7680x4320"}) {
    const Still mine = still_by(own_program(), scene, size), its = still_by(other, its_scene, size);
    fmt::print("{:16} {:9.0f} {:9.0f} {:7.2f} {:11.2f} {:9.2f} {:12.2f} {:9.2f}\n", size, mine.mb, its.mb, mine.mb / its.mb, mine.s,
               its.s, mine.processor_s, its.processor_s);
  }
}

}  // namespace

void beside(const std::string& scene, int frames, const std::string (&cameras)[2], const std::string& other,
            const std::string& its_scene) {
  stills(scene, other, its_scene);
  films(scene, frames, cameras, other, its_scene);
}

}  // namespace benchmark
