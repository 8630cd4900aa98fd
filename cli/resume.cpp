#include "cli/resume.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "cli/exit.h"
#include "render/error.h"
#include "render/image/png.h"
#include "render/video/encoder.h"

namespace cli {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& file) {
  throw UsageError(
      fmt::format("{} was not made by this scene with these assets, options and version; give --overwrite in place of --resume, or "
                  "another -o",
                  file.string()));
}

std::string value_of(const render::TextChunks& chunks, const char* key) {
  const auto found = chunks.find(key);
  return found == chunks.end() ? "" : found->second;
}

render::TextChunks chunks_of(const fs::path& picture) {
  render::TextChunks chunks;
  try {
    render::read_png(picture, &chunks);
  } catch (const render::RenderError&) {
    refuse(picture);  // not a picture of ours: ours are whole
  }
  return chunks;
}

/// Files of the job's pattern that are none of its frames.
std::vector<fs::path> surplus(const render::Film& film, const render::FilmJob& job) {
  std::vector<fs::path> out;
  look_at_frames(job, [&](const fs::path& file, int number) {
    if (!film.holds(number) || file != render::frame_path(job, number)) out.push_back(file);
  });
  std::sort(out.begin(), out.end());
  return out;
}

/// The fingerprint of a picture this program made; empty of any other file.
std::string fingerprint_of(const fs::path& picture) {
  render::TextChunks chunks;
  try {
    chunks = render::read_png_text(picture);
  } catch (const render::RenderError&) {
    return "";
  }
  return value_of(chunks, "version").starts_with("crashreel ") ? value_of(chunks, "fingerprint") : "";
}

}  // namespace

bool is_finished(const fs::path& picture, const render::Moment& moment, const render::FilmJob& job) {
  std::error_code problem;
  if (!fs::exists(picture, problem)) return false;
  const render::TextChunks found = chunks_of(picture);
  for (const auto& [key, value] : render::frame_metadata(job, moment)) {
    if (value_of(found, key.c_str()) != value) refuse(picture);
  }
  return true;
}

render::Film unfinished(const render::Film& film, const render::FilmJob& job) {
  std::vector<render::FrameInterval> left;
  for (int i = 0; i < film.size(); ++i) {
    const int number = film.number(i);
    if (is_finished(render::frame_path(job, number), film[i], job)) continue;
    if (!left.empty() && left.back().last + 1 == number)
      left.back().last = number;
    else
      left.push_back({number, number});
  }
  return film.part(std::move(left));
}

void remove_surplus(const render::Film& film, const render::FilmJob& job, bool quiet) {
  for (const fs::path& file : surplus(film, job)) {
    std::error_code problem;
    if (!fingerprint_of(file).empty() && fs::remove(file, problem)) continue;
    if (!quiet) fmt::print(stderr, "crashreel: warning: {} is no frame of this film; it was left among them\n", file.string());
  }
}

void remove_frames(const render::FilmJob& frames, bool quiet) {
  const fs::path folder = frames.output.parent_path();
  std::vector<fs::path> own;
  look_at_frames(frames, [&](const fs::path& file, int number) {
    if (file == render::frame_path(frames, number) && fingerprint_of(file) == frames.metadata.at("fingerprint"))
      own.push_back(file);
  });
  std::error_code problem;
  for (const fs::path& file : own) fs::remove(file, problem);
  if (rmdir(folder.c_str()) != 0 && errno == ENOTEMPTY && !quiet)
    fmt::print(stderr, "crashreel: warning: {} holds files that are no frames of this film; it was left\n", folder.string());
}

void refuse_surplus(const render::Film& film, const render::FilmJob& job) {
  const std::vector<fs::path> others = surplus(film, job);
  if (!others.empty()) refuse(others.front());
}

bool film_is_finished(const render::FilmJob& job) {
  std::error_code problem;
  if (!fs::exists(job.output, problem)) return false;
  std::map<std::string, std::string> found;
  try {
    found = render::read_film_metadata(job.output);
  } catch (const render::RenderError&) {
    refuse(job.output);
  }
  if (value_of(found, "fingerprint") != job.metadata.at("fingerprint")) refuse(job.output);
  return true;
}

fs::path frames_folder(const render::FilmJob& job) {
  return job.output.string() + ".frames";
}

render::FilmJob frames_job(const render::FilmJob& film) {
  render::FilmJob job = film;
  job.output = frames_folder(film) / "frame_%05d.png";
  job.container = render::Container::png_sequence;
  return job;
}

}  // namespace cli
