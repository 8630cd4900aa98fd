#include "cli/resume.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

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
std::vector<fs::path> surplus(const Selection& selection, const render::FilmJob& job) {
  const std::vector<fs::path> there = frames_there(job);
  std::vector<fs::path> wanted, out;
  for (const int number : selection.numbers) wanted.push_back(render::frame_path(job, number));
  std::sort(wanted.begin(), wanted.end());
  std::set_difference(there.begin(), there.end(), wanted.begin(), wanted.end(), std::back_inserter(out));
  return out;
}

bool is_ours(const fs::path& picture) {
  render::TextChunks chunks;
  try {
    render::read_png(picture, &chunks);
  } catch (const render::RenderError&) {
    return false;
  }
  return value_of(chunks, "version").starts_with("crashreel ") && !value_of(chunks, "fingerprint").empty();
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

Selection unfinished(const Selection& selection, const render::FilmJob& job) {
  Selection out;
  for (std::size_t i = 0; i < selection.moments.size(); ++i) {
    if (is_finished(render::frame_path(job, selection.numbers[i]), selection.moments[i], job)) continue;
    out.numbers.push_back(selection.numbers[i]);
    out.moments.push_back(selection.moments[i]);
  }
  return out;
}

void remove_surplus(const Selection& selection, const render::FilmJob& job, bool quiet) {
  for (const fs::path& file : surplus(selection, job)) {
    std::error_code problem;
    if (is_ours(file) && fs::remove(file, problem)) continue;
    if (!quiet) fmt::print(stderr, "crashreel: warning: {} is no frame of this film; it was left among them\n", file.string());
  }
}

void refuse_surplus(const Selection& selection, const render::FilmJob& job) {
  const std::vector<fs::path> others = surplus(selection, job);
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
