#include "cli/resume.h"

#include <fmt/format.h>

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
