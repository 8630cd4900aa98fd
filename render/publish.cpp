#include "render/publish.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "render/error.h"

namespace render {
namespace {

constexpr const char* kEnding = ".part";

void check(int reason, const char* doing, const std::filesystem::path& file) {
  if (reason != 0) throw RenderError(fmt::format("{} {}: {}", doing, file.string(), std::strerror(reason)));
}

/// Writes through what is buffered for a file or folder; 0 or the reason why not.
int sync(const std::filesystem::path& path, int flags) {
  const int handle = open(path.c_str(), O_RDONLY | O_CLOEXEC | flags);
  if (handle < 0) return errno;
  const int reason = fsync(handle) == 0 ? 0 : errno;
  close(handle);
  return reason;
}

int create(const std::filesystem::path& part) {
  const int handle = open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (handle < 0) return errno;
  close(handle);
  return 0;
}

bool is_plain_file(const std::filesystem::path& path) {
  struct stat found {};
  return lstat(path.c_str(), &found) == 0 && S_ISREG(found.st_mode);
}

}  // namespace

PartFile::PartFile(std::filesystem::path file, const std::string& tag)
    : file_(std::move(file)), part_(fmt::format("{}{}.{}{}", file_.string(), tag, getpid(), kEnding)), owner_(getpid()) {
  int reason = create(part_);
  if (reason == EEXIST) {
    // a run that was killed had our number; what is no plain file nobody of us made
    if (!is_plain_file(part_))
      throw RenderError(fmt::format("writing {}: {} is in the way and is no plain file", file_.string(), part_.string()));
    unlink(part_.c_str());
    reason = create(part_);
  }
  check(reason, "writing", file_);
}

PartFile::~PartFile() {
  if (!published_ && owner_ == getpid()) unlink(part_.c_str());
}

std::FILE* PartFile::stream() const {
  const int handle = open(part_.c_str(), O_WRONLY | O_NOFOLLOW | O_CLOEXEC);
  std::FILE* const out = handle < 0 ? nullptr : fdopen(handle, "wb");
  if (out) return out;
  const int reason = errno;
  if (handle >= 0) close(handle);
  throw RenderError(fmt::format("writing {}: {}", file_.string(), std::strerror(reason)));
}

void PartFile::publish() {
  check(sync(part_, O_NOFOLLOW), "writing", file_);
  check(std::rename(part_.c_str(), file_.c_str()) == 0 ? 0 : errno, "renaming", file_);
  published_ = true;
  const std::filesystem::path folder = file_.parent_path();
  const int reason = sync(folder.empty() ? "." : folder, 0);
  // some file systems keep no folder entries to write through
  if (reason != EINVAL) check(reason, "writing the folder of", file_);
}

std::string whole_name(const std::string& part_name) {
  if (!part_name.ends_with(kEnding)) return {};
  const std::string name = part_name.substr(0, part_name.size() - std::strlen(kEnding));
  const std::size_t dot = name.rfind('.');
  if (dot == std::string::npos || dot + 1 == name.size()) return {};
  return name.find_first_not_of("0123456789", dot + 1) == std::string::npos ? name.substr(0, dot) : "";
}

}  // namespace render
