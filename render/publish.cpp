#include "render/publish.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "render/error.h"

namespace render {
namespace {

/// Writes through what is buffered for a file or folder; 0 or the reason why not.
int sync(const std::filesystem::path& path) {
  const int handle = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (handle < 0) return errno;
  const int reason = fsync(handle) == 0 ? 0 : errno;
  close(handle);
  return reason;
}

void check(int reason, const char* doing, const std::filesystem::path& file) {
  if (reason != 0) throw RenderError(fmt::format("{} {}: {}", doing, file.string(), std::strerror(reason)));
}

}  // namespace

void publish(const std::filesystem::path& part, const std::filesystem::path& file) {
  check(sync(part), "writing", file);
  check(std::rename(part.c_str(), file.c_str()) == 0 ? 0 : errno, "renaming", file);
  const std::filesystem::path folder = file.parent_path();
  const int reason = sync(folder.empty() ? "." : folder);
  // some file systems keep no folder entries to write through
  if (reason != EINVAL) check(reason, "writing the folder of", file);
}

}  // namespace render
