#include "cli/output/whole_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "cli/exit.h"

namespace cli {

namespace fs = std::filesystem;

void make_writable_folder(const fs::path& folder) {
  const fs::path place = folder.empty() ? "." : folder;
  std::error_code problem;
  if (!fs::exists(place, problem)) fs::create_directories(place, problem);
  if (problem) {
    fs::path there = place;  // as far as the path leads
    while (there.has_relative_path() && !fs::exists(there)) there = there.parent_path();
    const bool file = !there.empty() && !fs::is_directory(there);
    throw MachineError(
        fmt::format("making the folder {}: {}", place.string(), file ? there.string() + " is a file" : problem.message()));
  }
  if (!fs::is_directory(place)) throw MachineError(fmt::format("writing into {}: it is not a folder", place.string()));
  if (access(place.c_str(), W_OK | X_OK) != 0) {
    throw MachineError(fmt::format("writing into {}: {}", place.string(), std::strerror(errno)));
  }
}

void refuse_existing(const fs::path& file, bool overwrite) {
  std::error_code problem;
  if (fs::is_directory(file, problem)) throw UsageError(fmt::format("{} is a folder; name a file", file.string()));
  if (fs::exists(file, problem) && !fs::is_regular_file(file, problem))
    throw UsageError(fmt::format("{} is a device or a pipe; name a file", file.string()));
  if (!overwrite && fs::exists(file, problem)) {
    throw UsageError(fmt::format("{} exists; give --overwrite to replace it, or another -o", file.string()));
  }
}

WholeFile::WholeFile(fs::path file) : file_(file), part_(std::move(file)), stream_(part_.stream()) {}

WholeFile::~WholeFile() {
  if (stream_ != nullptr) std::fclose(stream_);
}

void WholeFile::write(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stream_) != text.size()) fail("writing");
}

void WholeFile::close() {
  const int result = std::fclose(stream_);
  stream_ = nullptr;
  if (result != 0) fail("writing");
}

void WholeFile::publish() {
  part_.publish();
}

void WholeFile::fail(const char* doing) const {
  throw MachineError(fmt::format("{} {}: {}", doing, file_.string(), std::strerror(errno)));
}

void write_whole(const std::filesystem::path& path, const std::string& text) {
  WholeFile file(path);
  file.write(text);
  file.close();
  file.publish();
}

}  // namespace cli
