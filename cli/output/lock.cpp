#include "cli/output/lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "cli/exit.h"

namespace cli {
namespace {

// the drawing processes of a run that was killed share its lock, and take a moment to be gone
constexpr int kLooks = 20;
constexpr unsigned kPause = 100'000;  // [us] between two looks

}  // namespace

OutputLock::OutputLock(const std::filesystem::path& output) : file_(output.string() + ".lock") {
  for (int looks = 0;;) {
    handle_ = open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (handle_ < 0) throw MachineError(fmt::format("writing {}: {}", file_.string(), std::strerror(errno)));
    if (flock(handle_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      close(handle_);
      if (++looks < kLooks) {
        usleep(kPause);
        continue;
      }
      throw MachineError(fmt::format("another run is writing {}; wait for it, or give another -o", output.string()));
    }
    // the run before may have removed the file between our opening and locking it; then the lock holds nobody off
    struct stat found {};
    if (fstat(handle_, &found) == 0 && found.st_nlink > 0) return;
    close(handle_);
  }
}

OutputLock::~OutputLock() {
  unlink(file_.c_str());
  close(handle_);
}

}  // namespace cli
