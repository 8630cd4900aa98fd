#include "scenes/loader/cage.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>

#include "scenes/cage/protocol.h"
#include "scenes/loader/mesh.h"

#ifndef CRASHREEL_CAGE_DEFAULT
#define CRASHREEL_CAGE_DEFAULT "crashreel-cage"
#endif

namespace scenes {
namespace {

namespace fs = std::filesystem;
using cage::Header;

constexpr std::size_t kLongestName = 4096;  // [byte]
constexpr int kLooks = 1000;                // for the end of a worker that has said all
constexpr unsigned kPause = 1000;           // [us] between two looks
constexpr int kMostFiles = 1000;            // that one mesh may ask for

/// Beside the program, where it is installed, or where it was built.
fs::path worker_program() {
  std::error_code none;
  const fs::path here = fs::read_symlink("/proc/self/exe", none).parent_path();
  for (const fs::path& place : {here / "crashreel-cage", here.parent_path() / "libexec/crashreel/crashreel-cage"})
    if (!none && access(place.c_str(), X_OK) == 0) return place;
  return CRASHREEL_CAGE_DEFAULT;
}

std::string lower_ending(const fs::path& file) {
  std::string out = file.extension().string();
  std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

/// What the worker may be handed: the file itself and, below its root, what meshes are kept in.
class Shelf {
 public:
  Shelf(const fs::path& file, const fs::path& root) {
    std::error_code gone;
    root_ = fs::canonical(root.empty() ? "." : root, gone);
    file_ = fs::canonical(file, gone);
  }
  /// An open file, or -1.
  int open_file(const std::string& name) const {
    std::error_code gone;
    const fs::path file = name.find('\0') == std::string::npos ? fs::canonical(file_.parent_path() / name, gone) : fs::path();
    if (gone || file.empty() || (file != file_ && !belongs(file))) return -1;
    // links were followed above; one that was put there since is not
    const int handle = open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    struct stat found {};
    if (handle >= 0 && fstat(handle, &found) == 0 && S_ISREG(found.st_mode)) return handle;
    if (handle >= 0) close(handle);
    return -1;
  }

 private:
  bool belongs(const fs::path& file) const {
    if (std::mismatch(root_.begin(), root_.end(), file.begin(), file.end()).first != root_.end()) return false;
    const std::string ending = lower_ending(file);
    return ending == ".mtl" || ending == ".bin" ||
           std::find(kMeshFormats.begin(), kMeshFormats.end(), ending) != kMeshFormats.end();
  }
  fs::path file_, root_;
};

/// In the child: becomes the worker, with nothing of this process but the socket.
[[noreturn]] void become_worker(int socket, pid_t parent, const char* program, char* const* arguments) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // nobody reads on from a parent that was killed
  if (getppid() != parent) _exit(4);
  const int null = open("/dev/null", O_RDWR);
  if (null < 0 || dup2(socket, cage::kSocket) < 0) _exit(4);
  for (int standard = 0; standard < 3; ++standard)
    if (dup2(null, standard) < 0) _exit(4);
  if (close_range(cage::kSocket + 1, ~0u, 0) != 0) {
    const long most = sysconf(_SC_OPEN_MAX);
    for (int other = cage::kSocket + 1; other < most; ++other) close(other);
  }
  signal(SIGPIPE, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  // the importer clears buffers of 16 MB for the smallest file: with pages of 2 MB a fifth of the time (older glibc ignores it)
  char pages[] = "GLIBC_TUNABLES=glibc.malloc.hugetlb=1";
  char* const environment[] = {pages, nullptr};
  execve(program, arguments, environment);
  _exit(127);
}

/// One worker, from its start to its end.
class CagedWorker {
 public:
  CagedWorker(const fs::path& file, const CageLimits& limits) : limits_(limits) {
    const std::string program = worker_program().string();
    std::array<std::string, 4> words{"crashreel-cage", file.filename().string(), std::to_string(limits.cpu_time),
                                     std::to_string(limits.memory)};
    std::array<char*, 5> arguments{};
    for (std::size_t i = 0; i < words.size(); ++i) arguments[i] = words[i].data();
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) return;
    const pid_t parent = getpid();
    pid_ = fork();
    if (pid_ == 0) become_worker(ends[1], parent, program.c_str(), arguments.data());
    const int reason = errno;
    close(ends[1]);
    socket_ = ends[0];
    errno = reason;
  }
  ~CagedWorker() {
    end();
    if (socket_ >= 0) close(socket_);
  }
  CagedWorker(const CagedWorker&) = delete;
  CagedWorker& operator=(const CagedWorker&) = delete;
  bool started() const { return pid_ > 0; }

  /// Hands over what is asked for until the result comes. Why not, or nothing.
  std::string serve(const Shelf& shelf, CageAnswer& answer) {
    for (int files = 0; files <= kMostFiles; ++files) {
      Header header;
      std::string bytes(sizeof header, '\0');
      if (!take(bytes)) return why();
      std::memcpy(&header, bytes.data(), sizeof header);
      if (header.kind == Header::result) return take_result(header, answer);
      if (header.kind != Header::open_file || header.length > kLongestName) return "the import broke off";
      bytes.resize(header.length);
      if (!take(bytes)) return why();
      hand_over(shelf.open_file(bytes));
    }
    return fmt::format("it names more than {} other files", kMostFiles);
  }

 private:
  std::string take_result(const Header& header, CageAnswer& answer) {
    if (header.length > limits_.largest)
      return fmt::format("what stands in it needs more than {} MB; thin it out", limits_.largest >> 20);
    answer.bytes.resize(header.length);
    if (!take(answer.bytes)) return why();
    end();
    if (!WIFEXITED(status_) || WEXITSTATUS(status_) != 0) return why();
    if (!(header.walls & cage::landlock)) answer.warning = "Landlock";
    if (!(header.walls & cage::seccomp)) answer.warning += answer.warning.empty() ? "seccomp" : " and seccomp";
    return {};
  }

  void hand_over(int handle) {
    char byte = handle >= 0 ? cage::kHere : cage::kRefused;
    iovec piece{&byte, 1};
    alignas(cmsghdr) char room[CMSG_SPACE(sizeof(int))] = {};
    msghdr message{};
    message.msg_iov = &piece;
    message.msg_iovlen = 1;
    if (handle >= 0) {
      message.msg_control = room;
      message.msg_controllen = sizeof room;
      cmsghdr* head = CMSG_FIRSTHDR(&message);
      head->cmsg_level = SOL_SOCKET;
      head->cmsg_type = SCM_RIGHTS;
      head->cmsg_len = CMSG_LEN(sizeof(int));
      std::memcpy(CMSG_DATA(head), &handle, sizeof handle);
    }
    // a worker that does not take its answer ends when its time is up
    (void)sendmsg(socket_, &message, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (handle >= 0) close(handle);
  }

  /// Fills `bytes`; false where the worker dawdles or has gone.
  bool take(std::string& bytes) {
    for (std::size_t got = 0; got < bytes.size();) {
      const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline_ - std::chrono::steady_clock::now()).count();
      pollfd ready{socket_, POLLIN, 0};
      late_ = left <= 0;
      if (late_) return false;
      const int events = poll(&ready, 1, static_cast<int>(left));
      if (events <= 0) continue;  // interrupted, or late
      const ssize_t n = read(socket_, bytes.data() + got, bytes.size() - got);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return false;
      got += static_cast<std::size_t>(n);
    }
    return true;
  }

  /// Its whole process group: whatever it started goes with it, while its number is still its own.
  void end() {
    if (pid_ <= 0) return;
    siginfo_t ended{};
    // what has said all ends by itself within a moment; one that has closed its socket and goes on is ended
    for (int look = 0; look < kLooks && !late_; ++look) {
      if (waitid(P_PID, static_cast<id_t>(pid_), &ended, WEXITED | WNOHANG | WNOWAIT) == 0 && ended.si_pid == pid_) break;
      usleep(kPause);
    }
    kill(-pid_, SIGKILL);
    kill(pid_, SIGKILL);  // where it has no group yet
    rusage used{};
    while (wait4(pid_, &status_, 0, &used) < 0 && errno == EINTR) {
    }
    pid_ = -1;
    spent_ = static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
             1e-6 * static_cast<double>(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
  }

  std::string why() {
    end();
    if (late_) return fmt::format("the import did not answer for {} s", limits_.patience);
    if (WIFEXITED(status_) && WEXITSTATUS(status_) == 127)
      return fmt::format("the program {} cannot be started", worker_program().string());
    if (WIFEXITED(status_) && WEXITSTATUS(status_) == cage::kNoMemory) return "it needs more memory than the import may take";
    // the kernel's own count may be ahead of what it reports at the end
    if (WIFSIGNALED(status_) && WTERMSIG(status_) == SIGKILL && spent_ > 0.5 * limits_.cpu_time)
      return fmt::format("the import took more than {} s of processor time; convert the file to OBJ, or thin it out",
                         limits_.cpu_time);
    return "the import crashed; convert the file to OBJ and try again";
  }

  CageLimits limits_;
  pid_t pid_ = -1;
  int socket_ = -1, status_ = 0;
  bool late_ = false;
  double spent_ = 0;  // [s]
  std::chrono::steady_clock::time_point deadline_ = std::chrono::steady_clock::now() + std::chrono::seconds(limits_.patience);
};

}  // namespace

CageAnswer ask_cage(const fs::path& file, const fs::path& root, const CageLimits& limits) {
  CageAnswer answer;
  CagedWorker worker(file, limits);
  if (!worker.started()) return {{}, std::string("no process for the import: ") + std::strerror(errno), {}};
  answer.problem = worker.serve(Shelf(file, root), answer);
  if (answer.problem.empty() && (answer.bytes.empty() || answer.bytes[0] != 'M'))
    answer.problem = answer.bytes.empty() ? "the import broke off" : answer.bytes.substr(1, 300);
  if (!answer.problem.empty()) answer.bytes.clear();
  return answer;
}

}  // namespace scenes
