#include "cli/output/lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <vector>

#include "cli/exit.h"
#include "cli/process.h"
#include "render/publish.h"

namespace cli {
namespace {

// the drawing processes of a run that was killed share its lock, and take a moment to be gone
constexpr int kLooks = 20;
constexpr unsigned kPause = 100'000;  // [us] between two looks

/// "a/b/" is the folder "a/b".
std::filesystem::path without_slash(const std::filesystem::path& path) {
  const std::filesystem::path plain = path.lexically_normal();
  return plain.has_filename() ? plain : plain.parent_path();
}

}  // namespace

void clear_parts(const std::filesystem::path& folder, const OutputLock::Covers& covers) {
  std::error_code missing;
  std::vector<std::filesystem::path> left;
  for (const auto& entry : std::filesystem::directory_iterator(folder.empty() ? "." : folder, missing)) {
    const std::string name = render::whole_name(entry.path().filename().string());
    if (!name.empty() && covers(name) && std::filesystem::is_regular_file(entry.symlink_status(missing)))
      left.push_back(entry.path());
  }
  for (const std::filesystem::path& part : left) std::filesystem::remove(part, missing);
}

OutputLock::OutputLock(const std::filesystem::path& output, Covers covers)
    : output_(without_slash(output)), file_(output_.string() + ".lock"), covers_(std::move(covers)) {
  const std::string name = output_.filename().string();
  if (!covers_) covers_ = [name](const std::string& other) { return other == name || other == name + ".whole"; };
  take();
  remove_when_stopped(file_.c_str());
  clear();
}

void OutputLock::clear() const {
  clear_parts(output_.parent_path(), covers_);
}

void OutputLock::take() {
  for (int looks = 0;;) {
    handle_ = open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666);
    if (handle_ < 0) throw MachineError(fmt::format("writing {}: {}", file_.string(), std::strerror(errno)));
    struct stat found {};
    if (fstat(handle_, &found) == 0 && !S_ISREG(found.st_mode)) {
      close(handle_);
      throw MachineError(fmt::format("writing {}: it is in the way and is no plain file", file_.string()));
    }
    if (flock(handle_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      close(handle_);
      if (++looks < kLooks) {
        usleep(kPause);
        continue;
      }
      throw MachineError(fmt::format("another run is writing {}; wait for it, or give another -o", output_.string()));
    }
    // the run before may have removed the file between our opening and locking it; then the lock holds nobody off
    if (fstat(handle_, &found) == 0 && found.st_nlink > 0) return;
    close(handle_);
  }
}

OutputLock::~OutputLock() {
  clear();
  keep_when_stopped(file_.c_str());  // before it is gone: then the name may be another run's
  unlink(file_.c_str());
  close(handle_);
}

}  // namespace cli
